//! The flow of a whole project: one continuous map and one sequence of fields per segment.

use glam::Vec2;

use super::batch::Batch;
use super::course;
use super::meter::Meter;
use super::summary::FlowNumbers;
use super::supply::KeyPhotons;
use crate::flow::{Course, FlowSettings, Movement};
use crate::matching::{ContinuousMap, Method, mean_square_distance};
use crate::project::{KeyFrame, PlaneSettings, Project};
use crate::scene::SceneDesc;
use crate::{Progress, Result};

/// From one key to the next.
pub(super) struct Segment {
    /// Where the light of this key goes at the next; absent where rows are paired as given.
    pub(super) map: Option<ContinuousMap>,
    /// What moves the photons.
    pub(super) course: Course,
    /// What the pairing of pass 0 costs.
    pub(super) cost: Cost,
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
    method: Movement,
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
            method: project.method,
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
    for _ in 1..project.keys.len() {
        progress.begin("match", 1);
        let Paired { map, next, cost } =
            meter.measure("match", || match_next(&batch, project, extent, progress))?;
        let (course, flow) = course::course(project, &batch.at, &next, extent, meter, progress)?;
        let numbers = FlowNumbers::new(flow, &cost);
        motion.numbers = Some(match motion.numbers.take() {
            Some(sum) => sum.worst(numbers),
            None => numbers,
        });
        motion.segments.push(Segment { map, course, cost });
        batch.arrive(next);
    }
    Ok(motion)
}

/// The photons' targets at the next key.
struct Paired {
    map: Option<ContinuousMap>,
    next: KeyPhotons,
    cost: Cost,
}

/// What a pairing costs, in squared plane units.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cost {
    /// Mean squared distance of the pairs.
    pub(super) mean: f64,
    /// A lower bound of that of any pairing; absent where nobody asked or the method has none to tell.
    pub(super) bound: Option<f64>,
}

impl Cost {
    /// Over the bound, or over that of another method on the same points.
    pub(super) fn ratio(&self, bound: Option<f64>) -> Option<f64> {
        // Nothing to move costs nothing, which is the optimum.
        bound.map(|bound| if bound > 0.0 { self.mean / bound } else { 1.0 })
    }
}

fn match_next(batch: &Batch, project: &Project, extent: Vec2, progress: &Progress) -> Result<Paired> {
    let (points, from) = (batch.next_points(), &batch.at.positions);
    let map = course::continuous_map(project, from, &points.positions, extent, &progress.inner())?;
    let bound = match &map {
        Some(map) => map.lower_bound(from, &points.positions, &progress.inner())?,
        None => None,
    };
    let next = batch.pair(points, map.as_ref(), &progress.inner())?;
    let mean = mean_square_distance(from, next.positions.iter().copied());
    Ok(Paired { map, next, cost: Cost { mean, bound } })
}
