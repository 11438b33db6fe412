//! Light in false colours: luminance in stops around middle grey.

use egui::Color32;
use glam::Vec3;
use lightloom_core::math::colour::luminance;
use lightloom_core::render::Image;

use crate::editor::colour_ramp::along;

/// Stops around middle grey that the colours tell apart.
pub const STOPS: f32 = 6.0;
/// Linear value of middle grey.
const GREY: f32 = 0.18;
/// From the darkest to the brightest; grey in the middle.
const COLOURS: [Color32; 7] = [
    Color32::from_rgb(24, 12, 60),
    Color32::from_rgb(40, 60, 190),
    Color32::from_rgb(40, 160, 190),
    Color32::from_rgb(128, 128, 128),
    Color32::from_rgb(120, 200, 70),
    Color32::from_rgb(245, 200, 40),
    Color32::from_rgb(235, 50, 40),
];

/// The colour of a share of the range, 0..=1.
pub fn of_share(share: f32) -> Color32 {
    along(&COLOURS, share)
}

/// The colour of exposed linear light; black where there is none.
fn of_light(exposed: Vec3) -> Color32 {
    let luminance = luminance(exposed);
    // Written so that NaN is black, too.
    if luminance > 0.0 { of_share(0.5 + 0.5 * (luminance / GREY).log2() / STOPS) } else { Color32::BLACK }
}

/// A picture in false colours; `gain` is that of the exposure.
pub(super) fn of_image(image: &Image, gain: f32) -> egui::ColorImage {
    let pixels = image.pixels.iter().map(|&light| of_light(light * gain)).collect();
    egui::ColorImage::new([image.width, image.height], pixels)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn middle_grey_is_grey_and_a_stop_of_exposure_is_a_stop_of_light() {
        let at = |light: f32, gain: f32| of_light(Vec3::splat(light * gain));
        assert_eq!(at(GREY, 1.0), COLOURS[3]);
        assert_eq!(at(GREY, 4.0), at(4.0 * GREY, 1.0));
        assert_eq!(at(GREY * 64.0, 1.0), COLOURS[6]);
        assert_eq!(at(1e9, 1.0), COLOURS[6]);
        for dark in [0.0, -1.0, f32::NAN] {
            assert_eq!(at(dark, 1.0), Color32::BLACK);
        }
    }
}
