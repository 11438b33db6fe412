//! The input of a flow: the photons and constraints of one segment.

use glam::Vec2;

use super::settings::FlowSettings;
use crate::constraint::{ActiveLine, ActiveWall};
use crate::{Error, Result};

/// One segment, from a key frame to the next: photons with their targets, settings, lines and walls.
#[derive(Clone, Copy, Debug)]
pub struct Segment<'a> {
    /// Positions of n photons at t = 0, plane units.
    pub source: &'a [Vec2],
    /// Positions of the same rows at t = 1.
    pub target: &'a [Vec2],
    /// Size of the plane; its longer side is 1.
    pub extent: Vec2,
    /// Flow settings.
    pub settings: &'a FlowSettings,
    /// Directed lines, Term (6).
    pub lines: &'a [ActiveLine],
    /// Walls.
    pub walls: &'a [ActiveWall],
    /// Number of the segment in the animation, from 0: turbulence continues from the segment before.
    pub number: usize,
}

impl<'a> Segment<'a> {
    /// The first segment of an animation, without constraints.
    pub fn new(source: &'a [Vec2], target: &'a [Vec2], extent: Vec2, settings: &'a FlowSettings) -> Self {
        Self { source, target, extent, settings, lines: &[], walls: &[], number: 0 }
    }
}

/// At most `count` rows of `all`, evenly spaced.
pub(super) fn guide_rows(all: usize, count: usize) -> Vec<usize> {
    let count = count.min(all);
    (0..count).map(|i| (i as u128 * all as u128 / count as u128) as usize).collect()
}

/// Refuses photons without target, none at all, and positions that are not finite.
pub(super) fn check_photons(source: &[Vec2], target: &[Vec2]) -> Result<()> {
    if source.is_empty() {
        return Err(Error::value(
            "flow",
            "there are no photons to move; check that light reaches the receiver",
        ));
    }
    if source.len() != target.len() {
        let what = format!("{} photons but {} targets; each photon needs one", source.len(), target.len());
        return Err(Error::value("flow", what));
    }
    match source.iter().zip(target).position(|(a, b)| !(a.is_finite() && b.is_finite())) {
        Some(row) => Err(Error::value("flow", format!("photon {row} has a position that is not finite"))),
        None => Ok(()),
    }
}
