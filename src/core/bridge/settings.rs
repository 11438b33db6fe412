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
}

/// The walls that stand from a time on.
#[derive(Clone, Copy)]
pub struct WallsFrom<'a> {
    /// Time from 0 to 1.
    pub time: f64,
    /// The walls; none where none stands.
    pub barriers: Option<&'a Barriers>,
}
