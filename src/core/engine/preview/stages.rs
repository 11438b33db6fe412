//! The stages of one detail, with what they remember.

use std::sync::Arc;

use glam::Vec2;

use super::growing::{Composition, Growing};
use crate::flow::{FlowReport, FlowSettings, Movement};
use crate::matching::{ContinuousMap, Method};
use crate::photon::{Lesson, Photons, Tracer};
use crate::engine::acting::{Acting, acting};
use crate::engine::batch::Batch;
use crate::engine::grouping::CausticLight;
use crate::engine::light::{KeyPhotons, Partners};
use crate::engine::meter::Meter;
use crate::engine::motion::{Cost, LayerMoments, Leg, Paired, Segment, layers, match_next};
use crate::engine::mover::Kind;
use crate::engine::ride::Ride;
use crate::engine::stage::{Same, Stage};
use crate::engine::supply::{Supplies, Supply};
use crate::project::{CausticDesc, Project};
use crate::scene::Scene;
use crate::{Progress, Result};

/// What the stages of one detail remember.
#[derive(Default)]
pub(super) struct Level {
    photons: Stage<(Same<Lesson>, usize), Arc<Photons>>,
    /// By segment.
    matched: Vec<Stage<MatchInput, Arc<Matched>>>,
    fitted: Vec<Stage<FitInput, Arc<Fitted>>>,
    frames: Vec<Stage<FramesInput, Arc<Frames>>>,
}

/// What all stages of a sketch are given.
pub(super) struct Job<'a> {
    /// The project, no more work than the detail is worth.
    pub(super) project: &'a Project,
    pub(super) extent: Vec2,
    pub(super) supplies: &'a Supplies,
    /// The scene and where its lights must shine, where photons are traced.
    pub(super) source: Option<(Arc<Scene>, Arc<Lesson>)>,
    pub(super) count: usize,
    /// Most anchors of a map around walls.
    pub(super) anchors: usize,
    pub(super) progress: &'a Progress,
}

/// The photons at all keys, matched.
pub(super) struct Walk {
    /// By key, then by group.
    pub(super) stops: Vec<Vec<KeyPhotons>>,
    /// The flux that they should have at each key but for rho, watts.
    pub(super) asked: Vec<f64>,
    pub(super) caustics: Vec<CausticLight>,
    matched: Vec<Arc<Matched>>,
    /// By segment: the groups that move, those together that share a field.
    layers: Vec<Vec<Vec<usize>>>,
}

/// Who goes where in one segment.
struct Matched {
    partners: Vec<Partners>,
    maps: Arc<Vec<Option<ContinuousMap>>>,
    cost: Cost,
}

/// What a matching is made from.
#[derive(PartialEq)]
struct MatchInput {
    from: From,
    shown: Vec<Same<Supply>>,
    kind: Kind,
    /// The maps of another detail, where those are followed.
    maps: Option<Same<Vec<Option<ContinuousMap>>>>,
}

/// The photons at the key before.
#[derive(PartialEq)]
enum From {
    /// At the first key.
    Start {
        photons: Option<Same<Photons>>,
        count: usize,
        seed: u64,
        extent: Vec2,
        caustics: Vec<CausticDesc>,
        method: Method,
        shown: Vec<Same<Supply>>,
    },
    /// As they were matched.
    Matched(Same<Matched>),
}

/// What the fit of a segment is made from.
#[derive(PartialEq)]
struct FitInput {
    matched: Same<Matched>,
    acting: Acting,
    method: Movement,
    flow: FlowSettings,
}

/// A segment, and how its layers flow.
pub(super) struct Fitted {
    pub(super) segment: Arc<Segment>,
    pub(super) reports: Vec<FlowReport>,
}

/// What the frames of a segment are made from.
#[derive(PartialEq)]
struct FramesInput {
    fitted: Same<Fitted>,
    matched: Same<Matched>,
    times: Vec<f64>,
}

