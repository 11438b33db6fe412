//! The interface of moving photons, whatever the method.

use glam::Vec2;

use super::walls::WallViolations;
use crate::{Progress, Result};

/// The trajectories of the photons of one pass through one segment.
pub trait Trajectories: Send {
    /// Positions at time `t`, clipped to 0..=1, in the order of the source rows. Ascending times cost one pass through the
    /// segment in all; at t = 1 each photon is at its target.
    ///
    /// # Errors
    /// `Numeric` with the count when photons are no longer finite, `Cancelled`.
    ///
    /// # Panics
    /// When `out` has not one position for each photon.
    fn positions_at(&mut self, t: f64, out: &mut [Vec2], progress: &Progress) -> Result<()>;

    /// Where the photons carry their light at time `t`: at their positions, diffused where the method does so, by the returned
    /// standard deviation in the mean. Otherwise as [`Self::positions_at`].
    ///
    /// # Errors
    /// As [`Self::positions_at`].
    ///
    /// # Panics
    /// As [`Self::positions_at`].
    fn light_at(&mut self, t: f64, out: &mut [Vec2], progress: &Progress) -> Result<f32> {
        self.positions_at(t, out, progress)?;
        Ok(0.0)
    }

    /// Unreachable targets and wall crossings so far.
    fn wall_violations(&self) -> WallViolations {
        WallViolations::default()
    }
}
