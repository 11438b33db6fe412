//! Structural similarity: Wang, Bovik, Sheikh and Simoncelli 2004, *Image quality assessment: from error visibility to
//! structural similarity*.

use glam::Vec3;
use rayon::prelude::*;

use lightloom_core::render::Image;

/// Pixels on either side of the middle of a window.
const REACH: usize = 5;
/// Standard deviation of the window, pixels.
const SIGMA: f64 = 1.5;
/// (0.01)^2 and (0.03)^2 of the whole range of values, which is 1: they keep dark and flat places from deciding.
const C1: f64 = 1e-4;
const C2: f64 = 9e-4;

/// How alike two pictures in screen values look, by their luma: 1 for equal ones, less for others. The mean over all
/// Gaussian windows of 11 x 11 pixels that lie inside; of the pictures' own size where they are smaller.
///
/// # Panics
/// When the sizes differ.
pub(crate) fn ssim(a: &Image, b: &Image) -> f64 {
    assert_eq!((a.width, a.height), (b.width, b.height), "pictures of one size");
    let (width, reach) = (a.width, REACH.min(a.width.min(a.height).saturating_sub(1) / 2));
    let window = window(reach);
    let moments: Vec<Snapshots> = a.pixels.par_iter().zip(&b.pixels).map(|(a, b)| moments(*a, *b)).collect();
    let rows: Vec<&[Snapshots]> = moments.chunks_exact(width.max(1)).collect();
    let sum: f64 = (reach..a.height.saturating_sub(reach))
        .into_par_iter()
        .map(|y| {
            let column = |x: usize| weigh(&window, |i| rows[y + i - reach][x]);
            let columns: Vec<Snapshots> = (0..width).map(column).collect();
            columns.windows(window.len()).map(|near| similarity(weigh(&window, |i| near[i]))).sum::<f64>()
        })
        // In order, so that the number of threads does not show.
        .collect::<Vec<f64>>()
        .iter()
        .sum();
    let windows = (width - 2 * reach) * (a.height - 2 * reach);
    sum / windows.max(1) as f64
}

/// x, y, xx, yy, xy of a pixel in the one picture and the other, or their weighted means.
type Snapshots = [f64; 5];

fn moments(a: Vec3, b: Vec3) -> Snapshots {
    // Rec. 709 luma.
    let [x, y] = [a, b].map(|c| c.as_dvec3().dot(glam::dvec3(0.2126, 0.7152, 0.0722)));
    [x, y, x * x, y * y, x * y]
}

/// Gaussian weights that sum to 1.
fn window(reach: usize) -> Vec<f64> {
    let weight = |i: usize| (-0.5 * ((i as f64 - reach as f64) / SIGMA).powi(2)).exp();
    let weights: Vec<f64> = (0..=2 * reach).map(weight).collect();
    let sum: f64 = weights.iter().sum();
    weights.into_iter().map(|weight| weight / sum).collect()
}

fn weigh(window: &[f64], at: impl Fn(usize) -> Snapshots) -> Snapshots {
    let mut mean = Snapshots::default();
    for (i, weight) in window.iter().enumerate() {
        for (mean, value) in mean.iter_mut().zip(at(i)) {
            *mean += weight * value;
        }
    }
    mean
}

fn similarity([x, y, xx, yy, xy]: Snapshots) -> f64 {
    let (vx, vy, common) = (xx - x * x, yy - y * y, xy - x * y);
    (2.0 * x * y + C1) * (2.0 * common + C2) / ((x * x + y * y + C1) * (vx + vy + C2))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grey(width: usize, height: usize, at: impl Fn(usize, usize) -> f64) -> Image {
        let pixels = (0..width * height).map(|i| Vec3::splat(at(i % width, i / width) as f32)).collect();
        Image { width, height, pixels }
    }

    fn waves(x: usize, y: usize) -> f64 {
        0.5 + 0.4 * (0.5 * x as f64).sin() * (0.3 * y as f64).cos()
    }

    #[test]
    fn it_is_what_others_compute() {
        // By scikit-image 0.26, structural_similarity(a, b, gaussian_weights=True, sigma=1.5, data_range=1,
        // use_sample_covariance=False); the difference is the rounding of pixels to f32.
        let (a, b) = (
            grey(40, 24, waves),
            grey(40, 24, |x, y| 0.8 * waves(x, y) + 0.05 * (((7 * x + 13 * y) % 5) as f64 - 2.0)),
        );
        assert!((ssim(&a, &b) - 0.817_645_564_2).abs() < 1e-6, "{}", ssim(&a, &b));
    }

    #[test]
    fn equal_pictures_are_1_and_noise_lowers_it() {
        let clean = grey(40, 30, waves);
        assert_eq!(ssim(&clean, &clean), 1.0);
        // A pattern without order to the eye: multiples of the golden ratio.
        let noisy = |size: f64| {
            grey(40, 30, |x, y| waves(x, y) + size * (((x + 40 * y) as f64 * 0.618_034).fract() - 0.5))
        };
        let seen = [0.02, 0.05, 0.1, 0.3].map(|size| ssim(&clean, &noisy(size)));
        assert!(seen[0] < 1.0 && seen.is_sorted_by(|a, b| a > b), "{seen:?}");
    }

    #[test]
    fn flat_and_tiny_pictures_have_one() {
        // Without structure only the ratio of the means is left.
        let expected = (2.0 * 0.2 * 0.6 + C1) / (0.04 + 0.36 + C1);
        for (width, height) in [(20, 16), (3, 30), (1, 1)] {
            let (a, b) = (grey(width, height, |_, _| 0.2), grey(width, height, |_, _| 0.6));
            assert!((ssim(&a, &b) - expected).abs() < 1e-6, "{width} x {height}");
        }
    }
}
