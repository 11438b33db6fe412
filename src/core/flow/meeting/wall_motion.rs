//! Photons that slide along walls on their way to the meeting.

use glam::Vec2;

use super::fields::MeetingFields;
use crate::bridge::CellVelocities;
use crate::constraint::barrier::Barriers;
use crate::flow::step::StageVelocity;
use crate::flow::walls::{SUBSTEPS, slide};

/// Cells of the plan from a wall within which photons have the planned velocity alone, and from which on the fitted one:
/// splines cannot jump across a wall.
const PLANNED: f32 = 1.0;
const FITTED: f32 = 2.5;

/// The walls of one step of a half.
pub(super) struct WallMotion<'a> {
    barriers: &'a Barriers,
    planned: &'a CellVelocities,
}

impl<'a> WallMotion<'a> {
    /// The walls that stand in the step after `done` steps of a half; none where none stands.
    pub(super) fn new(fields: &'a MeetingFields, half: usize, done: usize) -> Option<Self> {
        let step = if half == 0 { done } else { fields.steps() - 1 - done };
        let barriers = fields.obstacles()?.graph(step * SUBSTEPS)?.barriers();
        Some(Self { barriers, planned: fields.planned(half, done)? })
    }

    /// The position of a photon after a step of length `h` from `c`. The chord of the step meets no wall: where the way
    /// turns around the end of a wall, the photon waits at the last point that it sees from `c`.
    pub(super) fn advance(&self, [begin, middle, end]: &[StageVelocity; 3], h: f32, c: Vec2) -> Vec2 {
        let part = h / SUBSTEPS as f32;
        let (mut at, mut seen) = (c, c);
        for i in 0..SUBSTEPS {
            let x = (i as f32 + 0.5) / SUBSTEPS as f32;
            let (a, b, share) = if x < 0.5 { (begin, middle, 2.0 * x) } else { (middle, end, 2.0 * x - 1.0) };
            let velocity = |p: Vec2| self.velocity([a, b], share, p);
            let half = slide(self.barriers, at, 0.5 * part * velocity(at));
            at = slide(self.barriers, at, part * velocity(half));
            if !self.barriers.blocks(c, at) {
                seen = at;
            }
        }
        seen
    }

    /// The velocity between two stages; beside walls that of the plan.
    fn velocity(&self, [a, b]: [&StageVelocity; 2], share: f32, p: Vec2) -> Vec2 {
        let side = self.planned.side();
        let near = self.barriers.may_touch(p, p, FITTED * side);
        let fitted = |near: f32| {
            let fitted = (1.0 - share) * a.velocity(p) + share * b.velocity(p);
            (1.0 - near) * fitted
        };
        if !near {
            return fitted(0.0);
        }
        let distance = self.barriers.distance(p) / side;
        let near = ((FITTED - distance) / (FITTED - PLANNED)).clamp(0.0, 1.0);
        if near == 0.0 {
            return fitted(0.0);
        }
        let planned = near * self.planned.seen_from(self.barriers, p);
        if near < 1.0 { planned + fitted(near) } else { planned }
    }
}
