//! The frame of all modal windows.

use egui::{Context, Frame, Id, Modal};

/// A window over all others, with room around its content.
pub(in crate::editor) fn modal(ctx: &Context, name: &'static str) -> Modal {
    let shown = (Id::unique(name), ctx.cumulative_frame_nr());
    ctx.data_mut(|data| data.insert_temp(last_shown(), shown));
    let style = ctx.global_style();
    let frame = Frame::popup(&style).inner_margin(16).corner_radius(style.visuals.window_corner_radius);
    Modal::new(shown.0).frame(frame)
}

/// Whether a modal window was shown in this frame that takes Escape: in its first frame it does not.
pub(in crate::editor) fn is_on_top(ctx: &Context) -> bool {
    let shown: Option<(Id, u64)> = ctx.data(|data| data.get_temp(last_shown()));
    let top = ctx.memory(|memory| memory.top_modal_layer());
    top.is_some_and(|top| shown == Some((top.id, ctx.cumulative_frame_nr())))
}

fn last_shown() -> Id {
    Id::unique("modal window shown last")
}
