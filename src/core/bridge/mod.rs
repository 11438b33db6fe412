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
//! at most 1 keep the light of each cell below a cap, so that light spreads into lanes before it comes to the end of a wall.
//! Others let less light stay the nearer a wall is: it fades towards walls and rounds their ends, where an edge would cut it.
//! Regions that walls shut off have plans of their own.
//!
//! Where walls leave most straight ways open, the plan is renewed as in free motion, and bodies keep their size; close to walls
//! light also spreads by half the diffusion, or it would gather there in threads. Where they block a third of the ways, or come and
//! go, a plan is made once (in between both are mixed):
//! with f from the one side and b from the other, s^2/2 grad ln(b / f) is the velocity that carries exactly the planned density,
//! which is below the cap everywhere (Chen, Georgiou, Pavon 2016). It puffs bodies up on the way, with a rim around them. What the
//! photons and the fit make of the velocity drifts away from the plan, so light diffuses down the gradient of its density over
//! the planned one.
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
//!
//! With walls, fitted, by `lightloom figures`; the plan made once and renewed:
//!
//! | | cracks | torn | fastest | gap |
//! |---|---|---|---|---|
//! | *letters*: once | .003 | .003 .004 .001 | 5.2 | .0056 |
//! | **renewed** | .009 | .001 .003 .000 | 4.7 | .0035 |
//! | *bottles*: once | .000 | .038 .059 .000 | 4.0 | .0074 |
//! | **renewed** | .000 | .038 .045 .000 | 4.1 | .0067 |
//! | a slit: **once** | .032 | .017 .017 .000 | 1.5 | .0059 |
//! | renewed | .090 | .005 .005 .000 | 1.7 | .0061 |
//! | a slalom: **once** | .022 | .209 .199 .008 | 2.5 | .0363 |
//! | renewed | .183 | .415 .340 .027 | 2.6 | .0218 |

mod cells;
mod ends;
mod free_plan;
mod gaussian;
mod gradient;
mod regions;
mod relative_density;
mod renewal;
mod self_transport;
mod settings;
mod sight;
mod step_kernel;
mod velocities;
mod wall_cells;
mod wall_kernel;
mod wall_plan;

use glam::Vec2;
use rayon::prelude::*;

pub use self::cells::Cells;
use self::cells::weighted;
use self::free_plan::FreePlan;
pub use self::settings::{BridgeSettings, WallsFrom};
pub use self::sight::Sight;
pub use self::velocities::CellVelocities;
use self::wall_cells::StandingWalls;
use self::wall_plan::WallPlan;
use crate::{Progress, Result};

/// Fastest photon over the mean speed at the start.
const SPEED_LIMIT: f32 = 3.9;

/// The plan between the photons of two key frames, followed while they move towards each other.
pub struct Bridge<'a> {
    cells: Cells,
    walls: StandingWalls<'a>,
    plan: Plan,
    /// Velocities of the earlier light forward in time, and of the later one backward, in cells.
    velocities: [Vec<Vec2>; 2],
    /// Fastest speed, plane units per unit of time; known once the plan is made.
    limit: f32,
    /// Steps that both sides have done.
    done: usize,
}

enum Plan {
    Free(Box<FreePlan>),
    Walls(Box<WallPlan>),
}

impl<'a> Bridge<'a> {
    /// A plan between photons at two key frames, not yet made. `walls` are those of the time from the earlier one to the
    /// later one in order; empty where none stands at any time.
    pub fn new(settings: BridgeSettings, walls: &[WallsFrom<'a>]) -> Self {
        let cells = Cells::new(settings.extent, settings.cells);
        let walls = StandingWalls::new(&cells, settings.steps, walls);
        let plan = match walls.any() {
            true => Plan::Walls(Box::new(WallPlan::new(settings))),
            false => Plan::Free(Box::new(FreePlan::new(settings, &cells))),
        };
        let still = || vec![Vec2::ZERO; cells.count()];
        Self { walls, plan, velocities: [still(), still()], limit: f32::INFINITY, done: 0, cells }
    }

    /// Makes the plan, or renews it, after `done` steps of both sides; `photons` are where those of the earlier and of the
    /// later key frame are then, in the order of their rows. The first call is with `done` 0.
    ///
    /// # Errors
    /// `Cancelled`.
    pub fn renew(&mut self, done: usize, photons: [&[Vec2]; 2], progress: &Progress) -> Result<()> {
        self.done = done;
        self.velocities = match &mut self.plan {
            Plan::Free(plan) => plan.velocities(&self.cells, done, photons, progress)?,
            Plan::Walls(plan) => plan.velocities((&self.cells, &self.walls), done, photons, progress)?,
        };
        if done == 0 {
            self.limit = SPEED_LIMIT * self.mean_speed_of(photons);
        }
        Ok(())
    }

    fn mean_speed_of(&self, photons: [&[Vec2]; 2]) -> f32 {
        let sum_of = |side: usize| {
            let speeds =
                photons[side].par_iter().with_min_len(4096).map(|&p| self.velocity(side, p).length());
            speeds.collect::<Vec<_>>().into_iter().map(f64::from).sum::<f64>()
        };
        let count = photons.iter().map(|photons| photons.len()).sum::<usize>().max(1);
        ((sum_of(0) + sum_of(1)) / count as f64) as f32
    }

    /// The velocity at `p` of the light of `side` (0: the earlier key frame's, forward in time; 1: the later one's, backward),
    /// plane units per unit of time.
    #[inline]
    pub fn velocity(&self, side: usize, p: Vec2) -> Vec2 {
        let around = match self.walls.of(side, self.done) {
            None => self.cells.around(p),
            Some(walls) => walls.around(p),
        };
        limited(weighted(&self.velocities[side], around), self.limit)
    }

    /// The velocities of `side` in all cells, see [`Self::velocity`], times `sign`.
    pub fn velocities(&self, side: usize, sign: f32) -> CellVelocities {
        let limited = self.velocities[side].iter().map(|&v| sign * limited(v, self.limit));
        CellVelocities::new(self.cells.clone(), limited.collect())
    }

    /// The mean speed of all photons at the start, plane units per unit of time; 0 before the plan is made.
    pub fn mean_speed(&self) -> f32 {
        if self.limit.is_finite() { self.limit / SPEED_LIMIT } else { 0.0 }
    }

    /// Share of the light of the earlier and of the later key frame that walls shut off from the other.
    pub fn shut_off(&self) -> [f64; 2] {
        match &self.plan {
            Plan::Free(_) => [0.0; 2],
            Plan::Walls(plan) => plan.shut_off(),
        }
    }

    /// The misplaced share of the light after the last sweep, 0 to 1.
    pub fn error(&self) -> f64 {
        match &self.plan {
            Plan::Free(plan) => plan.error(),
            Plan::Walls(plan) => plan.error(),
        }
    }
}

/// `velocity`, not faster than `limit`.
fn limited(velocity: Vec2, limit: f32) -> Vec2 {
    let speed = velocity.length();
    if speed > limit { velocity * (limit / speed) } else { velocity }
}
