//! Colour maps.

use egui::Color32;

use crate::editor::colour_ramp::along;
use crate::editor::session::FieldMap;

/// Opacity of the largest values.
const OPAQUE: f32 = 0.82;
/// Colours of negative, positive and unsigned values.
const SIGNED: [Color32; 2] = [Color32::from_rgb(46, 130, 255), Color32::from_rgb(255, 72, 52)];
const UNSIGNED: Color32 = Color32::from_rgb(30, 200, 120);
/// Colours from rest to the maximum speed.
const SPEEDS: [Color32; 4] = [
    Color32::from_rgb(72, 92, 190),
    Color32::from_rgb(40, 170, 200),
    Color32::from_rgb(120, 225, 140),
    Color32::from_rgb(252, 240, 120),
];

/// The colour of a speed relative to the maximum, 0..=1.
pub(super) fn speed(share: f32) -> Color32 {
    along(&SPEEDS, share)
}

/// The colour of a signed value, -1..=1; transparent at 0.
pub(super) fn signed(share: f32) -> Color32 {
    SIGNED[usize::from(share > 0.0)].gamma_multiply(cover(share))
}

/// The colour of a magnitude, 0..=1; transparent at 0.
pub(super) fn unsigned(share: f32) -> Color32 {
    UNSIGNED.gamma_multiply(cover(share))
}

fn cover(share: f32) -> f32 {
    OPAQUE * share.abs().min(1.0).powf(0.8)
}

/// The colour of a map's value relative to the largest, -1..=1.
pub(super) fn of_map(of: FieldMap, share: f32) -> Color32 {
    match of {
        FieldMap::Divergence | FieldMap::Curl | FieldMap::Tears => signed(share),
        FieldMap::Residual => unsigned(share),
    }
}
