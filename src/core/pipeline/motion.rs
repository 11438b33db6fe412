//! The flow of a whole project: one continuous map and one sequence of fields per segment.

use glam::Vec2;

use super::batch::Batch;
use super::meter::Meter;
use super::summary::FlowNumbers;
use super::supply::KeyPhotons;
use crate::flow::guidance::mean_straight;
use crate::flow::{Course, Fields, FlowSettings, fit_segment};
use crate::matching::{Method, TransportMap, dual_bound, mean_square_distance, transport_map};
use crate::project::{KeyFrame, PlaneSettings, Project};
use crate::scene::SceneDesc;
use crate::{Error, Progress, Result};

/// From one key to the next.
pub(super) struct Segment {
    /// Where the light of this key goes at the next; absent where rows are paired as given.
    pub(super) map: Option<TransportMap>,
    /// The vector field, step by step.
    pub(super) fields: Fields,
}

/// How the light of a project moves; empty where there is one key.
pub(super) struct Motion {
    pub(super) segments: Vec<Segment>,
    /// The worst over the segments; absent where nothing moves.
    pub(super) numbers: Option<FlowNumbers>,
}

/// All that a motion depends on.
#[derive(Clone, PartialEq)]
pub(super) struct MotionInput {
    scene: Option<SceneDesc>,
    plane: PlaneSettings,
    keys: Vec<KeyFrame>,
    matching: Method,
    flow: FlowSettings,
    seed: u64,
    photons: usize,
}

impl MotionInput {
    /// The motion does not depend on the numbers of the frames, nor on the camera.
    pub(super) fn new(project: &Project, photons: usize) -> Self {
        let plain = |key: &KeyFrame| KeyFrame { frame: 0, ease: Default::default(), ..key.clone() };
        let seen = |scene: &SceneDesc| SceneDesc {
            camera: Default::default(),
            environment: Default::default(),
            ..scene.clone()
        };
        Self {
            scene: project.scene.as_ref().map(seen),
            plane: project.plane.clone(),
            keys: project.keys.iter().map(plain).collect(),
            matching: project.matching,
            flow: project.flow.clone(),
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
    let mut motion = Motion { segments: Vec::new(), numbers: None };
    for number in 0..project.keys.len().saturating_sub(1) {
        progress.begin("match", 1);
        let paired = meter.measure("match", || match_next(&batch, project.matching, extent, progress))?;
        let (fields, report) = meter.measure("fit", || {
            let (source, target) = (&batch.at.positions[..], &paired.next.positions[..]);
            fit_segment(&Course { source, target, extent, settings: &project.flow, number }, progress, None)
        })?;
        let numbers = FlowNumbers { flow: report, transport_cost_ratio: paired.cost_ratio, flux_ratio: 1.0 };
        motion.numbers = Some(match motion.numbers.take() {
            Some(sum) => sum.worst(numbers),
            None => numbers,
        });
        motion.segments.push(Segment { map: paired.map, fields });
        batch.arrive(paired.next);
    }
    Ok(motion)
}

/// The photons of the first two key frames between which they move: row k of `target` is where photon k of `source` goes.
pub struct FirstMove {
    /// Positions at the earlier key, plane units.
    pub source: Vec<Vec2>,
    /// Positions at the later one.
    pub target: Vec<Vec2>,
    /// Size of the plane; its longer side is 1.
    pub extent: Vec2,
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
    for number in 0..project.keys.len().saturating_sub(1) {
        progress.begin("match", 1);
        let next = match_next(&batch, project.matching, extent, progress)?.next;
        if mean_straight(&batch.at.positions, &next.positions) > 0.0 {
            return Ok(FirstMove { source: batch.at.positions, target: next.positions, extent, number });
        }
        batch.arrive(next);
    }
    Err(Error::value(
        "keys",
        "no photon moves from one key frame to the next, so there is no flow to look at",
    ))
}

/// The photons' targets at the next key.
struct Paired {
    map: Option<TransportMap>,
    next: KeyPhotons,
    /// Cost over a lower bound of the optimum; absent where rows are paired as given.
    cost_ratio: Option<f64>,
}

fn match_next(batch: &Batch, method: Method, extent: Vec2, progress: &Progress) -> Result<Paired> {
    let points = batch.next_points();
    if method == Method::Given {
        let next = batch.pair(points, None, &progress.inner())?;
        return Ok(Paired { map: None, next, cost_ratio: None });
    }
    let from = &batch.at.positions;
    let map = transport_map(from, &points.positions, extent, &progress.inner())?;
    let bound = dual_bound(&map, from, &points.positions, progress)?;
    let next = batch.pair(points, Some(&map), &progress.inner())?;
    let cost = mean_square_distance(from, next.positions.iter().copied());
    // Nothing to move costs nothing, which is the optimum.
    let cost_ratio = if bound > 0.0 { cost / bound } else { 1.0 };
    Ok(Paired { map: Some(map), next, cost_ratio: Some(cost_ratio) })
}
