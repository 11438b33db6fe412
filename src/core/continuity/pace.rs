//! How fast photons go.

use glam::Vec2;
use rayon::prelude::*;

/// The quantile of the speed beside the fastest: one of twenty thousand may be an outlier of the pairing.
const QUANTILE: f64 = 0.999;

/// Speeds over the mean straight speed.
#[derive(Default)]
pub(super) struct Pace {
    pub(super) fastest: f64,
    pub(super) quantile: f64,
    pub(super) straight: f64,
}

impl Pace {
    /// Of photons at evenly spaced times; 0 where nothing moves from the first to the last.
    pub(super) fn of(frames: &[Vec<Vec2>]) -> Self {
        let [Some(first), Some(last)] = [frames.first(), frames.last()] else { return Self::default() };
        let ways = distances(first, last);
        let mean = ways.iter().sum::<f64>() / ways.len().max(1) as f64;
        if mean <= 0.0 {
            return Self::default();
        }
        let per_mean = (frames.len() - 1) as f64 / mean;
        let steps = frames.par_windows(2).map(|pair| {
            let mut distances = distances(&pair[0], &pair[1]);
            (max(&distances), quantile(&mut distances, QUANTILE))
        });
        let (fastest, quantile) = steps.reduce(|| (0.0, 0.0), |a, b| (a.0.max(b.0), a.1.max(b.1)));
        Self { fastest: fastest * per_mean, quantile: quantile * per_mean, straight: max(&ways) / mean }
    }
}

fn distances(from: &[Vec2], to: &[Vec2]) -> Vec<f64> {
    from.iter().zip(to).map(|(a, b)| a.as_dvec2().distance(b.as_dvec2())).collect()
}

fn max(values: &[f64]) -> f64 {
    values.iter().copied().fold(0.0, f64::max)
}

/// The quantile `q` of the values, which it reorders: between two of them, as the place between falls; 0 of none.
fn quantile(values: &mut [f64], q: f64) -> f64 {
    let Some(last) = values.len().checked_sub(1) else { return 0.0 };
    let place = q * last as f64;
    let (_, &mut low, above) = values.select_nth_unstable_by(place as usize, f64::total_cmp);
    let next = above.iter().copied().reduce(f64::min).unwrap_or(low);
    low + (next - low) * place.fract()
}
