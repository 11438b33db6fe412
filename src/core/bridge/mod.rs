//! The plan of a motion: where the whole body of light goes, and when.
//!
//! # The problem
//!
//! The photons at two key frames are two densities. The *Schroedinger bridge* between them (Leonard 2014) is the likeliest
//! motion of a cloud of diffusing particles that begins as the one and ends as the other: with the heat kernel K of
//! variance s^2 over the time left there are factors a, b with
//!
//! ```text
//! a (K b) = A      b (K a) = B
//! ```
//!
//! found by scaling in turn (Sinkhorn; Benamou et al. 2015). s^2 grad ln(K b) is the velocity of the earlier light
//! towards the later one, s^2 grad ln(K a) that of the later towards the earlier. Both are smooth at the length s: pieces
//! of about that size stay together, and no photon is steered by itself.
//!
//! # Meeting half way
//!
//! A [`Bridge`] carries *both* keys towards each other: the earlier forward, the later backward, and is renewed at every
//! step from where both are, with the variance that the time left has. So it aims coarse first and fine at last, makes up
//! for what a fit has smoothed away, and treats both keys alike: the film backwards is the film of the exchanged keys. At
//! t = 1/2 the two bodies are the same to a fraction of a cell.
//!
//! Diffusion would also shrink each body towards its middle or puff it up, even where both keys are the same. The transport
//! of a density onto itself has the same bias, c (K c) = A, and is taken away: the velocity is s^2 grad ln(K b / K c), as
//! in Sinkhorn divergences (Feydy et al. 2019). Two keys that are the same then rest.
//!
//! Where a body must tear, the crack is filled from its sides: each photon remembers how dense it was around it at its key
//! frame, and light diffuses down the gradient of the density relative to that. A body that moves as it was feels nothing.
//!
//! # Walls
//!
//! K is a product of short steps that see no cell through a wall; rows of sum 1 make walls reflect. In between, factors of
//! at most 1 keep the light of each cell below a cap (Maury et al. 2010), so that light spreads into lanes before it comes
//! to the end of a wall. Regions that walls shut off have plans of their own.
//!
//! # Measured
//!
//! 100 000 photons, without a fit, figures of 20 000 of them; cells along the plane, hold, diffusion; largest share of
//! light in cracks beyond those of the keys, neighbourhoods torn (source and target at t = .5, target at .75), fastest
//! 99.9 % over the mean straight way (straight lines: 3.7, 3.3), root mean square gap at the meeting:
//!
//! | | cracks | torn | fastest | gap |
//! |---|---|---|---|---|
//! | glass to flower: 96, .05, 0 | .061 | .023 .026 .000 | 4.5 | .0102 |
//! | 96, .05, .5 | .053 | .027 .034 .000 | 4.2 | .0096 |
//! | 128, .05, .5 | .020 | .016 .029 .000 | 4.1 | .0079 |
//! | **192, .05, .5** | .000 | .006 .048 .000 | 3.8 | .0057 |
//! | letter C to S: 96, .05, 0 | .011 | .021 .008 .004 | 4.6 | .0032 |
//! | 96, .04, 0, with the bias | .026 | .049 .013 .009 | 5.7 | .0054 |
//! | **192, .05, .5** | .006 | .000 .007 .001 | 3.9 | .0019 |

mod cells;
mod gaussian;
mod kernel;
mod regions;
mod settings;
mod side;
mod velocities;
mod wall_cells;
mod wall_kernel;

use glam::Vec2;
use rayon::prelude::*;

pub use self::cells::Cells;
use self::kernel::Kernel;
use self::regions::Regions;
pub use self::settings::{BridgeSettings, WallsFrom};
use self::side::{LEAST, Side};
pub use self::velocities::CellVelocities;
use self::wall_cells::WallCells;
use self::wall_kernel::{StepKernel, WallKernel};
use crate::{Progress, Result};

/// Sweeps of the factors in each renewal, and in the first one, which starts from a plan on half as many cells.
const SWEEPS: usize = 8;
const FIRST_SWEEPS: usize = 16;
/// Sweeps of the coarsest plan, which starts from nothing, and its cells at most.
const COLD_SWEEPS: usize = 80;
const COARSEST: usize = 48;
/// Least variance in squared cells: a narrower kernel is none on the grid.
const LEAST_VARIANCE: f64 = 0.36;
/// Diffusion down the relative density, over that of the bridge.
const DIFFUSION: f64 = 0.5;
/// Fastest photon over the mean speed at the start.
const SPEED_LIMIT: f32 = 3.9;

/// The plan between the photons of two key frames, renewed while they move towards each other.
pub struct Bridge<'a> {
    settings: BridgeSettings,
    cells: Cells,
    kernel: Kernel,
    walls: Vec<(usize, Option<WallCells<'a>>)>,
    regions: Option<Regions>,
    sides: [Side; 2],
    /// Fastest speed, plane units per unit of time; known once the first plan is made.
    limit: f32,
    /// The window of the plan: all steps but the first and the last so many. None before the first.
    window: Option<usize>,
}

