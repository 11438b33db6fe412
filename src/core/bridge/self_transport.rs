//! The transport of a density onto itself.

use super::ends::over;

/// Iterations of each renewal; the first starts from nothing.
const SWEEPS: usize = 4;
const FIRST_SWEEPS: usize = 12;
/// The least factor where there is light, over the largest: light that has come to a dark cell needs one to start from.
const LEAST: f64 = 1e-6;

/// The factor c of the transport of a density A onto itself, c (K c) = A.
#[derive(Default)]
pub(super) struct SelfTransport {
    scale: Vec<f64>,
    reached: Vec<f64>,
}

impl SelfTransport {
    /// Renews the factor for another density, from the last one. `spread(factor, out)` is the kernel.
    pub(super) fn renew(&mut self, density: &[f64], mut spread: impl FnMut(&[f64], &mut [f64])) -> &[f64] {
        let fresh = self.scale.is_empty();
        if fresh {
            self.scale = density.iter().map(|density| density.sqrt()).collect();
            self.reached = vec![0.0; density.len()];
        }
        lift(&mut self.scale, density);
        for _ in 0..if fresh { FIRST_SWEEPS } else { SWEEPS } {
            spread(&self.scale, &mut self.reached);
            let columns = self.scale.iter_mut().zip(density).zip(&self.reached);
            // The square root damps the swing of the symmetric iteration.
            columns
                .for_each(|((scale, density), reached)| *scale = (*scale * over(*density, *reached)).sqrt());
        }
        &self.scale
    }
}

/// Raises a factor from an earlier density to a start for another one: none where there is no light, and something elsewhere.
pub(super) fn lift(scale: &mut [f64], density: &[f64]) {
    let least = LEAST * scale.iter().copied().fold(0.0, f64::max);
    for (scale, density) in scale.iter_mut().zip(density) {
        *scale = if *density > 0.0 { scale.max(least) } else { 0.0 };
    }
}
