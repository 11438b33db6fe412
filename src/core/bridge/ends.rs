//! The two ends of a plan, and the factors that are found by scaling them in turn.

use crate::{Progress, Result};

/// Over-relaxation of the scaling around walls: 1.6 needs a quarter of the sweeps of 1.
pub(super) const RELAXATION: f64 = 1.6;
/// Values below this count as none: their logarithm is left alone.
pub(super) const LEAST: f64 = 1e-280;

/// One end of a plan.
pub(super) struct End {
    /// Share of the light in each cell; sum 1.
    pub(super) density: Vec<f64>,
    /// The factor of this end.
    pub(super) scale: Vec<f64>,
    /// The factor of the other end, spread to this one.
    pub(super) reached: Vec<f64>,
}

impl End {
    pub(super) fn new(density: Vec<f64>) -> Self {
        let zero = vec![0.0; density.len()];
        Self { scale: zero.clone(), reached: zero, density }
    }

    /// The factor that makes the light at this end what it is, over-relaxed by `relaxation` from 1 to below 2.
    pub(super) fn rescale(&mut self, relaxation: f64) {
        let columns = self.scale.iter_mut().zip(&self.density).zip(&self.reached);
        columns.for_each(|((scale, density), reached)| {
            let exact = over(*density, *reached);
            *scale = if relaxation == 1.0 || *scale <= 0.0 || exact <= 0.0 {
                exact
            } else {
                exact * (exact / *scale).powf(relaxation - 1.0)
            };
        });
    }

    /// The misplaced share of the light, 0 to 1.
    pub(super) fn error(&self) -> f64 {
        let columns = self.scale.iter().zip(&self.reached).zip(&self.density);
        0.5 * columns.map(|((scale, reached), density)| (scale * reached - density).abs()).sum::<f64>()
    }
}

/// Scales both ends in turn, until less than `tolerance` of the light is misplaced or `sweeps` times. The factor of the later
/// end is known. `spread(side, factor, out)` brings the factor of a side to the other end.
pub(super) fn scale_in_turn(
    [a, b]: &mut [End; 2],
    (sweeps, tolerance, relaxation): (usize, f64, f64),
    mut spread: impl FnMut(usize, &[f64], &mut [f64]),
    progress: &Progress,
) -> Result<()> {
    for sweep in 0..sweeps {
        progress.check()?;
        spread(1, &b.scale, &mut a.reached);
        if sweep > 0 && a.error() < tolerance {
            break;
        }
        let relaxation = if sweep < 3 { 1.0 } else { relaxation };
        a.rescale(relaxation);
        spread(0, &a.scale, &mut b.reached);
        b.rescale(relaxation);
    }
    spread(1, &b.scale, &mut a.reached);
    Ok(())
}

/// `a` / `b`; 0 where either is none.
pub(super) fn over(a: f64, b: f64) -> f64 {
    if a > 0.0 && b > LEAST { a / b } else { 0.0 }
}
