//! Photons that slide along walls on their way to the meeting.

use glam::Vec2;

use super::fields::MeetingFields;
use crate::bridge::CellVelocities;
use crate::constraint::barrier::Barriers;
use crate::flow::step::StageVelocity;
use crate::flow::walls::{Clearance, SUBSTEPS, slide};

/// Cells of the plan from a wall within which photons have the planned velocity alone, and from which on the fitted one:
/// splines cannot jump across a wall. With 1 and 2.5 cells light that turns around a wall's end lags behind (fullest cell 4.1 times the
/// keys' on a C of walls, instead of 3.4).
const PLANNED: f32 = 3.0;
const FITTED: f32 = 6.0;
/// How much farther the cubic between two steps may stray than its photon moves in a step.
const STRAY: f32 = 1.5;

/// The walls of one step of a half.
pub(super) struct WallMotion<'a> {
    barriers: &'a Barriers,
    clearance: &'a Clearance,
    planned: &'a CellVelocities,
    /// Distance from walls beyond which a photon does not come to feel them within the step.
    far: f32,
}

impl<'a> WallMotion<'a> {
    /// The walls that stand in the step after `done` steps of a half; none where none stands.
    pub(super) fn new(fields: &'a MeetingFields, half: usize, done: usize) -> Option<Self> {
        let step = SUBSTEPS * if half == 0 { done } else { fields.steps() - 1 - done };
        let obstacles = fields.obstacles()?;
        let barriers = obstacles.graph(step)?.barriers();
        let clearance = obstacles.clearance(step)?;
        let planned = fields.planned(half, done)?;
        let far = FITTED * planned.side() + STRAY * fields.speed_bound(half, done)? / fields.steps() as f32;
        Some(Self { barriers, clearance, planned, far })
    }

    /// Whether a photon at `p` is so far from walls that it moves as without them.
    #[inline]
    pub(super) fn is_far(&self, p: Vec2) -> bool {
        self.is_far_with(p, Vec2::ZERO)
    }

    /// The same for one that makes up for `gap` besides.
    #[inline]
    pub(super) fn is_far_with(&self, p: Vec2, gap: Vec2) -> bool {
        self.clearance.at(p) > self.far + 0.5 * gap.length()
    }

    /// The position of a photon after the fraction `x` of a step of length `h` from `c`. Each substep is a straight move, or one
    /// that slides.
    pub(super) fn advance(&self, stages: &[StageVelocity; 3], h: f32, c: Vec2, x: f32) -> Vec2 {
        let part = h / SUBSTEPS as f32;
        let whole = (x * SUBSTEPS as f32) as usize;
        let at = (0..whole.min(SUBSTEPS)).fold(c, |at, i| self.substep(stages, part, at, i));
        let rest = x * SUBSTEPS as f32 - whole as f32;
        if rest <= 0.0 || whole >= SUBSTEPS {
            return at;
        }
        at.lerp(self.substep(stages, part, at, whole), rest)
    }

    /// Substep `i` of a step, by the midpoint method.
    pub(super) fn substep(
        &self,
        [begin, middle, end]: &[StageVelocity; 3],
        part: f32,
        at: Vec2,
        i: usize,
    ) -> Vec2 {
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

    /// The velocity between two stages; beside walls that of the plan. `distance` is that to the nearest wall, or less.
    fn velocity(&self, [a, b]: [&StageVelocity; 2], share: f32, p: Vec2, distance: f32) -> Vec2 {
        let cells = distance / self.planned.side();
        let near = ((FITTED - cells) / (FITTED - PLANNED)).clamp(0.0, 1.0);
        let mut velocity = Vec2::ZERO;
        if near > 0.0 {
            // All four cells around are in sight of a point two cells from walls.
            let planned = match cells > 2.0 {
                true => self.planned.at(p),
                false => self.planned.seen_from(self.barriers, p),
            };
            velocity += near * planned;
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
