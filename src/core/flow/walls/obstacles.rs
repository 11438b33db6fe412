//! The walls of a segment over its steps, and the paths around them.

use std::sync::{Arc, OnceLock};

use glam::Vec2;
use rayon::prelude::*;

use super::clearance::Clearance;
use super::path_state::{PathState, PathStatus};
use crate::bridge::{Cells, Sight};
use crate::constraint::visibility::SearchBuffers;
use crate::constraint::{ActiveWall, VisibilityGraph, WallPath, stroke};
use crate::flow::field::Grid;
use crate::{Progress, Result};

/// Photons per parallel task.
const CHUNK: usize = 1024;
/// Steps of the photons for each field where walls stand.
pub(crate) const SUBSTEPS: usize = 4;
/// Weight of the no-penetration term of a wall of length 1, over that of all photons: see
/// [`Obstacles::no_penetration`].
const STIFFNESS: f64 = 10.0;

/// The walls of a segment over its steps.
#[derive(serde::Deserialize, serde::Serialize)]
pub(crate) struct Obstacles {
    walls: Vec<ActiveWall>,
    extent: Vec2,
    steps: usize,
    /// Ordered by time, the first from step 0 on.
    epochs: Vec<Epoch>,
}

/// A run of steps in which the same walls stand.
#[derive(serde::Deserialize, serde::Serialize)]
struct Epoch {
    first: usize,
    standing: Vec<usize>,
    /// None where no wall stands.
    graph: Option<Arc<VisibilityGraph>>,
    /// Made when first asked for.
    #[serde(skip)]
    clearance: OnceLock<Clearance>,
    /// In the cells of the plan, which are the same at all times.
    #[serde(skip)]
    sight: OnceLock<Sight>,
}

impl Obstacles {
    /// The walls over `fits` fits of [`SUBSTEPS`] steps each on the rectangle `extent`; none where no wall stands at any
    /// time. They change at every `granule`-th step at most. Also returns the number of fits, which grows where paths have more corners than there are steps.
    ///
    /// # Errors
    /// `Limit` for walls of too many corners; `Cancelled`.
    pub(crate) fn new(
        walls: &[ActiveWall],
        (fits, granule): (usize, usize),
        extent: Vec2,
        progress: &Progress,
    ) -> Result<(Option<Self>, usize)> {
        if walls.is_empty() {
            return Ok((None, fits));
        }
        let mut steps = fits * SUBSTEPS;
        // A photon turns at most once a step, so that the longest path sets the least number of steps.
        for _ in 0..2 {
            let all = Self {
                walls: walls.to_vec(),
                extent,
                steps,
                epochs: epochs(walls, (steps, granule), extent, progress)?,
            };
            let needed = 2 + all.most_corners();
            if needed <= steps {
                let stands = all.epochs.iter().any(|epoch| epoch.graph.is_some());
                return Ok((stands.then_some(all), steps / SUBSTEPS));
            }
            // An even number of fits: a meeting needs halves.
            steps = needed.next_multiple_of(2 * SUBSTEPS);
        }
        let epochs = epochs(walls, (steps, granule), extent, progress)?;
        Ok((Some(Self { walls: walls.to_vec(), extent, steps, epochs }), steps / SUBSTEPS))
    }

    /// The largest number of corners on a path, at any time.
    fn most_corners(&self) -> usize {
        self.epochs
            .iter()
            .filter_map(|epoch| epoch.graph.as_ref())
            .map(|graph| graph.most_corners())
            .max()
            .unwrap_or(0)
    }

    fn index(&self, step: usize) -> usize {
        self.epochs.partition_point(|epoch| epoch.first <= step).saturating_sub(1)
    }

    /// The visibility graph of step `step`; none where no wall stands.
    pub(crate) fn graph(&self, step: usize) -> Option<&VisibilityGraph> {
        self.epochs[self.index(step)].graph.as_deref()
    }

