//! Trajectories along fitted fields.

use std::sync::Arc;

use glam::Vec2;

use super::fields::Fields;
use super::observer::Kinematics as _;
use super::photons::GuidedPhotons;
use super::trajectories::Trajectories;
use super::walls::WallViolations;
use crate::{Progress, Result};

/// The photons of one pass carried along fields: 36 bytes a photon, whatever the number of frames.
///
/// Photons in the order of [`spatial_order`](super::spatial_order()) move faster: neighbours read the same coefficients.
pub struct FieldTrajectories<'a> {
    fields: &'a Fields,
    source: &'a [Vec2],
    targets: &'a [Vec2],
    photons: GuidedPhotons<'a>,
    /// Steps begun; the photons are in the last of them.
    begun: usize,
}

impl<'a> FieldTrajectories<'a> {
    /// Photons at `source`, each bound for the target in the same row.
    ///
    /// # Panics
    /// When the columns differ in length.
    pub fn new(fields: &'a Fields, source: &'a [Vec2], targets: &'a [Vec2]) -> Self {
        assert_eq!(source.len(), targets.len(), "each photon has one target");
        let fade = (fields.fade(), fields.reference_speed());
        let photons = GuidedPhotons::new(source, targets, fade, fields.obstacles().map(Arc::as_ref));
        Self { fields, source, targets, photons, begun: 0 }
    }

    /// Carries the photons into step `n` (clipped to the last), whose times are n/steps to (n+1)/steps; restarts if they
    /// are beyond.
    ///
    /// # Errors
    /// `Numeric` with the count when photons are no longer finite, `Cancelled`.
    pub fn advance_to(&mut self, n: usize, progress: &Progress) -> Result<()> {
        let n = n.min(self.fields.steps() - 1);
        if self.begun > n + 1 {
            *self = Self::new(self.fields, self.source, self.targets);
        }
        while self.begun <= n {
            self.photons.advance(&self.fields.step(self.begun), progress)?;
            self.begun += 1;
        }
        Ok(())
    }
}

impl Trajectories for FieldTrajectories<'_> {
    fn positions_at(&mut self, t: f64, out: &mut [Vec2], progress: &Progress) -> Result<()> {
        assert_eq!(out.len(), self.targets.len(), "one position for each photon");
        let t = t.clamp(0.0, 1.0);
        self.advance_to(self.fields.step_of(t), progress)?;
        self.photons.positions(t, out);
        Ok(())
    }

    fn wall_violations(&self) -> WallViolations {
        self.photons.wall_violations()
    }
}