/// All photons at the frames of a segment.
type Frames = Vec<Arc<[Vec2]>>;

impl Level {
    /// The photons at all keys; along the maps of `guide`, where that is given.
    pub(super) fn walk(&mut self, job: &Job, guide: Option<&Walk>, meter: &mut Meter) -> Result<Walk> {
        let Job { project, extent, supplies, progress, .. } = *job;
        let photons = self.photons(job, meter)?;
        let mut from = From::Start {
            photons: photons.as_ref().map(Same::of),
            count: job.count,
            seed: project.seed,
            extent,
            caustics: project.caustics.clone(),
            method: project.matching,
            shown: supplies.shown_at(0).iter().map(Same::of).collect(),
        };
        let light = supplies.light_of(photons.map(|photons| (*photons).clone()), job.count);
        let caustics = supplies.caustics(&light);
        let mut batch = Batch::start(supplies, light, 0, project, extent).with_anchors(job.anchors);
        let (mut stops, mut asked) = (vec![batch.at.clone()], vec![batch.asked()]);
        let segments = project.keys.len() - 1;
        self.matched.resize_with(segments, Stage::default);
        let (mut all_matched, mut all_layers) = (Vec::new(), Vec::new());
        for segment in 0..segments {
            let maps = guide.map(|guide| guide.matched[segment].maps.clone());
            let input = MatchInput {
                from,
                shown: supplies.shown_at(segment + 1).iter().map(Same::of).collect(),
                kind: Kind::of(project, segment, extent),
                maps: maps.as_ref().map(Same::of),
            };
            let mut fresh = None;
            let matched = self.matched[segment].get(input, |_| {
                let paired = meter.measure("match", || match maps {
                    Some(maps) => follow(&batch, maps, progress),
                    None => new_match(&batch, progress),
                })?;
                let (matched, next) = paired;
                fresh = Some(next);
                Ok::<_, crate::Error>(Arc::new(matched))
            })?;
            let arrange = |(group, partners): (usize, &Partners)| partners.arrange(batch.next_points(group));
            let next = fresh.unwrap_or_else(|| matched.partners.iter().enumerate().map(arrange).collect());
            all_layers.push(layers(&batch));
            batch.arrive(next);
            stops.push(batch.at.clone());
            asked.push(batch.asked());
            from = From::Matched(Same::of(&matched));
            all_matched.push(matched);
        }
        Ok(Walk { stops, asked, caustics, matched: all_matched, layers: all_layers })
    }

    fn photons(&mut self, job: &Job, meter: &mut Meter) -> Result<Option<Arc<Photons>>> {
        let Some((scene, lesson)) = &job.source else { return Ok(None) };
        let photons = self.photons.get((Same::of(lesson), job.count), |_| {
            meter.measure("trace", || {
                let tracer = Tracer::resume(scene, (**lesson).clone());
                let (photons, _) = tracer.trace(0, job.count, &job.progress.inner())?;
                Ok::<_, crate::Error>(Arc::new(photons))
            })
        })?;
        Ok(Some(photons))
    }

