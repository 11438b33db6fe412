//! The ruler: frame numbers and seconds, scrubbing, playback marks, playhead.

use std::sync::Arc;

use egui::{
    Align2, CursorIcon, FontId, Galley, Id, PointerButton, Rect, Response, Sense, Shape, Stroke, Ui,
    WidgetInfo, pos2, vec2,
};

use super::commands::go;
use super::scale::Scale;
use crate::editor::context::EditorContext;
use crate::editor::playback;
use crate::editor::theme;

/// Height, points.
pub(super) const HEIGHT: f32 = 34.0;

/// Shows the ruler and asks for the frame scrubbed to.
pub(super) fn show(ui: &mut Ui, rect: Rect, scale: &Scale, editor: &mut EditorContext) -> Response {
    let response = ui.interact(rect, ui.scope_id().with("ruler"), Sense::click_and_drag());
    let frame = editor.session.playhead;
    response.widget_info(|| WidgetInfo::slider(true, f64::from(frame), "Time ruler"));
    let painter = ui.painter_at(rect);
    painter.rect_filled(rect, 0.0, ui.visuals().extreme_bg_color);
    shade(ui, rect, scale, editor);
    ticks(ui, rect, scale, editor);
    let held = response.dragged_by(PointerButton::Primary) || response.clicked_by(PointerButton::Primary);
    if held && let Some(at) = response.interact_pointer_pos() {
        let frame = scale.frame(at.x);
        if frame != editor.session.playhead || editor.session.playing {
            go(editor, frame);
        }
    }
    marks(ui, rect, scale, editor);
    response.on_hover_cursor(CursorIcon::ResizeHorizontal).on_hover_text(
        "Drag to scrub. The wheel zooms, with Shift it pans; I and O set the in and out points.",
    )
}

fn ticks(ui: &Ui, rect: Rect, scale: &Scale, editor: &EditorContext) {
    let project = editor.document.project();
    let (fps, first) = (playback::fps(project), *playback::whole(project).start());
    let painter = ui.painter_at(rect);
    let [step, tick] = scale.steps();
    let visuals = ui.visuals();
    let (strong, weak) = (visuals.text_color(), visuals.weak_text_color());
    let played = playback::played(project, editor.session);
    let (flag, _) = flag(ui, rect, scale, editor.session.playhead);
    let is_played = |frame: i64| (i64::from(*played.start())..=i64::from(*played.end())).contains(&frame);
    if tick as f32 * scale.per_frame() >= 4.0 {
        for frame in scale.multiples(tick) {
            let x = painter.round_to_pixel_center(scale.x(frame as f64));
            painter.vline(x, rect.bottom() - 4.0..=rect.bottom(), Stroke::new(1.0, weak.gamma_multiply(0.5)));
        }
    }
    for frame in scale.multiples(step) {
        let x = painter.round_to_pixel_center(scale.x(frame as f64));
        painter.vline(x, rect.bottom() - 8.0..=rect.bottom(), Stroke::new(1.0, weak));
        let unit = if step as f64 / fps < 0.1 { 100.0 } else { 10.0 };
        // Added to 0, the negative zero of frames just before the first is none.
        let seconds = (unit * (frame - i64::from(first)) as f64 / fps).round() / unit + 0.0;
        let font = FontId::proportional(11.5);
        let dimmed =
            |colour: egui::Color32| if is_played(frame) { colour } else { colour.gamma_multiply(0.4) };
        let number = painter.layout_no_wrap(frame.to_string(), font, dimmed(strong));
        let place = Rect::from_min_size(pos2(x + 4.0, rect.top() + 3.0), number.size());
        // Half a number beside the flag of the playhead would be read as another.
        if !flag.intersects(place) {
            painter.galley(place.min, number, strong);
        }
        let text = if unit > 10.0 { format!("{seconds:.2} s") } else { format!("{seconds:.1} s") };
        painter.text(
            pos2(x + 4.0, rect.top() + 17.0),
            Align2::LEFT_TOP,
            text,
            FontId::proportional(9.5),
            dimmed(weak),
        );
    }
}

