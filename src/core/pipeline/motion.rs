//! The flow of a whole project: one continuous map per segment and caustic, and one sequence of fields per segment that all
//! caustics share, save those that flow by themselves.

use std::borrow::Cow;
use std::sync::Arc;

use glam::Vec2;

use super::acting::{Acting, all_acting};
use super::batch::Batch;
use super::grouping::{CausticLight, Grouping};
use super::light::{KeyPhotons, Partners};
use super::meter::{Meter, StageCost};
use super::mover;
use super::summary::FlowNumbers;
use crate::constraint::{ActiveLine, ActiveWall};
use crate::flow::guidance::mean_straight;
use crate::flow::{
    Fields, FlowReport, FlowSettings, Movement, Segment as FlowSegment, SegmentFlow, Snapshots,
};
use crate::matching::{ContinuousMap, Method, mean_square_distance};
use crate::project::{CausticDesc, CausticKey, KeyFrame, PlaneSettings, Project};
use crate::scene::SceneDesc;
use crate::{Error, Progress, Result};

/// From one key to the next.
pub(super) struct Segment {
    /// Where the light of each group goes at the next key; absent where rows are paired as given, where the group rests,
    /// and where there was no photon of it.
    pub(super) maps: Arc<Vec<Option<ContinuousMap>>>,
    pub(super) layers: Vec<Layer>,
    /// What the pairing of pass 0 costs.
    pub(super) cost: Cost,
}

/// Groups that flow together.
pub(super) struct Layer {
    pub(super) groups: Vec<usize>,
    /// What moves their photons.
    pub(super) mover: SegmentFlow,
}

/// How the light of a project moves; no segments where there is one key.
pub(super) struct Motion {
    pub(super) segments: Vec<Segment>,
    /// The worst over the segments; absent where nothing moves.
    pub(super) numbers: Option<FlowNumbers>,
    /// The light of each group; empty where no caustic is named.
    pub(super) caustics: Vec<CausticLight>,
}

impl Segment {
    /// What moves a group; nothing where it rests, or where there was no photon of it.
    pub(super) fn mover_of(&self, group: usize) -> Option<&SegmentFlow> {
        self.layers.iter().find(|layer| layer.groups.contains(&group)).map(|layer| &layer.mover)
    }

    /// The fields of the segment, where the method has any: those that the caustics share, with `None`, and own ones with
    /// the number of the caustic.
    pub(super) fn fields(&self, grouping: &Grouping) -> impl Iterator<Item = (Option<usize>, &Fields)> {
        self.layers.iter().filter_map(|layer| {
            let own = layer.groups.iter().copied().find(|&group| grouping.own_flow(group));
            Some((own, layer.mover.fields()?))
        })
    }
}

/// All that a motion depends on.
#[derive(Clone, PartialEq)]
pub(super) struct MotionInput {
    scene: Option<SceneDesc>,
    plane: PlaneSettings,
    caustics: Vec<CausticDesc>,
    keys: Vec<KeyFrame>,
    matching: Method,
    method: Movement,
    flow: FlowSettings,
    acting: Vec<Acting>,
    seed: u64,
    photons: usize,
}

impl MotionInput {
    /// The motion does not depend on the numbers of the frames, nor on the camera, nor on how bright a caustic is.
    pub(super) fn new(project: &Project, extent: Vec2, photons: usize) -> Self {
        let plain = |key: &KeyFrame| {
            let mut key = KeyFrame { frame: 0, ease: Default::default(), ..key.clone() };
            for caustic in key.caustics.values_mut() {
                *caustic = CausticKey { shows: caustic.shows.take(), ..Default::default() };
            }
            key
        };
        let seen = |scene: &SceneDesc| SceneDesc {
            camera: Default::default(),
            environment: Default::default(),
            ..scene.clone()
        };
        Self {
            scene: project.scene.as_ref().map(seen),
            plane: project.plane.clone(),
            caustics: project.caustics.clone(),
            keys: project.keys.iter().map(plain).collect(),
            matching: project.matching,
            method: project.method,
            flow: project.flow.clone(),
            acting: all_acting(project, extent),
            seed: project.seed,
            photons,
        }
    }
}