impl<'a> Bridge<'a> {
    /// A plan between photons at two key frames, not yet made. `walls` are those of the time from the earlier one to the
    /// later one in order; empty where none stands at any time.
    pub fn new(settings: BridgeSettings, walls: &[WallsFrom<'a>], photons: [&[Vec2]; 2]) -> Self {
        let cells = Cells::new(settings.extent, settings.cells);
        let first_step = |time: f64| (time * settings.steps as f64).round() as usize;
        let walls: Vec<_> = walls
            .iter()
            .map(|from| (first_step(from.time), from.barriers.map(|b| WallCells::new(&cells, b))))
            .collect();
        let mut sides = [Side::new(cells.count()), Side::new(cells.count())];
        let last = walls.last().and_then(|(_, walls)| walls.as_ref());
        let first = walls.first().and_then(|(_, walls)| walls.as_ref());
        for ((side, photons), walls) in sides.iter_mut().zip(photons).zip([first, last]) {
            side.gather(&cells, walls, photons);
        }
        let standing = walls.iter().any(|(_, walls)| walls.is_some());
        let variance = squared_cells(&settings, &cells, 1.0);
        let (kernel, regions) = if standing {
            let regions = Regions::new(&cells, &walls, [&sides[0].density, &sides[1].density]);
            let step = (variance / settings.steps as f64).max(LEAST_VARIANCE);
            let kernels =
                walls.iter().map(|(_, walls)| StepKernel::new(&cells, walls.as_ref(), step)).collect();
            let index = |step: usize| walls.partition_point(|(from, _)| *from <= step).saturating_sub(1);
            let of_step = (0..settings.steps).map(index).collect();
            let cap = cap(&settings, &sides);
            (Kernel::walls(WallKernel::new(kernels, of_step, cap), step), Some(regions))
        } else {
            (Kernel::free(cells.size, variance), None)
        };
        Self { settings, cells, kernel, walls, regions, sides, limit: f32::INFINITY, window: None }
    }

    /// Makes the plan anew after `done` steps of both sides; `photons` are where those of the earlier and of the later key
    /// frame are then, in the order of their rows.
    ///
    /// # Errors
    /// `Cancelled`.
    pub fn renew(&mut self, done: usize, photons: [&[Vec2]; 2], progress: &Progress) -> Result<()> {
        let steps = self.settings.steps as f64;
        let left = 1.0 - 2.0 * done as f64 / steps;
        let variance = squared_cells(&self.settings, &self.cells, left).max(LEAST_VARIANCE);
        self.kernel.set_window(done, variance);
        for (side, photons) in photons.into_iter().enumerate() {
            let walls = walls_at(&self.walls, self.settings.steps, side, done);
            self.sides[side].gather(&self.cells, walls, photons);
        }
        if let Some(regions) = &self.regions {
            let [a, b] = &mut self.sides;
            regions.balance(&a.density, &mut b.density);
        }
        let first = self.window.replace(done).is_none();
        if first {
            self.start(photons, progress)?;
        }
        for _ in 0..if first { FIRST_SWEEPS } else { SWEEPS } {
            progress.check()?;
            self.sweep();
        }
        let [a, b] = &mut self.sides;
        self.kernel.spread(1, &b.scale, &mut a.reached);
        self.find_velocities(done, left, variance, photons);
        if first {
            let speeds = |side: usize| photons[side].par_iter().map(move |&p| (side, p));
            let all = speeds(0).chain(speeds(1));
            let sum: f64 = all
                .map(|(side, p)| f64::from(self.velocity(side, p).length()))
                .collect::<Vec<_>>()
                .iter()
                .sum();
            let count = photons.iter().map(|photons| photons.len()).sum::<usize>().max(1);
            self.limit = SPEED_LIMIT * (sum / count as f64) as f32;
        }
        Ok(())
    }

    /// Scales both ends once.
    fn sweep(&mut self) {
        let [a, b] = &mut self.sides;
        self.kernel.spread(1, &b.scale, &mut a.reached);
        a.rescale();
        self.kernel.spread(0, &a.scale, &mut b.reached);
        b.rescale();
    }

    /// The first factors: those of a plan on half as many cells.
    fn start(&mut self, photons: [&[Vec2]; 2], progress: &Progress) -> Result<()> {
        if self.settings.cells <= COARSEST {
            self.sides[1].scale =
                self.sides[1].density.iter().map(|d| f64::from(u8::from(*d > 0.0))).collect();
            for _ in 0..COLD_SWEEPS {
                progress.check()?;
                self.sweep();
            }
            return Ok(());
        }
        let settings = BridgeSettings { cells: self.settings.cells / 2, ..self.settings };
        let barriers: Vec<WallsFrom> = self
            .walls
            .iter()
            .map(|(step, walls)| WallsFrom {
                time: *step as f64 / self.settings.steps as f64,
                barriers: walls.as_ref().map(WallCells::barriers),
            })
            .collect();
        let mut coarse = Bridge::new(settings, &barriers, photons);
        coarse.window = Some(0);
        if let Some(regions) = &coarse.regions {
            let [a, b] = &mut coarse.sides;
            regions.balance(&a.density, &mut b.density);
        }
        coarse.start(photons, progress)?;
        for _ in 0..FIRST_SWEEPS {
            progress.check()?;
            coarse.sweep();
        }
        let later = &coarse.sides[1];
        let logarithms: Vec<f64> = later.reached.iter().map(|reached| reached.max(LEAST).ln()).collect();
        let cells = &self.cells;
        let side = &mut self.sides[1];
        let reached = |cell: usize| coarse.cells.value(&logarithms, cells.centre(cell)).exp();
        side.reached = (0..cells.count()).into_par_iter().map(reached).collect();
        side.rescale();
        Ok(())
    }

    fn find_velocities(&mut self, done: usize, left: f64, variance: f64, photons: [&[Vec2]; 2]) {
        let Self { settings, cells, kernel, walls, sides, .. } = self;
        let square = f64::from(cells.side) * f64::from(cells.side);
        let drift = variance * square / left;
        let diffusion = 0.5 * DIFFUSION * f64::from(settings.hold).powi(2);
        for (side, (end, photons)) in sides.iter_mut().zip(photons).enumerate() {
            let walls = walls_at(walls, settings.steps, side, done);
            end.transport_onto_itself(side, kernel);
            let relative = end.relative_density(side, cells, (walls, kernel), photons);
            end.find_velocities(cells, walls, drift, (diffusion, &relative));
        }
    }

    /// The velocity at `p` of the light of `side` (0: the earlier key frame's, forward in time; 1: the later one's, backward),
    /// plane units per unit of time.
    #[inline]
    pub fn velocity(&self, side: usize, p: Vec2) -> Vec2 {
        let velocities = &self.sides[side].velocity;
        let done = self.window.unwrap_or(0);
        let around = match walls_at(&self.walls, self.settings.steps, side, done) {
            None => self.cells.around(p),
            Some(walls) => walls.around(p),
        };
        let velocity: Vec2 = around.iter().map(|&(cell, weight)| velocities[cell] * weight).sum();
        limited(velocity, self.limit)
    }

    /// The velocities of `side` in all cells, see [`Self::velocity`], times `sign`.
    pub fn velocities(&self, side: usize, sign: f32) -> CellVelocities {
        let limited = self.sides[side].velocity.iter().map(|&v| sign * limited(v, self.limit));
        CellVelocities::new(self.cells.clone(), limited.collect())
    }

    /// The mean speed of all photons at the start, plane units per unit of time; 0 before the first plan.
    pub fn mean_speed(&self) -> f32 {
        if self.limit.is_finite() { self.limit / SPEED_LIMIT } else { 0.0 }
    }

    /// Share of the light of the earlier and of the later key frame that walls shut off from the other.
    pub fn shut_off(&self) -> [f64; 2] {
        self.regions.as_ref().map_or([0.0; 2], Regions::shut_off)
    }

    /// The misplaced share of the light after the last sweep, 0 to 1.
    pub fn error(&self) -> f64 {
        let [a, _] = &self.sides;
        let columns = a.scale.iter().zip(&a.reached).zip(&a.density);
        0.5 * columns.map(|((scale, reached), density)| (scale * reached - density).abs()).sum::<f64>()
    }
}

/// `velocity`, not faster than `limit`.
fn limited(velocity: Vec2, limit: f32) -> Vec2 {
    let speed = velocity.length();
    if speed > limit { velocity * (limit / speed) } else { velocity }
}

/// The variance of the motion over the share `left` of the time, squared cells.
fn squared_cells(settings: &BridgeSettings, cells: &Cells, left: f64) -> f64 {
    f64::from(settings.hold / cells.side).powi(2) * left
}

/// The walls that stand where `side` is after `done` steps of both.
fn walls_at<'b, 'a>(
    walls: &'b [(usize, Option<WallCells<'a>>)],
    steps: usize,
    side: usize,
    done: usize,
) -> Option<&'b WallCells<'a>> {
    let step = if side == 0 { done } else { steps - 1 - done };
    let index = walls.partition_point(|(from, _)| *from <= step).checked_sub(1)?;
    walls[index].1.as_ref()
}

/// Share of the light whose cells set the cap; brighter ones keep their own density.
const CAP_SHARE: f64 = 0.9;

/// Most light of each cell: `density` times that of the cells in which most of the light is, and in each at least its own.
fn cap(settings: &BridgeSettings, sides: &[Side; 2]) -> Vec<f64> {
    let typical = |density: &[f64]| {
        let mut sorted: Vec<f64> = density.iter().copied().filter(|d| *d > 0.0).collect();
        sorted.sort_unstable_by(f64::total_cmp);
        let mut sum = 0.0;
        let within = |d: &&f64| {
            sum += **d;
            sum <= CAP_SHARE
        };
        sorted.iter().take_while(within).last().copied().unwrap_or(1.0)
    };
    let [a, b] = sides.each_ref().map(|side| &side.density);
    let most = typical(a).max(typical(b));
    a.iter().zip(b).map(|(a, b)| f64::from(settings.density) * a.max(*b).max(most)).collect()
}