/// Shades what is not played, beneath the numbers: that of the last frame stands to the right of its tick.
fn shade(ui: &Ui, rect: Rect, scale: &Scale, editor: &EditorContext) {
    let played = playback::played(editor.document.project(), editor.session);
    let (from, to) = (scale.x(f64::from(*played.start())), scale.x(f64::from(*played.end())));
    let shade = ui.visuals().panel_fill.gamma_multiply(0.7);
    let painter = ui.painter_at(rect);
    painter.rect_filled(
        Rect::from_x_y_ranges(rect.left()..=from.max(rect.left()), rect.y_range()),
        0.0,
        shade,
    );
    painter.rect_filled(
        Rect::from_x_y_ranges(to.min(rect.right())..=rect.right(), rect.y_range()),
        0.0,
        shade,
    );
}

/// The handles of the marks.
fn marks(ui: &mut Ui, rect: Rect, scale: &Scale, editor: &mut EditorContext) {
    for (end, name) in ["In point", "Out point"].into_iter().enumerate() {
        let Some(frame) = editor.session.marks[end] else { continue };
        let x = scale.x(f64::from(frame));
        let grip = Rect::from_center_size(pos2(x, rect.center().y), vec2(12.0, rect.height()));
        if !rect.intersects(grip) {
            continue;
        }
        let response = ui.interact(grip, Id::unique(("mark", end)), Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::slider(true, f64::from(frame), name));
        if response.dragged()
            && let Some(at) = response.interact_pointer_pos()
        {
            editor.session.marks[end] = Some(bounded(scale.frame(at.x), end, editor.session.marks[1 - end]));
        }
        if response.double_clicked() {
            editor.session.marks[end] = None;
        }
        let inwards = if end == 0 { 7.0 } else { -7.0 };
        let painter = ui.painter_at(rect);
        let colour = theme::ACCENT;
        let (top, bottom) = (rect.top() + 1.0, rect.bottom() - 1.0);
        let bracket = vec![pos2(x + inwards, top), pos2(x, top), pos2(x, bottom), pos2(x + inwards, bottom)];
        painter.add(Shape::line(bracket, Stroke::new(2.0, colour)));
        response
            .on_hover_cursor(CursorIcon::ResizeHorizontal)
            .on_hover_text(format!("{name} at frame {frame}. Drag to move it, double click to remove it."));
    }
}

/// Sets a mark; marks do not cross.
fn bounded(frame: i32, end: usize, other: Option<i32>) -> i32 {
    match (end, other) {
        (0, Some(to)) => frame.min(to),
        (1, Some(from)) => frame.max(from),
        _ => frame,
    }
}

/// Paints the playhead over all lanes, with its frame number.
pub(super) fn playhead(ui: &Ui, area: Rect, scale: &Scale, frame: i32) {
    let painter = ui.painter_at(area);
    let (flag, text) = flag(ui, area, scale, frame);
    painter.vline(flag.center().x, area.y_range(), Stroke::new(1.5, theme::ACCENT));
    painter.rect_filled(flag, 4.0, theme::ACCENT);
    painter.galley(flag.center() - text.size() / 2.0, text, egui::Color32::WHITE);
}

/// The playhead's flag at the top of an area, and the number in it.
fn flag(ui: &Ui, area: Rect, scale: &Scale, frame: i32) -> (Rect, Arc<Galley>) {
    let painter = ui.painter_at(area);
    let x = painter.round_to_pixel_center(scale.x(f64::from(frame)));
    let text = painter.layout_no_wrap(frame.to_string(), FontId::proportional(11.5), egui::Color32::WHITE);
    let half = (text.size().x / 2.0 + 5.0).max(11.0);
    (Rect::from_min_max(pos2(x - half, area.top()), pos2(x + half, area.top() + 17.0)), text)
}
