//! Which pixels of a path traced picture need more samples.
//!
//! Each pixel has two independent estimates of equally many samples; half their difference is a measure of its error that
//! counts what stratification gains, which the variance of the samples does not. One such measure is a poor one, so that
//! of the neighbours is taken together. The pixel itself does not count: if its own samples ended its sampling it would
//! stop where they happen to agree, and what is rare and bright would be lost. Its neighbours' do not depend on its own, so
//! its mean stays that of its samples.

use rayon::prelude::*;

/// What the samples of a pixel say so far.
#[derive(Clone, Copy, Debug)]
pub(super) struct Estimate {
    /// Mean luminance.
    pub(super) luminance: f32,
    /// Luminance of the first half of the samples, less the mean.
    pub(super) change: f32,
    /// Samples.
    pub(super) count: u32,
}

fn env(name: &str, or: f32) -> f32 {
    std::env::var(name).ok().and_then(|v| v.parse().ok()).unwrap_or(or)
}

/// Whether each pixel needs more samples. `floor` is added to a pixel's luminance, which the error is relative to.
pub(super) fn noisy(estimates: &[Estimate], width: usize, floor: f32, base: u32) -> Vec<bool> {
    let (tolerance, q) = (env("BG_TOL", 0.016), env("BG_Q", 0.5));
    let height = estimates.len() / width;
    let around = |i: usize, count: usize| i.saturating_sub(1)..(i + 2).min(count);
    let needs = |i: usize| {
        let count = estimates[i].count as f32;
        let (mut variance, mut luminance, mut neighbours) = (0.0, 0.0, 0.0);
        for y in around(i / width, height) {
            for j in around(i % width, width).map(|x| y * width + x).filter(|j| *j != i) {
                let other = estimates[j];
                variance += other.change.powi(2) * other.count as f32 / count;
                luminance += other.luminance;
                neighbours += 1.0_f32;
            }
        }
        let (variance, level) = (variance / neighbours.max(1.0), luminance / neighbours.max(1.0) + floor);
        variance * (base as f32 / count).powf(q) > (tolerance * level).powi(2)
    };
    (0..estimates.len()).into_par_iter().map(needs).collect()
}
