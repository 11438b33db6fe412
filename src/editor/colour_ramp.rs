//! Colours along a range.

use egui::Color32;

/// The colour at a share of the range of `colours`, at least two at even distances: 0 is the first, 1 the last.
pub(super) fn along(colours: &[Color32], share: f32) -> Color32 {
    let at = share.clamp(0.0, 1.0) * (colours.len() - 1) as f32;
    let from = (at as usize).min(colours.len() - 2);
    colours[from].lerp_to_gamma(colours[from + 1], at - from as f32)
}
