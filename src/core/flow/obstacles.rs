//! The walls of a segment, step by step: which stand when, and the ways around them.

use glam::Vec2;
use rayon::prelude::*;

use super::assembly::WallRows;
use super::field::Grid;
use super::fit::Fitter;
use super::trajectory::SUBSTEPS;
use crate::constraint::detour::Sight;
use crate::constraint::{ActiveWall, Detour, Way, stroke};
use crate::{Progress, Result};

/// Photons per parallel task.
const CHUNK: usize = 1024;
/// Price of flow through a wall, for a wall of length 1 over that of all photons: see [`Obstacles::wall_in`].
const STIFFNESS: f64 = 10.0;

/// Walls over the steps of a segment.
pub struct Obstacles {
    walls: Vec<ActiveWall>,
    extent: Vec2,
    steps: usize,
    /// In the order of time, the first from step 0 on.
    epochs: Vec<Epoch>,
}

/// Steps in which the same walls stand.
struct Epoch {
    first: usize,
    standing: Vec<usize>,
    /// None where no wall stands.
    detour: Option<Detour>,
}

/// How one photon goes on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Route {
    pub(super) way: Way,
    pub(super) state: State,
    /// Whether it moves along a straight line through the current step.
    pub(super) line: bool,
}

/// What a photon does about its way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum State {
    /// Follows it.
    Follows,
    /// Is shut off from its target now, and waits for a wall to go.
    Waits,
    /// Is shut off from its target for good, and goes straight.
    Passes,
}

impl Obstacles {
    /// The walls as they stand over `fits` fits, with [`SUBSTEPS`] steps each, on the rectangle `extent`; none where no wall
    /// stands at any time. Returns the number of fits too, which grows where ways turn more often than there are steps.
    ///
    /// # Errors
    /// `Limit` for walls of too many corners; `Cancelled`.
    pub fn new(
        walls: &[ActiveWall],
        fits: usize,
        extent: Vec2,
        progress: &Progress,
    ) -> Result<(Option<Self>, usize)> {
        if walls.is_empty() {
            return Ok((None, fits));
        }
        let mut steps = fits * SUBSTEPS;
        // A photon turns at most once a step: the walls as they stand now need so many steps.
        for _ in 0..2 {
            let all = Self {
                walls: walls.to_vec(),
                extent,
                steps,
                epochs: epochs(walls, steps, extent, progress)?,
            };
            let needed = 2 + all.longest();
            if needed <= steps {
                let stands = all.epochs.iter().any(|epoch| epoch.detour.is_some());
                return Ok((stands.then_some(all), steps / SUBSTEPS));
            }
            steps = needed.next_multiple_of(SUBSTEPS);
        }
        let epochs = epochs(walls, steps, extent, progress)?;
        Ok((Some(Self { walls: walls.to_vec(), extent, steps, epochs }), steps / SUBSTEPS))
    }

    /// Most corners on one way, at any time.
    fn longest(&self) -> usize {
        self.epochs.iter().filter_map(|epoch| epoch.detour.as_ref()).map(|d| d.longest()).max().unwrap_or(0)
    }

    fn index(&self, step: usize) -> usize {
        self.epochs.partition_point(|epoch| epoch.first <= step).saturating_sub(1)
    }

    /// The ways around the walls of step `step`; none where no wall stands.
    pub(super) fn detour(&self, step: usize) -> Option<&Detour> {
        self.epochs[self.index(step)].detour.as_ref()
    }

    /// Whether other walls stand in step `step` than in the step before; so in step 0.
    pub(super) fn changes(&self, step: usize) -> bool {
        self.epochs[self.index(step)].first == step
    }

    /// Whether walls change after step `step`.
    fn will_change(&self, step: usize) -> bool {
        self.index(step) + 1 < self.epochs.len()
    }

    /// How photons at `positions` go on to `targets` from step `step` on. Photons that pass, or have passed before, pass.
    pub(super) fn set_out(
        &self,
        step: usize,
        positions: &[Vec2],
        targets: &[Vec2],
        routes: &mut [Route],
        progress: &Progress,
    ) -> Result<()> {
        let shut_off = if self.will_change(step) { State::Waits } else { State::Passes };
        let detour = self.detour(step);
        let columns = (routes.par_chunks_mut(CHUNK), positions.par_chunks(CHUNK), targets.par_chunks(CHUNK));
        columns.into_par_iter().try_for_each(|(routes, positions, targets)| {
            progress.check()?;
            let mut sight = Sight::default();
            for ((route, &c), &b) in routes.iter_mut().zip(positions).zip(targets) {
                if route.state == State::Passes {
                    continue;
                }
                // A way with more turns than there are steps left is none.
                let in_time = |way: &Way| detour.is_none_or(|d| d.corners_ahead(*way) < self.steps - step);
                let way = detour.map_or(Some(Way::STRAIGHT), |detour| detour.way(c, b, &mut sight));
                let way = way.filter(in_time);
                route.way = way.unwrap_or(Way::STRAIGHT);
                route.state = if way.is_some() { State::Follows } else { shut_off };
            }
            Ok(())
        })
    }

