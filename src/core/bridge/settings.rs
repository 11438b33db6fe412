//! Settings of a plan.

use glam::Vec2;

use crate::constraint::barrier::Barriers;

/// Grid, steps and weights of a plan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BridgeSettings {
    /// Size of the plane; its longer side is 1.
    pub extent: Vec2,
    /// Cells along the longer side.
    pub cells: usize,
    /// Steps of the whole time, even: the sides meet after half of them.
    pub steps: usize,
    /// Standard deviation of the random motion over the whole time, plane units: pieces of about this size stay together.
    pub hold: f32,
    /// Most density on the way, over that of the keys; acts where walls stand.
    pub density: f32,
    /// Sweeps of the scaling over the usual number; around walls the misplaced share at which they end falls alike.
    pub sweeps: f32,
}

impl BridgeSettings {
    /// Sweeps where `usual` is their usual number; at least one.
    pub(super) fn sweeps(&self, usual: usize) -> usize {
        ((self.sweeps * usual as f32).round() as usize).max(1)
    }
}

/// The walls that stand from a time on.
#[derive(Clone, Copy)]
pub struct WallsFrom<'a> {
    /// Time from 0 to 1.
    pub time: f64,
    /// The walls; none where none stands.
    pub barriers: Option<&'a Barriers>,
}