/// Matches and fits all segments with the photons of pass 0, which stand at the first key.
pub(super) fn fit(
    mut batch: Batch,
    project: &Project,
    extent: Vec2,
    meter: &mut Meter,
    progress: &Progress,
) -> Result<Motion> {
    let caustics = batch.supplies().caustics(batch.light());
    let mut motion = Motion { segments: Vec::new(), numbers: None, caustics };
    for (number, acting) in all_acting(project, extent).iter().enumerate() {
        progress.begin("match", 1);
        let Paired { maps, next, cost, .. } =
            meter.measure("match", || match_next(&batch, true, progress))?;
        let leg = Leg { at: &batch.at, next: &next, acting, number, extent };
        let (layers, reports) = leg.fit(layers(&batch), project, None, meter, progress)?;
        let numbers = motion.numbers.into_iter().chain(FlowNumbers::of_segment(reports, &cost));
        motion.numbers = numbers.reduce(FlowNumbers::worst);
        motion.segments.push(Segment { maps: Arc::new(maps), layers, cost });
        batch.arrive(next);
    }
    Ok(motion)
}

/// The photons of all groups at a key and at the next, matched, and what acts between.
pub(super) struct Leg<'a> {
    pub(super) at: &'a [KeyPhotons],
    /// Row by row.
    pub(super) next: &'a [KeyPhotons],
    pub(super) acting: &'a Acting,
    /// Which segment it is, from 0.
    pub(super) number: usize,
    pub(super) extent: Vec2,
}

/// Moments at which photons are shown while they are fitted to.
pub(super) struct LayerMoments<'a> {
    /// Times within 0..=1, rising.
    pub(super) times: &'a [f64],
    /// Is shown them.
    pub(super) show: LayerTracks<'a>,
}

/// Is shown the groups of a layer, the index of a time, and where their photons are then, group by group.
type LayerTracks<'a> = &'a mut dyn FnMut(&[usize], usize, &[Vec2]);

impl Leg<'_> {
    /// What moves each layer of groups, and how it does.
    pub(super) fn fit(
        &self,
        layers: Vec<Vec<usize>>,
        project: &Project,
        mut moments: Option<LayerMoments>,
        meter: &mut Meter,
        progress: &Progress,
    ) -> Result<(Vec<Layer>, Vec<FlowReport>)> {
        let Self { at, next, acting: Acting { lines, walls }, number, extent } = *self;
        let (mut fitted, mut reports) = (Vec::new(), Vec::new());
        for groups in layers {
            let source = &*column(at, &groups, |at| &at.positions);
            let target = &*column(next, &groups, |next| &next.positions);
            let bows = &*column(next, &groups, |next| &next.bows);
            let course =
                FlowSegment { source, target, extent, settings: &project.flow, lines, walls, number };
            let (mover, report) = match &mut moments {
                None => mover::mover(project.method, &course, bows, None, meter, progress)?,
                Some(LayerMoments { times, show }) => {
                    let show = &mut |i: usize, positions: &[Vec2]| show(&groups, i, positions);
                    let moments = Some(Snapshots { times, show });
                    mover::mover(project.method, &course, bows, moments, meter, progress)?
                }
            };
            fitted.push(Layer { groups, mover });
            reports.push(report);
        }
        Ok((fitted, reports))
    }
}

/// The photons of the first two key frames between which they move: row k of `target` is where photon k of `source` goes.
pub struct FirstMove {
    /// Positions at the earlier key, plane units: the caustics that share a field, or one that flows by itself.
    pub source: Vec<Vec2>,
    /// Positions at the later one.
    pub target: Vec<Vec2>,
    /// Size of the plane; its longer side is 1.
    pub extent: Vec2,
    /// Directed lines between these keys.
    pub lines: Vec<ActiveLine>,
    /// Walls between these keys.
    pub walls: Vec<ActiveWall>,
    /// Number of the segment, from 0.
    pub number: usize,
    /// Seconds of "trace" (or of drawing the first key's points) and "match".
    pub costs: Vec<StageCost>,
}

impl FirstMove {
    /// How they flow with these settings.
    pub fn course<'a>(&'a self, settings: &'a FlowSettings) -> FlowSegment<'a> {
        let Self { source, target, extent, lines, walls, number, .. } = self;
        FlowSegment { source, target, extent: *extent, settings, lines, walls, number: *number }
    }

    /// Seconds of the matching, over all segments up to this one.
    pub fn match_seconds(&self) -> Option<f64> {
        self.costs.iter().find(|cost| cost.stage == "match").map(|cost| cost.seconds)
    }

    /// Walls that have a say in who goes where; others are only gone around.
    pub fn leading_walls(&self) -> Vec<&ActiveWall> {
        self.walls.iter().filter(|wall| mover::leads(wall)).collect()
    }
}

