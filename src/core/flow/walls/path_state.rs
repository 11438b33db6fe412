//! The state of one photon on its path around walls.

use glam::Vec2;

use crate::constraint::{VisibilityGraph, WallPath};

/// The path of one photon from here on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PathState {
    pub(super) path: WallPath,
    pub(super) status: PathStatus,
    /// Whether it moves along a straight line in the current step.
    pub(super) on_line: bool,
}

/// Whether a photon can follow its path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PathStatus {
    /// Follows it.
    Following,
    /// Separated from its target by walls that change later: waits.
    Waiting,
    /// Separated from its target until the end: goes straight through the walls.
    Unreachable,
}

impl PathState {
    /// Straight on, before any search.
    pub(super) const NEW: Self =
        Self { path: WallPath::STRAIGHT, status: PathStatus::Following, on_line: false };

    /// Guidance at `c` towards `b`, `time_left` before t = 1: along the path around the walls of `graph`, at the speed that
    /// arrives in time.
    pub(super) fn guidance(&self, graph: Option<&VisibilityGraph>, c: Vec2, b: Vec2, time_left: f32) -> Vec2 {
        match (self.status, graph) {
            _ if time_left <= 0.0 => Vec2::ZERO,
            (PathStatus::Waiting, _) => Vec2::ZERO,
            (PathStatus::Following, Some(graph)) if !self.path.is_straight() => {
                let direction = (graph.next_point(self.path, b) - c).normalize_or_zero();
                direction * (graph.length(self.path, c, b) / time_left)
            }
            _ => (b - c) / time_left,
        }
    }
}
