//! Exponents of power laws.

/// The exponent of the power law nearest to the points, by least squares of ln y over ln x. None where two different sizes are
/// missing, or a number is not > 0.
pub(crate) fn slope(points: &[(f64, f64)]) -> Option<f64> {
    let logs: Vec<(f64, f64)> = points.iter().map(|&(x, y)| (x.ln(), y.ln())).collect();
    if !logs.iter().all(|(x, y)| x.is_finite() && y.is_finite()) {
        return None;
    }
    let count = logs.len() as f64;
    let mean = |pick: fn(&(f64, f64)) -> f64| logs.iter().map(pick).sum::<f64>() / count;
    let (mean_x, mean_y) = (mean(|p| p.0), mean(|p| p.1));
    let spread: f64 = logs.iter().map(|(x, _)| (x - mean_x).powi(2)).sum();
    let common: f64 = logs.iter().map(|(x, y)| (x - mean_x) * (y - mean_y)).sum();
    (spread > 0.0).then_some(common / spread)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn a_power_law_has_its_exponent() {
        let law: Vec<(f64, f64)> =
            [1.0, 3.0, 10.0, 500.0].map(|x: f64| (x, 7.0 * x.powf(-1.0 / 3.0))).to_vec();
        assert!((slope(&law).unwrap() + 1.0 / 3.0).abs() < 1e-12);
    }

    #[test]
    fn one_size_and_zero_have_none() {
        assert_eq!(slope(&[]), None);
        assert_eq!(slope(&[(2.0, 1.0), (2.0, 3.0)]), None);
        assert_eq!(slope(&[(1.0, 0.0), (2.0, 1.0)]), None);
    }
}