    /// Fits segment `number` and works out its frames on the way.
    pub(super) fn fit(
        &mut self,
        job: &Job,
        walk: &Walk,
        number: usize,
        growing: Option<&mut Growing>,
        meter: &mut Meter,
    ) -> Result<Arc<Fitted>> {
        let Job { project, extent, progress, .. } = *job;
        let matched = &walk.matched[number];
        let (at, next) = (&*walk.stops[number], &*walk.stops[number + 1]);
        // Neither rho nor the numbers of the frames change where photons go.
        let flow = FlowSettings { rho: 1.0, ..project.flow.clone() };
        let acting = acting(project, number, extent);
        let input = FitInput { matched: Same::of(matched), acting, method: project.method, flow };
        self.fitted.resize_with(walk.matched.len(), Stage::default);
        let (slots, times) = growing.as_ref().map_or_else(Default::default, |g| g.between_keys(number));
        let mut growing = growing;
        let mut frames = Vec::new();
        let fitted = self.fitted[number].get(input, |input| {
            let leg = Leg { at, next, acting: &input.acting, number, extent };
            let layers = walk.layers[number].clone();
            let mut composition = Composition::new(at, layers.len(), times.len());
            let show = &mut |groups: &[usize], moment: usize, positions: &[Vec2]| {
                let composed = composition.as_mut().and_then(|c| c.take(groups, moment, positions));
                if let (Some(positions), Some(growing)) = (composed, &mut growing) {
                    growing.add(slots[moment], &positions);
                    frames.push(positions);
                }
            };
            let moments = Some(LayerMoments { times: &times, show });
            let (layers, reports) = leg.fit(layers, project, moments, meter, progress)?;
            let segment = Segment { maps: matched.maps.clone(), layers, cost: matched.cost };
            Ok::<_, crate::Error>(Arc::new(Fitted { segment: Arc::new(segment), reports }))
        })?;
        if let Some(growing) = growing {
            let drawn = Some(frames).filter(|frames| frames.len() == times.len());
            self.carry(job, walk, number, (&fitted, drawn), growing, meter)?;
        }
        Ok(fitted)
    }

    /// Works out the frames of segment `number` along its fields; `drawn` where they are known.
    pub(super) fn carry(
        &mut self,
        job: &Job,
        walk: &Walk,
        number: usize,
        (fitted, drawn): (&Arc<Fitted>, Option<Frames>),
        growing: &mut Growing,
        meter: &mut Meter,
    ) -> Result<()> {
        let (slots, times) = growing.between_keys(number);
        let matched = Same::of(&walk.matched[number]);
        let input = FramesInput { fitted: Same::of(fitted), matched, times };
        self.frames.resize_with(walk.matched.len(), Stage::default);
        let frames = self.frames[number].get(input, |FramesInput { times, .. }| match drawn {
            Some(frames) => Ok(Arc::new(frames)),
            None => meter.measure("carry", || {
                let (at, next) = (&walk.stops[number], &walk.stops[number + 1]);
                let mut ride = Ride::new(&fitted.segment, at, next);
                let mut frames = Vec::with_capacity(times.len());
                for (&slot, &time) in slots.iter().zip(times) {
                    let mut positions = vec![Vec2::ZERO; ride.len()];
                    ride.positions_at(time, &mut positions, &job.progress.inner())?;
                    let positions = Arc::from(positions);
                    growing.add(slot, &positions);
                    frames.push(positions);
                }
                Ok::<_, crate::Error>(Arc::new(frames))
            }),
        })?;
        slots.iter().zip(&*frames).for_each(|(&slot, positions)| growing.add(slot, positions));
        growing.fitted(number, &fitted.segment);
        Ok(())
    }
}

fn new_match(batch: &Batch, progress: &Progress) -> Result<(Matched, Vec<KeyPhotons>)> {
    progress.begin("match", 1);
    let Paired { maps, partners, next, cost } = match_next(batch, false, progress)?;
    Ok((Matched { partners, maps: Arc::new(maps), cost }, next))
}

/// Pairs along known maps.
fn follow(
    batch: &Batch,
    maps: Arc<Vec<Option<ContinuousMap>>>,
    progress: &Progress,
) -> Result<(Matched, Vec<KeyPhotons>)> {
    progress.begin("match", 1);
    let (mut partners, mut next) = (Vec::new(), Vec::new());
    for (group, map) in maps.iter().enumerate() {
        let points = batch.next_points(group);
        let own = batch.partners(group, &points.positions, map.as_ref(), &progress.inner())?;
        next.push(own.arrange(points));
        partners.push(own);
    }
    Ok((Matched { partners, maps, cost: Cost::default() }, next))
}
