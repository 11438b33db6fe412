//! The fit of both potentials under a plan, where gamma says which of them leads.
//!
//! A plan's velocity is nearly a gradient where no wall stands, so the separate blend of Eq. (1) would follow it at half
//! speed at gamma .5 and catch up late, and a liquid alone could not gather light at all. So one potential leads and takes
//! all it can of the velocity (psi below gamma 1/2, phi above), the other is fitted to what is left, and a share of it is
//! added: all at gamma 1/2, none at 0 and 1 where light sets out. The share rises to 1 until the meeting, or light would
//! not arrive: a liquid sets out as a liquid, and gathers on its way.

use glam::Vec2;

use crate::flow::fade::smoothstep;
use crate::flow::field::Field;
use crate::flow::fit::{Blend, FitReport, FitSettings, Fitter, LineTerm, Rows};
use crate::{Progress, Result};

/// Least length of smoothing, cells.
const TIGHTEST: f64 = 0.3;
/// Part of a half after which both potentials act in full.
const RISE: f64 = 0.7;

/// The fits of one half, step by step.
pub(super) struct LeadingFit {
    leading: Fitter,
    following: Fitter,
    /// Share of the following potential at the start of the half.
    share: f64,
}

impl LeadingFit {
    /// `gamma` says which potential leads; the other settings are those of each fit. A leading psi is smooth at least over
    /// `liquid`, plane units.
    ///
    /// # Errors
    /// `Value` for a setting out of range.
    pub(super) fn new(settings: FitSettings, liquid: f64) -> Result<Self> {
        let gamma = settings.gamma;
        // Tighter than a part of a cell, splines would swing between photons.
        let [width, height] = settings.grid.cell_size();
        let settings =
            FitSettings { alpha: settings.alpha.max((TIGHTEST * width.min(height)).powi(2)), ..settings };
        let alone = |gamma: f64, alpha: f64| {
            Fitter::new(FitSettings {
                gamma,
                alpha: settings.alpha.max(alpha),
                blend: Blend::Joint,
                ..settings
            })
        };
        let smooth = if gamma < 0.5 { liquid * liquid } else { 0.0 };
        let (leads, follows) = if gamma < 0.5 { (0.0, 1.0) } else { (1.0, 0.0) };
        let share = 2.0 * if gamma < 0.5 { gamma } else { 1.0 - gamma };
        Ok(Self { leading: alone(leads, smooth)?, following: alone(follows, 0.0)?, share })
    }

    /// Fits both potentials to velocities at positions; `part`, 0 to 1, is how far the half is done.
    ///
    /// # Errors
    /// As [`Fitter::fit`].
    pub(super) fn fit(
        &mut self,
        part: f64,
        (positions, velocities): (&[Vec2], &[Vec2]),
        lines: Option<LineTerm>,
        progress: &Progress,
    ) -> Result<(Field, FitReport)> {
        let (leading, report) = self.leading.fit_with(positions, velocities, lines, progress)?;
        let share = self.share + (1.0 - self.share) * smoothstep(part / RISE);
        if share == 0.0 {
            return Ok((leading, report));
        }
        let rest = |positions: &[Vec2], velocities: &[Vec2]| -> Vec<Vec2> {
            positions.iter().zip(velocities).map(|(&p, &v)| v - leading.velocity(p)).collect()
        };
        let left = rest(positions, velocities);
        let of_lines: Vec<Vec<Vec2>> = lines
            .iter()
            .flat_map(|lines| lines.rows)
            .map(|rows| rest(rows.positions, rows.velocities))
            .collect();
        let rows: Vec<Rows> = lines
            .iter()
            .flat_map(|lines| lines.rows)
            .zip(&of_lines)
            .map(|(rows, velocities)| Rows { velocities, ..*rows })
            .collect();
        let lines = lines.map(|LineTerm { mask, .. }| LineTerm { rows: &rows, mask });
        let (following, other) = self.following.fit_with(positions, &left, lines, progress)?;
        let mut field = leading.clone();
        Field::blend(&leading, 1.0, &following, share as f32, &mut field);
        Ok((field, report.worst(other)))
    }
}
