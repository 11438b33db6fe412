//! Settings of one fit.

use crate::flow::field::Grid;
use crate::{Error, Result};

/// How psi and phi are put together.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Blend {
    /// One coupled fit of both, Eq. (7).
    Joint,
    /// Each fitted alone, then u = (1-gamma) u_psi + gamma u_phi: gamma acts evenly over its whole range.
    Separate,
}

/// Grid, weights and solver limits of a fit.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct FitSettings {
    /// The grid of the potentials; 4..=2048 cells along each axis.
    pub grid: Grid,
    /// Share of the irrotational part, 0..=1.
    pub gamma: f64,
    /// Weight of the bending energy, > 0. Features shorter than sqrt(alpha / density) of the plane are smoothed. Below
    /// `tolerance` (h / pi)^2, with the narrower side h of a cell, it moves no wave that the grid can hold by more than the
    /// tolerance: that much is taken at least.
    pub alpha: f64,
    /// Joint or separate.
    pub blend: Blend,
    /// Error of the velocities to stop at, over the root mean square of those wanted of the photons.
    pub tolerance: f64,
    /// Limit of iterations.
    pub max_iterations: usize,
}

impl FitSettings {
    /// The settings with the least alpha that tells, unless a value is out of range.
    ///
    /// # Errors
    /// `Value` names the setting.
    pub(super) fn checked(self) -> Result<Self> {
        self.check()?;
        let [width, height] = self.grid.cell_size();
        let least = self.tolerance * (width.min(height) / std::f64::consts::PI).powi(2);
        Ok(Self { alpha: self.alpha.max(least), ..self })
    }

    fn check(&self) -> Result<()> {
        let FitSettings { grid, gamma, alpha, tolerance, .. } = *self;
        if !grid.cells.iter().all(|cells| (4..=2048).contains(cells)) {
            return Err(Error::value(
                "flow.grid",
                format!("{:?} cells; 4 to 2048 along each axis", grid.cells),
            ));
        }
        let sides = [grid.extent.x, grid.extent.y];
        if !sides.iter().all(|side| side.is_finite() && *side > 0.0) {
            return Err(Error::value(
                "receiver",
                format!("a rectangle of {sides:?}; both sides must be > 0"),
            ));
        }
        if !(0.0..=1.0).contains(&gamma) {
            return Err(Error::value("flow.gamma", format!("{gamma} is not within 0 and 1")));
        }
        if !(alpha.is_finite() && alpha > 0.0) {
            return Err(Error::value("flow.alpha", format!("{alpha} is not a number > 0")));
        }
        if !(tolerance.is_finite() && tolerance > 0.0) {
            return Err(Error::value("flow.tolerance", format!("{tolerance} is not a number > 0")));
        }
        Ok(())
    }
}
