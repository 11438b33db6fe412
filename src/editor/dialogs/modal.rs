//! The frame of all modal windows.

use egui::{Context, Frame, Id, Modal};

/// A window over all others, with room around its content.
pub(in crate::editor) fn modal(ctx: &Context, name: &'static str) -> Modal {
    let style = ctx.global_style();
    let frame = Frame::popup(&style).inner_margin(16).corner_radius(style.visuals.window_corner_radius);
    Modal::new(Id::unique(name)).frame(frame)
}
