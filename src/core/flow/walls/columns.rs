//! Further columns of photons where walls stand: positions, and states on the paths around walls.

use glam::Vec2;
use rayon::prelude::*;

use super::obstacles::Obstacles;
use super::path_state::{PathState, PathStatus};
use super::violations::WallViolations;
use super::walker::{Photon, StepPath, Walker};
use crate::constraint::VisibilityGraph;
use crate::constraint::visibility::SearchBuffers;
use crate::flow::fade::Fade;
use crate::flow::step::{CHUNK, Step};
use crate::{Progress, Result};

/// The columns that walls need.
pub(crate) struct WallColumns<'a> {
    obstacles: &'a Obstacles,
    /// Positions at the begin of the current step.
    from: Vec<Vec2>,
    /// Positions at its end; before the first step, at the start.
    at: Vec<Vec2>,
    states: Vec<PathState>,
    /// The fade, and the speed that its limit is relative to.
    fade: (Fade, f32),
    /// Whether the paths are known.
    ready: bool,
    step: usize,
    /// Wall crossings of photons with a reachable target, over all steps.
    crossings: usize,
}

/// The columns of the photons that a step writes or reads.
pub(crate) struct Columns<'a> {
    pub(crate) guidance: &'a mut [Vec2],
    pub(crate) curve: &'a mut [[Vec2; 3]],
    pub(crate) targets: &'a [Vec2],
    pub(crate) inverse_speed_limits: &'a [f32],
}

/// Lost photons and wall crossings of a step.
#[derive(Clone, Copy, Default)]
struct Losses {
    lost: usize,
    crossings: usize,
}

impl<'a> WallColumns<'a> {
    /// Photons at `source`.
    pub(crate) fn new(obstacles: &'a Obstacles, source: &[Vec2], fade: (Fade, f32)) -> Self {
        let states = vec![PathState::NEW; source.len()];
        let (from, at) = (source.to_vec(), source.to_vec());
        Self { obstacles, from, at, states, fade, ready: false, step: 0, crossings: 0 }
    }

    /// Finds the paths to `targets` and sets the inverse speed limits; once.
    pub(crate) fn find_paths(
        &mut self,
        targets: &[Vec2],
        inverse_speed_limits: &mut Vec<f32>,
        progress: &Progress,
    ) -> Result<()> {
        if std::mem::replace(&mut self.ready, true) {
            return Ok(());
        }
        self.obstacles.find_paths(0, &self.at, targets, &mut self.states, progress)?;
        let (fade, reference_speed) = self.fade;
        let limit = |length| 1.0 / fade.speed_limit(length, reference_speed).max(f32::MIN_POSITIVE);
        *inverse_speed_limits =
            self.obstacles.lengths(&self.states, &self.at, targets).into_iter().map(limit).collect();
        Ok(())
    }

    /// Unreachable targets and wall crossings so far.
    pub(crate) fn violations(&self) -> WallViolations {
        let unreachable = |state: &&PathState| state.status == PathStatus::Unreachable;
        WallViolations {
            unreachable: self.states.iter().filter(unreachable).count(),
            crossings: self.crossings,
        }
    }

    /// Advances all photons through `step`; returns the number that are no longer finite.
    pub(crate) fn advance(&mut self, step: &Step, columns: Columns, progress: &Progress) -> Result<usize> {
        if step.number > 0 && self.obstacles.changes(step.number) {
            self.obstacles.find_paths(step.number, &self.at, columns.targets, &mut self.states, progress)?;
        }
        self.step = step.number;
        let graph = self.obstacles.graph(step.number);
        let columns = (
            columns.guidance.par_chunks_mut(CHUNK),
            columns.curve.par_chunks_mut(CHUNK),
            columns.targets.par_chunks(CHUNK),
            columns.inverse_speed_limits.par_chunks(CHUNK),
            self.from.par_chunks_mut(CHUNK),
            self.at.par_chunks_mut(CHUNK),
            self.states.par_chunks_mut(CHUNK),
        );
        let losses = columns
            .into_par_iter()
            .map(|(guidance, curve, targets, inverse_speed_limits, from, at, states)| {
                progress.check()?;
                let (mut losses, mut buffers) = (Losses::default(), SearchBuffers::default());
                for i in 0..at.len() {
                    let photon =
                        Photon { at: at[i], target: targets[i], inverse_limit: inverse_speed_limits[i] };
                    from[i] = at[i];
                    let v = photon.guidance(step);
                    (guidance[i], curve[i], at[i]) =
                        match advance(step, graph, &photon, &mut states[i], &mut buffers) {
                            StepPath::Cubic(curve) => (v, curve, photon.end_of(step, &curve)),
                            StepPath::Line(to) => (v, [Vec2::ZERO; 3], to),
                        };
                    losses.lost += usize::from(!at[i].is_finite());
                    let crosses = graph.is_some_and(|graph| graph.barriers().blocks(from[i], at[i]));
                    losses.crossings += usize::from(crosses && states[i].status != PathStatus::Unreachable);
                }
                Ok(losses)
            })
            .try_reduce(Losses::default, |a, b| {
                Ok(Losses { lost: a.lost + b.lost, crossings: a.crossings + b.crossings })
            })?;
        self.crossings += losses.crossings;
        Ok(losses.lost)
    }

    /// The position of photon `i` at the fraction `x` of the step, unless its cubic tells it.
    #[inline]
    pub(crate) fn position(&self, i: usize, x: f32) -> Option<Vec2> {
        if x <= 0.0 {
            Some(self.from[i])
        } else if x >= 1.0 {
            Some(self.at[i])
        } else {
            self.states[i].on_line.then(|| self.from[i].lerp(self.at[i], x))
        }
    }

    /// The displacement of photon `i` over the step, where it moves along a line.
    #[inline]
    pub(crate) fn displacement(&self, i: usize) -> Option<Vec2> {
        self.states[i].on_line.then(|| self.at[i] - self.from[i])
    }

    /// Guidance at the end of the step, `time_left` before t = 1: along the paths, at the speed that arrives in time.
    pub(crate) fn guidance(&self, targets: &[Vec2], time_left: f32, out: &mut [Vec2]) {
        let graph = self.obstacles.graph(self.step);
        let columns = (out.par_iter_mut(), self.states.par_iter(), self.at.par_iter(), targets.par_iter());
        columns.into_par_iter().for_each(|(out, state, &c, &b)| {
            *out = state.guidance(graph, c, b, time_left);
        });
    }
}

/// Advances one photon; `graph` is none where no wall stands.
fn advance(
    step: &Step,
    graph: Option<&VisibilityGraph>,
    photon: &Photon,
    state: &mut PathState,
    buffers: &mut SearchBuffers,
) -> StepPath {
    match graph {
        Some(graph) => Walker { step, graph }.advance(photon, state, buffers),
        None => {
            state.on_line = false;
            StepPath::Cubic(photon.curve(step))
        }
    }
}
