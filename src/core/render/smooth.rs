//! Smooth light on even ground: the samples of neighbouring pixels, taken together.
//!
//! Around most pixels of a table the light of large lamps is a quadratic but for noise. The least-squares quadratic through
//! 7 x 7 pixels (Savitzky and Golay 1964, in two dimensions) has a thirteenth of a pixel's variance at the middle, and next to no
//! bias; a mere mean would flatten the light. Where edges of shadows make it no quadratic, the residual tells.

/// Pixels to each side.
pub(super) const RADIUS: usize = 3;
const SIDE: usize = 2 * RADIUS + 1;
/// Pixels of the neighbourhood.
pub(super) const PIXELS: usize = SIDE * SIDE;
/// Coefficients of a quadratic.
const COEFFICIENTS: usize = 6;
/// Sums of the squares of the polynomials x and x^2 - 4 over the neighbourhood.
const OF_X: f32 = 196.0;
const OF_XX: f32 = 588.0;
/// Variance of the quadratic at the middle over that of a pixel.
pub(super) const VARIANCE: f32 = 1.0 / PIXELS as f32 + 2.0 * 16.0 / OF_XX;

/// The least-squares quadratic through the pixels of a neighbourhood.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Quadratic {
    /// Its value in the middle.
    pub(super) middle: f32,
    /// Variance of a pixel about it.
    pub(super) variance: f32,
}

impl Quadratic {
    /// Through `values`, row by row, with the orthogonal polynomials 1, x, y, xy, x^2 - 4 and y^2 - 4.
    pub(super) fn through(values: &[f32; PIXELS]) -> Self {
        // Less what all have in common, or rounding would be taken for noise.
        let common = values[PIXELS / 2];
        let [mut one, mut x1, mut y1, mut xy, mut xx, mut yy, mut squares] = [0.0_f32; 7];
        for (i, value) in values.iter().enumerate() {
            let value = value - common;
            let [x, y] = [i % SIDE, i / SIDE].map(|at| at as f32 - RADIUS as f32);
            one += value;
            x1 += x * value;
            y1 += y * value;
            xy += x * y * value;
            xx += (x * x - 4.0) * value;
            yy += (y * y - 4.0) * value;
            squares += value * value;
        }
        let explained = one * one / PIXELS as f32
            + (x1 * x1 + y1 * y1) / OF_X
            + xy * xy / (OF_X * OF_X / PIXELS as f32)
            + (xx * xx + yy * yy) / OF_XX;
        let middle = common + one / PIXELS as f32 - 4.0 * (xx + yy) / OF_XX;
        Self { middle, variance: (squares - explained).max(0.0) / (PIXELS - COEFFICIENTS) as f32 }
    }
}

/// The pixels of the neighbourhood of pixel `i`, row by row; none beside the border of the picture.
pub(super) fn neighbourhood(i: usize, [width, height]: [usize; 2]) -> Option<[usize; PIXELS]> {
    let (x, y) = (i % width, i / width);
    let inside = |at: usize, count: usize| at >= RADIUS && at + RADIUS < count;
    let first = i.checked_sub(RADIUS * width + RADIUS)?;
    (inside(x, width) && inside(y, height))
        .then(|| std::array::from_fn(|k| first + k / SIDE * width + k % SIDE))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::rng::{Purpose, Stream};

    fn values(of: impl FnMut(f32, f32) -> f32) -> [f32; PIXELS] {
        let mut of = of;
        std::array::from_fn(|i| of((i % SIDE) as f32 - 3.0, (i / SIDE) as f32 - 3.0))
    }

    #[test]
    fn a_quadratic_is_met_and_an_edge_is_not() {
        let exact =
            Quadratic::through(&values(|x, y| 2.0 + 0.3 * x - 0.2 * y + 0.1 * x * y - 0.05 * x * x + y * y));
        // Rounding of sums of squares up to 2000 in all, shared by 43.
        assert!((exact.middle - 2.0).abs() < 1e-4 && exact.variance < 1e-5, "{exact:?}");
        let edge = Quadratic::through(&values(|x, _| f32::from(x > 0.5)));
        assert!(edge.variance > 0.02, "{edge:?}");
    }

    #[test]
    fn noise_is_known_and_a_thirteenth_of_its_variance_is_left() {
        let mut stream = Stream::new(7, Purpose::Background, 0, 0);
        let rounds = 4000;
        let (mut variance, mut left) = (0.0_f64, 0.0_f64);
        for _ in 0..rounds {
            let fit = Quadratic::through(&values(|x, _| 5.0 + 0.1 * x + stream.f32()));
            variance += f64::from(fit.variance) / f64::from(rounds);
            left += f64::from(fit.middle - 5.5).powi(2) / f64::from(rounds);
        }
        // The variance of an even number is 1/12. Over 4000 rounds it is known to 1 %, that of the middle to 3 %: four times that.
        assert!((variance * 12.0 - 1.0).abs() < 0.02, "{variance}");
        assert!((left / variance / f64::from(VARIANCE) - 1.0).abs() < 0.1, "{left}");
    }

    #[test]
    fn a_neighbourhood_lies_within_the_picture() {
        for (x, y) in [(0, 5), (5, 0), (2, 5), (8, 5), (5, 2), (9, 9)] {
            assert_eq!(
                neighbourhood(y * 11 + x, [11, 10]).is_some(),
                (3..8).contains(&x) && (3..7).contains(&y)
            );
        }
        let around = neighbourhood(5 * 11 + 5, [11, 10]).expect("inside");
        assert_eq!((around[0], around[24], around[48]), (2 * 11 + 2, 5 * 11 + 5, 8 * 11 + 8));
    }
}
