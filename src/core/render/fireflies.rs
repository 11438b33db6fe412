//! Clamping of fireflies: single pixels in glass and mirrors that are far brighter than all around them.

use glam::Vec3;
use rayon::prelude::*;
use serde::Serialize;

use super::image::Image;
use crate::math::colour::luminance;

/// Largest luminance of a pixel over that of its second brightest neighbour. A highlight is at least two pixels wide after the
/// reconstruction filter; a pixel that stands out further is an accident of sampling, or would twinkle.
const OUTLIER: f32 = 2.0;

/// Highlights of the background that were clamped.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, serde::Deserialize)]
pub struct ClampedLight {
    /// Pixels that lost light.
    pub pixels: usize,
    /// The light that they lost, as a share of all light in the picture.
    pub share: f64,
}

/// Clamps outliers among the pixels that are `specular`: to the second brightest neighbour, times [`OUTLIER`], and at least to
/// `floor`. Returns the luminance that each pixel lost.
pub(super) fn clamp_outliers(image: &mut Image, specular: &[bool], floor: f32) -> Vec<f32> {
    let (width, height) = (image.width, image.height);
    let before: Vec<f32> = image.pixels.par_iter().map(|pixel| luminance(*pixel)).collect();
    let most = |i: usize| {
        let (x, y) = (i % width, i / width);
        let mut brightest = [0.0_f32; 2];
        for row in y.saturating_sub(1)..(y + 2).min(height) {
            for other in (x.saturating_sub(1)..(x + 2).min(width)).map(|column| row * width + column) {
                if other != i && before[other] > brightest[1] {
                    brightest[1] = before[other].min(brightest[0]);
                    brightest[0] = before[other].max(brightest[0]);
                }
            }
        }
        (OUTLIER * brightest[1]).max(floor)
    };
    let clamp = |(i, pixel): (usize, &mut Vec3)| {
        let most = if specular[i] { most(i) } else { f32::INFINITY };
        if before[i] <= most {
            return 0.0;
        }
        *pixel *= most / before[i];
        before[i] - most
    };
    image.pixels.par_iter_mut().enumerate().map(clamp).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lone_pixel_in_glass_is_clamped_and_a_line_or_a_wall_is_not() {
        let mut image = Image::new(9, 9);
        image.pixels.fill(Vec3::splat(0.1));
        // A lone pixel in glass and one beside it; a highlight one pixel wide.
        for lit in [11, 15, 55, 56, 57, 58] {
            image.pixels[lit] = Vec3::ONE;
        }
        let specular: Vec<bool> = (0..81).map(|i| i != 15).collect();
        let lost = clamp_outliers(&mut image, &specular, 0.0);
        // Luminance weights sum to 1 up to rounding in 32 bits.
        assert!((image.pixels[11].x - 0.2).abs() < 1e-6 && (lost[11] - 0.8).abs() < 1e-6);
        assert!([15, 56, 57].iter().all(|&i| image.pixels[i] == Vec3::ONE && lost[i] == 0.0));
        // The ends of the line have one bright neighbour: they become softer, not dark.
        assert!(image.pixels[55].x >= 0.2 && image.pixels.iter().all(|pixel| pixel.x >= 0.1));
    }
}
