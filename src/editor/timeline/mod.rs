//! The timeline: transport, ruler, coverage of the preview, key frames, and spans of constraints.

mod commands;
mod coverage_bar;
mod drag;
mod edits;
pub(in crate::editor) mod icons;
mod key_frames;
mod lanes;
mod ruler;
mod scale;
mod spans;
mod thumbnails;
mod transport;

use egui::{Align2, FontId, PointerButton, Rect, Ui, pos2};

pub use commands::carry_out;

use super::playback;
use crate::editor::access::Access;
use crate::editor::context::EditorContext;
use drag::Dragging;
use lanes::{GUTTER, KEYS, ROW, with_bar};
use scale::{Scale, VisibleRange};
use thumbnails::Thumbnails;

/// The timeline of the window.
#[derive(Default)]
pub struct Timeline {
    /// The visible part of the time axis; none for all frames.
    seen: Option<VisibleRange>,
    drag: Dragging,
    /// Which files outside of the folder of the project thumbnails may read.
    pub access: Access,
    thumbnails: Thumbnails,
}

impl Timeline {
    /// Shows the timeline. Returns the rectangle of the play button.
    pub fn show(&mut self, ui: &mut Ui, editor: &mut EditorContext) -> Rect {
        let play = self.transport(ui, editor);
        ui.add_space(2.0);
        let area = ui.available_rect_before_wrap();
        ui.allocate_rect(area, egui::Sense::hover());
        let track = area.with_min_x(area.left() + GUTTER);
        let scale = self.scale(track, editor);
        let lane = |top: f32, height: f32| Rect::from_x_y_ranges(track.x_range(), top..=top + height);
        let ruler = lane(area.top(), ruler::HEIGHT);
        let stripe = lane(ruler.bottom(), coverage_bar::HEIGHT);
        let keys = lane(stripe.bottom(), KEYS);
        ruler::show(ui, ruler, &scale, editor);
        coverage_bar::show(ui, stripe, &scale, editor);
        self.keys(ui, keys, &scale, editor);
        title(ui, area, ruler, "Frames");
        title(ui, area, keys, "Key frames");
        let bars = Rect::from_min_max(pos2(area.left(), keys.bottom() + 2.0), area.max);
        if bars.height() >= ROW {
            self.spans(ui, bars, &scale, editor);
        }
        let over = Rect::from_min_max(track.min, pos2(track.right(), area.bottom()));
        ruler::playhead(ui, over, &scale, editor.session.playhead);
        self.navigate(ui, ruler.union(keys), &scale, editor);
        play
    }

    /// Preferred height for the bars of a document, points.
    pub fn height(editor: &EditorContext) -> f32 {
        let bars = with_bar(editor.document.project(), &editor.session.selection).len();
        30.0 + ruler::HEIGHT + coverage_bar::HEIGHT + KEYS + 8.0 + ROW * bars.clamp(1, 5) as f32
    }

    fn scale(&self, track: Rect, editor: &EditorContext) -> Scale {
        let whole = playback::whole(editor.document.project());
        Scale::new(track.x_range(), self.seen.unwrap_or_else(|| VisibleRange::all(&whole, track.width())))
    }

    /// The wheel zooms about the pointer; Shift, sideways scrolling and the middle button pan.
    fn navigate(&mut self, ui: &Ui, rect: Rect, scale: &Scale, editor: &EditorContext) {
        let Some(at) = ui.input(|i| i.pointer.hover_pos()).filter(|at| rect.contains(*at)) else { return };
        if ui.ctx().layer_id_at(at) != Some(ui.layer_id()) {
            return;
        }
        let (scroll, zoom, drag) = ui.input(|i| {
            let drag = if i.pointer.button_down(PointerButton::Middle) { i.pointer.delta().x } else { 0.0 };
            (i.smooth_scroll_delta(), i.zoom_delta(), drag)
        });
        let factor = f64::from(zoom) * f64::from(scroll.y / 240.0).exp2();
        let seen = if factor != 1.0 { scale.zoomed(factor, at.x) } else { scale.panned(scroll.x + drag) };
        if factor != 1.0 || scroll.x + drag != 0.0 {
            self.seen = Some(seen.kept_near(&playback::whole(editor.document.project())));
        }
    }
}

/// The name of a lane in the gutter.
fn title(ui: &Ui, area: Rect, lane: Rect, text: &str) {
    let place = pos2(area.left() + GUTTER - 8.0, lane.center().y);
    let colour = ui.visuals().weak_text_color();
    ui.painter().text(place, Align2::RIGHT_CENTER, text, FontId::proportional(11.5), colour);
}
