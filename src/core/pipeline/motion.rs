//! The flow of a whole project: one continuous map per segment and caustic, and one sequence of fields per segment that all
//! caustics share, save those that flow by themselves.

use std::borrow::Cow;

use glam::Vec2;

use super::batch::Batch;
use super::drawn::{Drawn, all_drawn};
use super::grouping::{CausticLight, Grouping};
use super::meter::Meter;
use super::summary::FlowNumbers;
use super::supply::KeyPhotons;
use crate::constraint::{ActiveLine, ActiveWall};
use crate::flow::guidance::mean_straight;
use crate::flow::{Course, Fields, FlowSettings, fit_segment};
use crate::matching::{Method, TransportMap, dual_bound, mean_square_distance, transport_map};
use crate::project::{CausticDesc, CausticKey, KeyFrame, PlaneSettings, Project};
use crate::scene::SceneDesc;
use crate::{Error, Progress, Result};

/// From one key to the next.
pub(super) struct Segment {
    /// Where the light of each group goes at the next key; absent where rows are paired as given, where the group rests,
    /// and where there was no photon of it.
    pub(super) maps: Vec<Option<TransportMap>>,
    layers: Vec<Layer>,
}

/// Groups that flow together.
struct Layer {
    groups: Vec<usize>,
    /// Their vector field, step by step.
    fields: Fields,
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
    /// What carries a group; nothing where it rests, or where there was no photon of it.
    pub(super) fn fields_of(&self, group: usize) -> Option<&Fields> {
        self.layers.iter().find(|layer| layer.groups.contains(&group)).map(|layer| &layer.fields)
    }

    /// The fields of the segment: those that the caustics share, with `None`, and own ones with the number of the caustic.
    pub(super) fn fields(&self, grouping: &Grouping) -> impl Iterator<Item = (Option<usize>, &Fields)> {
        self.layers.iter().map(|layer| {
            let own = layer.groups.iter().copied().find(|&group| grouping.own_flow(group));
            (own, &layer.fields)
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
    flow: FlowSettings,
    drawn: Vec<Drawn>,
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
            flow: project.flow.clone(),
            drawn: all_drawn(project, extent),
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
    for (number, drawn) in all_drawn(project, extent).iter().enumerate() {
        progress.begin("match", 1);
        let paired = meter.measure("match", || match_next(&batch, project.matching, extent, progress))?;
        let mut segment = Segment { maps: paired.maps, layers: Vec::new() };
        for groups in layers(&batch) {
            let (source, target) = (&*column(&batch.at, &groups), &*column(&paired.next, &groups));
            let (settings, Drawn { lines, walls }) = (&project.flow, drawn);
            let course = Course { source, target, extent, settings, lines, walls, number };
            let (fields, report) = meter.measure("fit", || fit_segment(&course, progress, None))?;
            let numbers =
                FlowNumbers { flow: report, transport_cost_ratio: paired.cost_ratio, flux_ratio: 1.0 };
            motion.numbers = Some(match motion.numbers.take() {
                Some(sum) => sum.worst(numbers),
                None => numbers,
            });
            segment.layers.push(Layer { groups, fields });
        }
        motion.segments.push(segment);
        batch.arrive(paired.next);
    }
    Ok(motion)
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
}

/// Goes from key to key until photons move.
pub(super) fn first_move(
    mut batch: Batch,
    project: &Project,
    extent: Vec2,
    progress: &Progress,
) -> Result<FirstMove> {
    for (number, Drawn { lines, walls }) in all_drawn(project, extent).into_iter().enumerate() {
        progress.begin("match", 1);
        let next = match_next(&batch, project.matching, extent, progress)?.next;
        for groups in layers(&batch) {
            let [source, target] = [&batch.at, &next].map(|photons| column(photons, &groups));
            if mean_straight(&source, &target) > 0.0 {
                let (source, target) = (source.into_owned(), target.into_owned());
                return Ok(FirstMove { source, target, extent, lines, walls, number });
            }
        }
        batch.arrive(next);
    }
    let what = "no photon moves from one key frame to the next, so there is no flow to look at";
    Err(Error::value("keys", what))
}

/// The groups that have photons to move until the next key, those together that share a field.
fn layers(batch: &Batch) -> Vec<Vec<usize>> {
    let grouping = batch.supplies().grouping();
    let moves = |group: &usize| !batch.rests(*group) && !batch.at[*group].positions.is_empty();
    let (own, shared): (Vec<_>, Vec<_>) =
        (0..grouping.count()).filter(moves).partition(|&group| grouping.own_flow(group));
    let shared = Some(shared).filter(|groups| !groups.is_empty());
    shared.into_iter().chain(own.into_iter().map(|group| vec![group])).collect()
}

/// The positions of several groups after each other; borrowed where it is but one.
fn column<'a>(photons: &'a [KeyPhotons], groups: &[usize]) -> Cow<'a, [Vec2]> {
    match groups {
        [group] => Cow::Borrowed(&photons[*group].positions),
        _ => groups.iter().flat_map(|&group| &photons[group].positions).copied().collect(),
    }
}

/// The photons' targets at the next key, group by group.
struct Paired {
    maps: Vec<Option<TransportMap>>,
    next: Vec<KeyPhotons>,
    /// Cost over a lower bound of the optimum; absent where rows are paired as given and where nothing moves.
    cost_ratio: Option<f64>,
}

fn match_next(batch: &Batch, method: Method, extent: Vec2, progress: &Progress) -> Result<Paired> {
    let mut paired = Paired { maps: Vec::new(), next: Vec::new(), cost_ratio: None };
    // Sums over the photons of all groups.
    let (mut cost, mut bound) = (0.0, 0.0);
    for (group, at) in batch.at.iter().enumerate() {
        let points = batch.next_points(group);
        let from = &at.positions;
        let map = if method == Method::Given || batch.rests(group) || from.is_empty() {
            None
        } else {
            Some(transport_map(from, &points.positions, extent, &progress.inner())?)
        };
        let least = match &map {
            Some(map) => Some(dual_bound(map, from, &points.positions, progress)?),
            None => None,
        };
        let next = batch.pair(group, points, map.as_ref(), &progress.inner())?;
        if let Some(least) = least {
            let photons = from.len() as f64;
            cost += photons * mean_square_distance(from, next.positions.iter().copied());
            bound += photons * least;
            // Nothing to move costs nothing, which is the optimum.
            paired.cost_ratio = Some(if bound > 0.0 { cost / bound } else { 1.0 });
        }
        paired.maps.push(map);
        paired.next.push(next);
    }
    Ok(paired)
}