/// Goes from key to key until photons move.
pub(super) fn first_move(
    mut batch: Batch,
    project: &Project,
    extent: Vec2,
    mut meter: Meter,
    progress: &Progress,
) -> Result<FirstMove> {
    for (number, Acting { lines, walls }) in all_acting(project, extent).into_iter().enumerate() {
        progress.begin("match", 1);
        let next = meter.measure("match", || match_next(&batch, false, progress))?.next;
        for groups in layers(&batch) {
            let [source, target] =
                [&batch.at, &next].map(|photons| column(photons, &groups, |at| &at.positions));
            if mean_straight(&source, &target) > 0.0 {
                let (source, target) = (source.into_owned(), target.into_owned());
                let costs = meter.costs().to_vec();
                return Ok(FirstMove { source, target, extent, lines, walls, number, costs });
            }
        }
        batch.arrive(next);
    }
    let what = "no photon moves from one key frame to the next, so there is no flow to look at";
    Err(Error::value("keys", what))
}

/// The groups that have photons to move until the next key, those together that share a field.
pub(super) fn layers(batch: &Batch) -> Vec<Vec<usize>> {
    let grouping = batch.supplies().grouping();
    let moves = |group: &usize| !batch.rests(*group) && !batch.at[*group].positions.is_empty();
    let (own, shared): (Vec<_>, Vec<_>) =
        (0..grouping.count()).filter(moves).partition(|&group| grouping.own_flow(group));
    let shared = Some(shared).filter(|groups| !groups.is_empty());
    shared.into_iter().chain(own.into_iter().map(|group| vec![group])).collect()
}

/// One column of several groups, one after the other; borrowed where it is but one.
fn column<'a>(
    photons: &'a [KeyPhotons],
    groups: &[usize],
    pick: impl Fn(&'a KeyPhotons) -> &'a [Vec2],
) -> Cow<'a, [Vec2]> {
    match groups {
        [group] => Cow::Borrowed(pick(&photons[*group])),
        _ => groups.iter().flat_map(|&group| pick(&photons[group])).copied().collect(),
    }
}

/// The photons' targets at the next key, group by group.
pub(super) struct Paired {
    pub(super) maps: Vec<Option<ContinuousMap>>,
    pub(super) partners: Vec<Partners>,
    pub(super) next: Vec<KeyPhotons>,
    pub(super) cost: Cost,
}

/// What the pairing of all groups costs, in squared plane units.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Cost {
    /// Photons that were paired; those that rest are not.
    photons: f64,
    /// Sum of the squared distances of the pairs.
    sum: f64,
    /// A lower bound of that of any pairing; absent where the method has none to tell.
    pub(super) bound: Option<f64>,
}

impl Cost {
    /// Counts `photons` more, with their mean squared distance and a lower bound of it.
    fn add(&mut self, photons: usize, mean: f64, bound: Option<f64>) {
        let (before, more) = (Some(0.0).filter(|_| self.photons == 0.0).or(self.bound), photons as f64);
        self.photons += more;
        self.sum += more * mean;
        self.bound = before.zip(bound).map(|(before, bound)| before + more * bound);
    }

    /// Mean squared distance of the pairs.
    pub(super) fn mean(&self) -> f64 {
        self.sum / self.photons.max(1.0)
    }

    /// Over the bound, or over that of another method on the same points.
    pub(super) fn ratio(&self, bound: Option<f64>) -> Option<f64> {
        // Nothing to move costs nothing, which is the optimum.
        bound.map(|bound| if bound > 0.0 { self.sum / bound } else { 1.0 })
    }
}

/// Pairs the photons of all groups with their points of the next key. `bounded` asks for a lower bound of the cost too,
/// which takes as long as a map.
pub(super) fn match_next(batch: &Batch, bounded: bool, progress: &Progress) -> Result<Paired> {
    let mut paired =
        Paired { maps: Vec::new(), partners: Vec::new(), next: Vec::new(), cost: Cost::default() };
    for (group, at) in batch.at.iter().enumerate() {
        let (from, points) = (&at.positions, batch.next_points(group));
        let map = batch.map(group, &points.positions, &progress.inner())?;
        let bound = match &map {
            Some(map) if bounded => map.lower_bound(from, &points.positions, progress)?,
            _ => None,
        };
        let partners = batch.partners(group, &points.positions, map.as_ref(), &progress.inner())?;
        let next = partners.arrange(points);
        if !batch.rests(group) && !from.is_empty() {
            let mean = match &map {
                Some(map) => map.cost(from, &next.positions),
                None => mean_square_distance(from, next.positions.iter().copied()),
            };
            paired.cost.add(from.len(), mean, bound);
        }
        paired.maps.push(map);
        paired.partners.push(partners);
        paired.next.push(next);
    }
    Ok(paired)
}