    /// Lengths of the ways from `positions` to `targets` at the start, plane units.
    pub(super) fn lengths(&self, routes: &[Route], positions: &[Vec2], targets: &[Vec2]) -> Vec<f32> {
        let detour = self.detour(0);
        let columns = (routes.par_iter(), positions.par_iter(), targets.par_iter());
        let length = |(route, &c, &b): (&Route, &Vec2, &Vec2)| {
            detour.map_or(c.distance(b), |detour| detour.length(route.way, c, b))
        };
        columns.into_par_iter().map(length).collect()
    }

    /// Guidance of photons at `positions` in step `step`, bound for `targets`, `time_left` before t = 1.
    pub(super) fn guidance(
        &self,
        step: usize,
        time_left: f32,
        (positions, targets): (&[Vec2], &[Vec2]),
        progress: &Progress,
    ) -> Result<Vec<Vec2>> {
        let mut routes = vec![Route::NEW; positions.len()];
        self.set_out(step, positions, targets, &mut routes, progress)?;
        let detour = self.detour(step);
        let columns = (routes.par_iter(), positions.par_iter(), targets.par_iter());
        let guidance = |(route, &c, &b): (&Route, &Vec2, &Vec2)| route.guidance(detour, c, b, time_left);
        Ok(columns.into_par_iter().map(guidance).collect())
    }

    /// Mean length of the ways at the start, the measure of every speed limit.
    pub(super) fn mean_way(&self, source: &[Vec2], target: &[Vec2], progress: &Progress) -> Result<f32> {
        let mut routes = vec![Route::NEW; source.len()];
        self.set_out(0, source, target, &mut routes, progress)?;
        let sum: f64 = self.lengths(&routes, source, target).into_iter().map(f64::from).sum();
        Ok((sum / source.len().max(1) as f64) as f32)
    }

    /// Prices flow through the walls of step `step` in the fit: at points along them at half a cell's distance, at
    /// `STIFFNESS` times length where Term (3) prices all photons together at 1.
    pub(super) fn wall_in(&self, step: usize, fitter: &mut Fitter, grid: Grid) {
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
        let rows =
            WallRows { positions: &positions, normals: &normals, weight: STIFFNESS * f64::from(spacing) };
        fitter.set_walls((!positions.is_empty()).then_some(rows));
    }
}

impl Route {
    /// Straight on, nothing known yet.
    pub(super) const NEW: Self = Self { way: Way::STRAIGHT, state: State::Follows, line: false };

    /// Guidance at `c` towards `b`, `time_left` before t = 1: along the way around the walls of `detour`, fast enough to
    /// be there in time.
    pub(super) fn guidance(&self, detour: Option<&Detour>, c: Vec2, b: Vec2, time_left: f32) -> Vec2 {
        match (self.state, detour) {
            _ if time_left <= 0.0 => Vec2::ZERO,
            (State::Waits, _) => Vec2::ZERO,
            (State::Follows, Some(detour)) if !self.way.is_straight() => {
                let heading = (detour.heading(self.way, b) - c).normalize_or_zero();
                heading * (detour.length(self.way, c, b) / time_left)
            }
            _ => (b - c) / time_left,
        }
    }
}

fn epochs(walls: &[ActiveWall], steps: usize, extent: Vec2, progress: &Progress) -> Result<Vec<Epoch>> {
    let mut epochs: Vec<Epoch> = Vec::new();
    for step in 0..steps {
        let (start, end) = (step as f64 / steps as f64, (step + 1) as f64 / steps as f64);
        // A wall that stands for a part of a step stands for all of it.
        let standing: Vec<usize> =
            (0..walls.len()).filter(|&i| walls[i].window.touches(start, end)).collect();
        if epochs.last().is_some_and(|epoch| epoch.standing == standing) {
            continue;
        }
        let here: Vec<&ActiveWall> = standing.iter().map(|&i| &walls[i]).collect();
        let detour = match here.is_empty() {
            true => None,
            false => Some(Detour::new(&here, extent, progress)?),
        };
        epochs.push(Epoch { first: step, standing, detour });
    }
    Ok(epochs)
}
