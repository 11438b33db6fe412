//! Photons that slide along walls on their way to the meeting.

use glam::Vec2;

use super::fields::MeetingFields;
use super::runge_kutta::runge_kutta;
use crate::bridge::{CellVelocities, Sight};
use crate::constraint::barrier::Barriers;
use crate::flow::field::Field;
use crate::flow::step::StageVelocity;
use crate::flow::walls::{Clearance, SUBSTEPS, slide};

/// Distances from a wall, plane units, within which photons have the planned velocity, and from which on the fitted one: splines
/// cannot jump across a wall, and are slower along it than the plan, so that light files along walls faster than what is
/// a little farther away. With .023 and .047 it grows teeth there (gap at the meeting .018 in place of .009 on *bottles*), with
/// a third of these it piles up behind a wall's end besides.
const PLANNED: f32 = 0.08;
const FITTED: f32 = 0.16;
/// Cells of the plan within which none of what directed lines and turbulence add is felt, and from which on all. The planned
/// velocity alone is felt at least as far.
const CALM: f32 = 3.0;
const MOVED: f32 = 6.0;

/// The walls of one step of a half.
pub(super) struct WallMotion<'a> {
    barriers: &'a Barriers,
    clearance: &'a Clearance,
    sight: &'a Sight,
    planned: &'a CellVelocities,
    /// What directed lines change about the fitted velocity; none where none acts.
    lines: Option<&'a Field>,
}

impl<'a> WallMotion<'a> {
    /// The walls that stand in the step after `done` steps of a half; none where none stands.
    pub(super) fn new(fields: &'a MeetingFields, half: usize, done: usize) -> Option<Self> {
        let step = SUBSTEPS * if half == 0 { done } else { fields.steps() - 1 - done };
        let obstacles = fields.obstacles()?;
        let barriers = obstacles.graph(step)?.barriers();
        let clearance = obstacles.clearance(step)?;
        let planned = fields.planned(half, done)?;
        let sight = obstacles.sight(step, planned.cells())?;
        Some(Self { barriers, clearance, sight, planned, lines: fields.lines(half, done) })
    }

    /// Whether no wall is within `reach` of `p`.
    #[inline]
    pub(super) fn is_clear(&self, p: Vec2, reach: f32) -> bool {
        self.clearance.at_least(p) > reach
    }

    /// Photons at `c` after one Runge-Kutta step of length `h`, and which of them may meet a wall on it.
    #[inline(always)]
    pub(super) fn step<const N: usize>(
        &self,
        stages: &[StageVelocity; 3],
        h: f32,
        c: [Vec2; N],
    ) -> ([Vec2; N], [bool; N]) {
        let free = c.map(|p| self.clearance.at_least(p));
        // Known well enough at the begin: both velocities are nearly the same. Next to a wall photons walk, wherever the step
        // leads.
        let distance = c.map(|p| self.clearance.at(p));
        let near: [f32; N] =
            std::array::from_fn(|i| if free[i] > 0.0 { self.near(distance[i]) } else { 0.0 });
        let (end, reach) = runge_kutta(h, c, |stage, p| {
            let mut velocities = stages[stage].velocities(p);
            for i in 0..N {
                if near[i] > 0.0 {
                    velocities[i] = velocities[i].lerp(self.planned(p[i]), near[i])
                        + self.added(&stages[stage], p[i], (near[i], distance[i]));
                }
            }
            velocities
        });
        let is_clear = |i: usize| free[i] > reach[i];
        (end, std::array::from_fn(|i| !is_clear(i)))
    }

    /// A photon at `c` after each substep of a step of length `h`: each is a straight move, or one that slides.
    pub(super) fn walk(&self, stages: &[StageVelocity; 3], h: f32, c: Vec2) -> [Vec2; SUBSTEPS] {
        let mut at = c;
        std::array::from_fn(|i| {
            at = self.substep(stages, h, at, i);
            at
        })
    }

    /// Substep `i` of a step of length `h`, by the midpoint method.
    fn substep(&self, [begin, middle, end]: &[StageVelocity; 3], h: f32, at: Vec2, i: usize) -> Vec2 {
        let part = h / SUBSTEPS as f32;
        let x = (i as f32 + 0.5) / SUBSTEPS as f32;
        let (a, b, share) = if x < 0.5 { (begin, middle, 2.0 * x) } else { (middle, end, 2.0 * x - 1.0) };
        let distance = self.clearance.at(at);
        let first = 0.5 * part * self.velocity([a, b], share, at, distance);
        let half = self.slid(at, first, distance);
        let second = part * self.velocity([a, b], share, half, distance - first.length());
        let end = self.slid(at, second, distance);
        // A slide that turns must not cut the corner.
        if self.may_meet(second, distance) && self.barriers.blocks(at, end) { at } else { end }
    }

    /// Whether a move may meet a wall at least `distance` away, which is known to a fraction of a cell.
    fn may_meet(&self, by: Vec2, distance: f32) -> bool {
        by.length() + self.planned.side() > distance
    }

    /// `p` moved by `by`, sliding along walls; `distance` is that to the nearest.
    fn slid(&self, p: Vec2, by: Vec2, distance: f32) -> Vec2 {
        if self.may_meet(by, distance) { slide(self.barriers, p, by) } else { p + by }
    }

    /// The planned velocity, as `p` sees it past the walls.
    #[inline(always)]
    fn planned(&self, p: Vec2) -> Vec2 {
        self.planned.seen_from((self.barriers, self.sight), p)
    }

    /// The share of the planned velocity at a distance from the nearest wall.
    #[inline(always)]
    fn near(&self, distance: f32) -> f32 {
        let side = self.planned.side();
        ramp(distance, [PLANNED.max(CALM * side), FITTED.max(MOVED * side)])
    }

    /// What directed lines and turbulence add to the planned velocity: little next to walls, which splines know nothing of.
    #[inline(always)]
    fn added(&self, stage: &StageVelocity, p: Vec2, (near, distance): (f32, f32)) -> Vec2 {
        let side = self.planned.side();
        let without = ramp(distance, [CALM * side, MOVED * side]);
        if near <= without || (self.lines.is_none() && stage.noise.is_empty()) {
            return Vec2::ZERO;
        }
        let lines = self.lines.iter().copied();
        let all: Vec2 = lines.chain(&stage.noise).map(|field| field.velocity(p)).sum();
        (near - without) * all
    }

    /// The velocity between two stages; beside walls that of the plan. `distance` is that to the nearest wall, or less.
    fn velocity(&self, [a, b]: [&StageVelocity; 2], share: f32, p: Vec2, distance: f32) -> Vec2 {
        let near = self.near(distance);
        let mut velocity = Vec2::ZERO;
        if near > 0.0 {
            velocity += near * self.planned(p) + self.added(a, p, (near, distance));
        }
        if near < 1.0 {
            let between = if share == 0.0 {
                a.velocity(p)
            } else {
                (1.0 - share) * a.velocity(p) + share * b.velocity(p)
            };
            velocity += (1.0 - near) * between;
        }
        velocity
    }

    /// Whether a wall stands between two points.
    pub(super) fn blocks(&self, a: Vec2, b: Vec2) -> bool {
        self.barriers.blocks(a, b)
    }
}

/// 1 up to the first distance, 0 from the second on.
#[inline(always)]
fn ramp(distance: f32, [whole, none]: [f32; 2]) -> f32 {
    ((none - distance) / (none - whole)).clamp(0.0, 1.0)
}
