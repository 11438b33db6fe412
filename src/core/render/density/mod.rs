//! Density estimation: the smoothing kernel and its radius per pass.
//!
//! On a plane, progressive photon mapping with one radius per pass (Knaus and Zwicker 2011, *Progressive photon
//! mapping: a probabilistic approach*) is a histogram of each pass, filtered with the radius of that pass, and the mean
//! over the passes.
//!
//! The kernel is a box applied three times along rows and columns: the quadratic B-spline, smooth and round within
//! 3 %. Boxes of fractional length follow Gwosdek et al. 2011, *Theoretical foundations of Gaussian convolution by
//! extended box filtering*: a whole box plus a fraction of one texel on either side, of exactly the given
//! variance. Long boxes are running sums, whose cost does not depend on the radius (`running_sum`); three short ones are one
//! short convolution per axis, which skips dark blocks (`short_kernel`).

mod kernel;
mod running_sum;
mod short_kernel;

use super::texture::ReceiverTexture;
use kernel::{BOXES, ExtendedBox};
use running_sum::RunningSum;
use short_kernel::ShortKernel;

/// Knaus and Zwicker's alpha: the reduction of the squared radius from pass to pass.
const ALPHA: f64 = 2.0 / 3.0;
/// Reach in texels up to which one short convolution is faster than three running sums: measured on 2.4 M texels, all lit,
/// 1024 to a row.
const MAX_SHORT_REACH: usize = 24;

/// The kernel radius of pass `pass` (from 0), from that of the first, both in plane units:
/// r_(i+1)^2 = r_i^2 (i + 2/3) / (i + 1), i = 1, 2, ...
pub fn radius_of_pass(first: f32, pass: usize) -> f32 {
    let shrink: f64 = (1..=pass).map(|i| (i as f64 + ALPHA) / (i as f64 + 1.0)).product();
    (f64::from(first) * shrink.sqrt()) as f32
}

/// The default first radius, in plane units, for `photons` per pass over `area` (plane units squared): about fifty photons
/// under the kernel at mean density, so 14 % noise there in the first pass, less in bright places and with every pass.
pub fn default_radius(photons: usize, area: f32) -> f32 {
    // The kernel of radius r has the variance r^2/9 per axis and averages the photons of an area of 4 pi r^2/9.
    const UNDER_KERNEL: f32 = 50.0;
    let per_photon = area / photons.max(1) as f32;
    (9.0 * UNDER_KERNEL * per_photon / (4.0 * std::f32::consts::PI)).sqrt()
}

/// The kernel filter, with buffers kept from call to call.
#[derive(Debug, Default)]
pub struct KernelFilter {
    running: RunningSum,
    short: ShortKernel,
}

impl KernelFilter {
    /// Filters with the kernel of `radius` (plane units): support `radius` and variance radius^2/9 along each axis. Reflection
    /// at the border conserves flux.
    pub fn filter(&mut self, texture: &mut ReceiverTexture, radius: f32) {
        let variance = f64::from(radius / texture.layout().texel).powi(2) / 9.0 / BOXES as f64;
        let kernel = ExtendedBox::with_variance(variance);
        if kernel.is_identity() {
            return;
        }
        if BOXES * kernel.reach() <= MAX_SHORT_REACH {
            self.short.filter(texture, &kernel.weights());
        } else {
            self.running.filter(texture, &kernel);
        }
    }
}
