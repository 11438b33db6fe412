//! Clamping of fireflies: single pixels that are far brighter than all around them.

use glam::Vec3;
use rayon::prelude::*;
use serde::Serialize;

use super::image::Image;
use crate::math::colour::luminance;

/// Largest luminance of a pixel over that of its second brightest neighbour, in glass and mirrors. A highlight is at least two pixels
/// wide after the reconstruction filter; a pixel that stands out further is an accident of sampling, or would twinkle.
const SPECULAR: f32 = 2.0;
/// The same on even ground, where no light is as narrow as a pixel, and for light of which few samples are taken.
const EVEN: f32 = 1.1;
/// The least luminance that is clamped on even ground, over that in glass: grain in the dark is not seen.
const GRAIN: f32 = 0.1;

/// What a pixel may show, as far as outliers are concerned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Shows {
    /// Glass or a mirror.
    Specular,
    /// The ground alone.
    Even,
    /// Anything else, which may be as small as a pixel.
    Detail,
}

/// Highlights of the background that were clamped.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, serde::Deserialize)]
pub struct ClampedLight {
    /// Pixels that lost light.
    pub pixels: usize,
    /// The light that they lost, as a share of all light in the picture.
    pub share: f64,
}

/// Clamps outliers to the second brightest neighbour, times a factor by what the pixels show, and at least to `floor` in glass
/// and mirrors. Returns the luminance that each pixel lost.
pub(super) fn clamp_outliers(image: &mut Image, shows: &[Shows], floor: f32) -> Vec<f32> {
    clamp(image, |i, pixel, second| match shows[i] {
        Shows::Specular => darkened(pixel, (SPECULAR * luminance(second)).max(floor)),
        // A chance path has a colour of its own.
        Shows::Even if luminance(pixel) > (EVEN * luminance(second)).max(GRAIN * floor) => second,
        Shows::Even | Shows::Detail => pixel,
    })
}

/// Clamps what stands out in a picture of few samples, and what then stands out still.
pub(super) fn clamp_speckles(image: &mut Image) {
    (0..2).for_each(|_| drop(clamp(image, |_, pixel, second| darkened(pixel, EVEN * luminance(second)))));
}

/// The same colour with a luminance of at most `most`.
fn darkened(pixel: Vec3, most: f32) -> Vec3 {
    let luminance = luminance(pixel);
    if luminance > most { pixel * (most / luminance) } else { pixel }
}

/// Replaces each pixel by what `clamped` makes of its index, itself and its second brightest neighbour. Returns the luminance that each
/// pixel lost.
fn clamp(image: &mut Image, clamped: impl Fn(usize, Vec3, Vec3) -> Vec3 + Sync) -> Vec<f32> {
    let (width, height) = (image.width, image.height);
    let before = image.pixels.clone();
    let second = |i: usize| {
        let (x, y) = (i % width, i / width);
        let mut brightest = [(0.0_f32, Vec3::ZERO); 2];
        for row in y.saturating_sub(1)..(y + 2).min(height) {
            for other in (x.saturating_sub(1)..(x + 2).min(width)).map(|column| row * width + column) {
                let this = (luminance(before[other]), before[other]);
                if other != i && this.0 > brightest[1].0 {
                    brightest =
                        if this.0 > brightest[0].0 { [this, brightest[0]] } else { [brightest[0], this] };
                }
            }
        }
        brightest[1].1
    };
    let clamp = |(i, pixel): (usize, &mut Vec3)| {
        *pixel = clamped(i, before[i], second(i));
        (luminance(before[i]) - luminance(*pixel)).max(0.0)
    };
    image.pixels.par_iter_mut().enumerate().map(clamp).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lone_pixel_in_glass_or_on_the_ground_is_clamped_and_a_line_or_a_wall_is_not() {
        let mut image = Image::new(9, 9);
        image.pixels.fill(Vec3::splat(0.1));
        // Lone pixels in glass, on a wall and on the ground; a highlight one pixel wide.
        for lit in [11, 15, 31, 55, 56, 57, 58] {
            image.pixels[lit] = Vec3::ONE;
        }
        let shows = |i| match i {
            15 => Shows::Detail,
            27..36 => Shows::Even,
            _ => Shows::Specular,
        };
        let shows: Vec<Shows> = (0..81).map(shows).collect();
        let lost = clamp_outliers(&mut image, &shows, 0.0);
        // Luminance weights sum to 1 up to rounding in 32 bits.
        assert!((image.pixels[11].x - 0.2).abs() < 1e-6 && (lost[11] - 0.8).abs() < 1e-6);
        assert!((image.pixels[31].x - 0.1).abs() < 1e-6, "{}", image.pixels[31]);
        assert!([15, 56, 57].iter().all(|&i| image.pixels[i] == Vec3::ONE && lost[i] == 0.0));
        // The ends of the line have one bright neighbour: they become softer, not dark.
        assert!(image.pixels[55].x >= 0.2 && image.pixels.iter().all(|pixel| pixel.x >= 0.1));
    }

    #[test]
    fn speckles_go_and_the_middle_of_a_line_stays() {
        let mut image = Image::new(9, 9);
        image.pixels.fill(Vec3::splat(0.1));
        for lit in [11, 13, 46, 47, 48, 49, 50, 51] {
            image.pixels[lit] = Vec3::ONE;
        }
        clamp_speckles(&mut image);
        assert!([11, 13].iter().all(|&i| image.pixels[i].x < 0.13), "{:?}", &image.pixels[9..18]);
        assert!([48, 49].iter().all(|&i| image.pixels[i] == Vec3::ONE), "{:?}", &image.pixels[45..54]);
    }
}
