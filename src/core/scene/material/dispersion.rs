//! Colour by wavelength. A white beam that enters dispersive glass samples one wavelength and becomes coloured light of the
//! same total: the channels are overlapping bands of the visible range, nonnegative, which sum to white exactly. (Colour
//! matching functions have negative lobes in Rec.709; negative flux could not be matched.)

use glam::Vec3;

use crate::math::rng::Stream;

/// The visible range (nm).
pub const VISIBLE_NM: [f32; 2] = [400.0, 700.0];
/// Half width of the ramp between two bands, as a share of the range.
const RAMP: f32 = 0.12;

/// The colour (R, G, B) of light of one wavelength (nm); its mean over the visible range is (1, 1, 1), and its three
/// channels sum to 3 at every wavelength.
pub fn rgb_of_wavelength(nm: f32) -> Vec3 {
    let x = (nm - VISIBLE_NM[0]) / (VISIBLE_NM[1] - VISIBLE_NM[0]);
    let above = |edge: f32| ((x - edge) / (2.0 * RAMP) + 0.5).clamp(0.0, 1.0);
    let (green_on, red_on) = (above(1.0 / 3.0), above(2.0 / 3.0));
    3.0 * Vec3::new(red_on, green_on - red_on, 1.0 - green_on)
}

/// A wavelength (nm) sampled in proportion to its share of `weight`, with the beam's new colour: its channels sum to those
/// of `weight`, and its expectation is `weight`.
pub(super) fn sample_wavelength(weight: Vec3, rng: &mut Stream) -> (f32, Vec3) {
    let sum = weight.element_sum();
    let choice = rng.f32() * sum;
    let band = if choice < weight.z {
        0.0
    } else if choice < weight.z + weight.y {
        1.0
    } else {
        2.0
    };
    // A box of one third convolved with a box of the ramp's width is the band's trapezoid; the outer ends fold back.
    let x = (band + rng.f32()) / 3.0 + RAMP * (2.0 * rng.f32() - 1.0);
    let x = if x < 0.0 {
        -x
    } else if x > 1.0 {
        2.0 - x
    } else {
        x
    };
    let nm = VISIBLE_NM[0] + x * (VISIBLE_NM[1] - VISIBLE_NM[0]);
    let colour = weight * rgb_of_wavelength(nm);
    (nm, colour * (sum / colour.element_sum().max(f32::MIN_POSITIVE)))
}