    /// As [`Self::graph`], shared.
    pub(crate) fn shared_graph(&self, step: usize) -> Option<Arc<VisibilityGraph>> {
        self.epochs[self.index(step)].graph.clone()
    }

    /// The graph of all walls that stand at any time; none where there is none.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub(crate) fn graph_of_all(&self, progress: &Progress) -> Result<Option<Arc<VisibilityGraph>>> {
        if let [only] = &self.epochs[..] {
            return Ok(only.graph.clone());
        }
        let stands = |i: &usize| self.epochs.iter().any(|epoch| epoch.standing.contains(i));
        let walls: Vec<&ActiveWall> = (0..self.walls.len()).filter(stands).map(|i| &self.walls[i]).collect();
        if walls.is_empty() {
            return Ok(None);
        }
        VisibilityGraph::new(&walls, self.extent, progress).map(|graph| Some(Arc::new(graph)))
    }

    /// How far the walls of step `step` are; none where none stands.
    pub(crate) fn clearance(&self, step: usize) -> Option<&Clearance> {
        let epoch = &self.epochs[self.index(step)];
        let graph = epoch.graph.as_ref()?;
        Some(epoch.clearance.get_or_init(|| Clearance::new(graph.barriers(), self.extent)))
    }

    /// Where the walls of step `step` leave the cells of the plan in sight; none where none stands.
    pub(crate) fn sight(&self, step: usize, cells: &Cells) -> Option<&Sight> {
        let epoch = &self.epochs[self.index(step)];
        let graph = epoch.graph.as_ref()?;
        Some(epoch.sight.get_or_init(|| Sight::new(cells, graph.barriers())))
    }

    /// Steps of the photons over the whole segment.
    pub(crate) fn steps(&self) -> usize {
        self.steps
    }

    /// The runs of steps in which the same walls stand, by their first step, with the visibility graph of each.
    pub(crate) fn epochs(&self) -> impl Iterator<Item = (usize, Option<&VisibilityGraph>)> {
        self.epochs.iter().map(|epoch| (epoch.first, epoch.graph.as_deref()))
    }

    /// Whether step `step` begins with other walls than the step before; true for step 0.
    pub(crate) fn changes(&self, step: usize) -> bool {
        self.epochs[self.index(step)].first == step
    }

    /// Whether walls change after step `step`.
    fn will_change(&self, step: usize) -> bool {
        self.index(step) + 1 < self.epochs.len()
    }

    /// Finds the paths from `positions` to `targets` from step `step` on. Unreachable photons stay so.
    pub(super) fn find_paths(
        &self,
        step: usize,
        positions: &[Vec2],
        targets: &[Vec2],
        states: &mut [PathState],
        progress: &Progress,
    ) -> Result<()> {
        let separated = if self.will_change(step) { PathStatus::Waiting } else { PathStatus::Unreachable };
        let graph = self.graph(step);
        let columns = (states.par_chunks_mut(CHUNK), positions.par_chunks(CHUNK), targets.par_chunks(CHUNK));
        columns.into_par_iter().try_for_each(|(states, positions, targets)| {
            progress.check()?;
            let mut buffers = SearchBuffers::default();
            for ((state, &c), &b) in states.iter_mut().zip(positions).zip(targets) {
                if state.status == PathStatus::Unreachable {
                    continue;
                }
                // A path with more corners than steps left is none.
                let in_time =
                    |path: &WallPath| graph.is_none_or(|g| g.corners_ahead(*path) < self.steps - step);
                let path = graph.map_or(Some(WallPath::STRAIGHT), |graph| graph.path(c, b, &mut buffers));
                let path = path.filter(in_time);
                state.path = path.unwrap_or(WallPath::STRAIGHT);
                state.status = if path.is_some() { PathStatus::Following } else { separated };
            }
            Ok(())
        })
    }

    /// Lengths of the paths from `positions` to `targets` at the start, plane units.
    pub(super) fn lengths(&self, states: &[PathState], positions: &[Vec2], targets: &[Vec2]) -> Vec<f32> {
        let graph = self.graph(0);
        let columns = (states.par_iter(), positions.par_iter(), targets.par_iter());
        let length = |(state, &c, &b): (&PathState, &Vec2, &Vec2)| {
            graph.map_or(c.distance(b), |graph| graph.length(state.path, c, b))
        };
        columns.into_par_iter().map(length).collect()
    }

    /// Guidance of photons at `positions` in step `step`, bound for `targets`, `time_left` before t = 1.
    pub(crate) fn guidance(
        &self,
        step: usize,
        time_left: f32,
        (positions, targets): (&[Vec2], &[Vec2]),
        progress: &Progress,
    ) -> Result<Vec<Vec2>> {
        let mut states = vec![PathState::NEW; positions.len()];
        self.find_paths(step, positions, targets, &mut states, progress)?;
        let graph = self.graph(step);
        let columns = (states.par_iter(), positions.par_iter(), targets.par_iter());
        let guidance = |(state, &c, &b): (&PathState, &Vec2, &Vec2)| state.guidance(graph, c, b, time_left);
        Ok(columns.into_par_iter().map(guidance).collect())
    }

    /// Mean length of the paths at the start.
    pub(crate) fn mean_path_length(
        &self,
        source: &[Vec2],
        target: &[Vec2],
        progress: &Progress,
    ) -> Result<f32> {
        let mut states = vec![PathState::NEW; source.len()];
        self.find_paths(0, source, target, &mut states, progress)?;
        let sum: f64 = self.lengths(&states, source, target).into_iter().map(f64::from).sum();
        Ok((sum / source.len().max(1) as f64) as f32)
    }

    /// The no-penetration term of the walls of step `step`: points sampled along them every half cell, their normals, and
    /// the weight of each, `STIFFNESS` times length where Term (3) gives all photons together weight 1.
    pub(crate) fn no_penetration(&self, step: usize, grid: Grid) -> (Vec<Vec2>, Vec<Vec2>, f64) {
        let [width, height] = grid.cell_size();
        let spacing = 0.5 * width.min(height) as f32;
        let (mut positions, mut normals) = (Vec::new(), Vec::new());
        for &wall in &self.epochs[self.index(step)].standing {
            let line = &self.walls[wall].points;
            let most = (stroke::length(line) / spacing) as usize + 2;
            for (position, direction) in stroke::resample(line, spacing, most) {
                if position.cmpge(Vec2::ZERO).all() && position.cmple(self.extent).all() {
                    positions.push(position);
                    normals.push(direction.perp());
                }
            }
        }
        (positions, normals, STIFFNESS * f64::from(spacing))
    }
}

/// The runs of steps between changes of the walls.
fn epochs(
    walls: &[ActiveWall],
    (steps, granule): (usize, usize),
    extent: Vec2,
    progress: &Progress,
) -> Result<Vec<Epoch>> {
    let mut epochs: Vec<Epoch> = Vec::new();
    for step in (0..steps).step_by(granule) {
        let (start, end) = (step as f64 / steps as f64, (step + granule) as f64 / steps as f64);
        // A wall that stands for a part of a step stands for all of it.
        let standing: Vec<usize> =
            (0..walls.len()).filter(|&i| walls[i].window.touches(start, end)).collect();
        if epochs.last().is_some_and(|epoch| epoch.standing == standing) {
            continue;
        }
        let here: Vec<&ActiveWall> = standing.iter().map(|&i| &walls[i]).collect();
        let graph = match here.is_empty() {
            true => None,
            false => Some(Arc::new(VisibilityGraph::new(&here, extent, progress)?)),
        };
        epochs.push(Epoch {
            first: step,
            standing,
            graph,
            clearance: OnceLock::new(),
            sight: OnceLock::new(),
        });
    }
    Ok(epochs)
}
