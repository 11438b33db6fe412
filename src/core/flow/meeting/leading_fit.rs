//! The fit of both potentials under a plan, where gamma says which of them leads.
//!
//! A plan's velocity is nearly a gradient where no wall stands, so the separate blend of Eq. (1) would follow it at half
//! speed at gamma .5 and catch up late, and a liquid alone could not gather light at all. So one potential leads and takes
//! all it can of the velocity (psi below gamma 1/2, phi above), the other is fitted to what is left, and a share of it is
//! added: all at gamma 1/2, none at 0 and 1 where light sets out. The share rises to 1 until the meeting, or light would
//! not arrive: a liquid sets out as a liquid, and gathers on its way. What directed lines change is a smooth fit on top.

use glam::Vec2;
use rayon::prelude::*;

use crate::flow::field::Field;
use crate::flow::fit::{Blend, FitReport, FitSettings, Fitter, LineTerm, Rows};
use crate::math::smoothstep::smoothstep;
use crate::{Progress, Result};

/// Least length of smoothing, cells.
const TIGHTEST: f64 = 0.3;
/// Smoothing of what lines change, by their width. The plan is followed so tightly that a line fitted with it would cut the
/// light along its border.
const LINE_SMOOTHING: f64 = 1.0;
/// Part of a half after which both potentials act in full.
const RISE: f64 = 0.7;

/// The fits of one half, step by step.
pub(super) struct LeadingFit {
    leading: Fitter,
    following: Fitter,
    /// The fit of what directed lines change; none where there are none.
    lines: Option<Fitter>,
    /// Share of the following potential at the start of the half.
    share: f64,
}

impl LeadingFit {
    /// `gamma` says which potential leads; the other settings are those of each fit. A leading psi is smooth at least over
    /// `liquid`, plane units; what lines of the least width `line_width` change, over a part of that.
    ///
    /// # Errors
    /// `Value` for a setting out of range.
    pub(super) fn new(settings: FitSettings, liquid: f64, line_width: Option<f32>) -> Result<Self> {
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
        let of_lines = |width: f32| {
            let alpha = settings.alpha.max((LINE_SMOOTHING * f64::from(width)).powi(2));
            Fitter::new(FitSettings { alpha, ..settings })
        };
        let lines = line_width.map(of_lines).transpose()?;
        Ok(Self { leading: alone(leads, smooth)?, following: alone(follows, 0.0)?, lines, share })
    }

    /// Fits both potentials to velocities at positions; `part`, 0 to 1, is how far the half is done. Returns the field, with what
    /// the lines change about it.
    ///
    /// # Errors
    /// As [`Fitter::fit`].
    pub(super) fn fit(
        &mut self,
        part: f64,
        (positions, velocities): (&[Vec2], &[Vec2]),
        lines: Option<LineTerm>,
        progress: &Progress,
    ) -> Result<(Field, Option<Field>, FitReport)> {
        let (leading, report) = self.leading.fit(positions, velocities, progress)?;
        let share = self.share + (1.0 - self.share) * smoothstep(part / RISE);
        let (mut field, mut report) = (leading, report);
        if share > 0.0 {
            let left = left(&field, positions, velocities);
            let (following, other) = self.following.fit(positions, &left, progress)?;
            add(&mut field, &following, share as f32);
            report = report.worst(other);
        }
        if let (Some(lines), Some(fitter)) = (lines, &mut self.lines) {
            let asked: Vec<_> =
                lines.rows.iter().map(|rows| left(&field, rows.positions, rows.velocities)).collect();
            let rows = lines.rows.iter().zip(&asked).map(|(rows, velocities)| Rows { velocities, ..*rows });
            let term = LineTerm { rows: &rows.collect::<Vec<_>>(), mask: lines.mask };
            let still = vec![Vec2::ZERO; positions.len()];
            let (pull, other) = fitter.fit_with(positions, &still, Some(term), progress)?;
            add(&mut field, &pull, 1.0);
            return Ok((field, Some(pull), report.worst(other)));
        }
        Ok((field, None, report))
    }
}

/// What a field leaves of velocities at positions.
fn left(field: &Field, positions: &[Vec2], velocities: &[Vec2]) -> Vec<Vec2> {
    let rows = positions.par_iter().zip(velocities).with_min_len(512);
    rows.map(|(&p, &v)| v - field.velocity(p)).collect()
}

fn add(field: &mut Field, other: &Field, share: f32) {
    let before = field.clone();
    Field::blend(&before, 1.0, other, share, field);
}
