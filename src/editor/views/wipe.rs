//! The wipe: this flow left of a handle, its comparison on the right.

use egui::{
    Align2, Color32, ComboBox, CursorIcon, FontId, Rect, Sense, Ui, UiBuilder, WidgetInfo, pos2, vec2,
};
use lightloom_core::flow::MotionMethod;

use crate::editor::session::{Comparison, Wipe};
use crate::editor::theme;

/// Hit width of the handle, points.
const CATCH: f32 = 12.0;

/// The rectangles of the two sides of a view.
pub(super) fn sides(view: Rect, wipe: Option<Wipe>) -> [Option<Rect>; 2] {
    let Some(wipe) = wipe else { return [Some(view), None] };
    let middle = view.left() + view.width() * wipe.split;
    [Some(view.with_max_x(middle)), Some(view.with_min_x(middle))]
}

/// Shows the handle and the names of both sides.
pub(super) fn handle(ui: &mut Ui, view: Rect, wipe: &mut Wipe) {
    let middle = view.left() + view.width() * wipe.split;
    let place = Rect::from_x_y_ranges(middle - CATCH / 2.0..=middle + CATCH / 2.0, view.y_range());
    let response = ui.interact(place, ui.scope_id().with("wipe"), Sense::drag());
    response.widget_info(|| WidgetInfo::slider(true, f64::from(wipe.split), "Wipe"));
    let response = response.on_hover_and_drag_cursor(CursorIcon::ResizeHorizontal);
    if let Some(at) = response.interact_pointer_pos() {
        wipe.split = ((at.x - view.left()) / view.width().max(1.0)).clamp(0.0, 1.0);
    }
    let painter = ui.painter_at(view);
    let width = if response.hovered() || response.dragged() { 2.5 } else { 1.5 };
    painter.vline(middle, view.y_range(), (width, Color32::WHITE));
    let knob = pos2(middle, view.center().y);
    painter.circle(knob, 9.0, theme::ACCENT, (1.5, Color32::WHITE));
    for side in [-1.0, 1.0] {
        let tip = |x: f32, y: f32| pos2(knob.x + side * x, knob.y + y);
        painter.line(vec![tip(2.5, -3.0), tip(5.5, 0.0), tip(2.5, 3.0)], (1.5, Color32::WHITE));
    }
    let at = pos2(middle - 10.0, view.bottom() - 14.0);
    let text =
        |colour| painter.text(at, Align2::RIGHT_BOTTOM, "This flow", FontId::proportional(13.0), colour);
    painter.rect_filled(text(Color32::TRANSPARENT).expand(4.0), 3.0, Color32::from_black_alpha(150));
    text(Color32::WHITE);
    choice(ui, Rect::from_min_size(pos2(middle + 8.0, view.bottom() - 34.0), vec2(150.0, 24.0)), wipe);
}

/// Shows the choice of the comparison.
fn choice(ui: &mut Ui, place: Rect, wipe: &mut Wipe) {
    let mut ui = ui.new_child(UiBuilder::new().id_salt("compared").max_rect(place));
    let box_ = ComboBox::from_id_salt("compared with").selected_text(name(wipe.with)).width(place.width());
    let response = box_.show_ui(&mut ui, |ui| {
        for with in COMPARISONS {
            ui.selectable_value(&mut wipe.with, with, name(with));
        }
    });
    response.response.on_hover_text("Comparison for this flow");
}

/// All comparisons.
const COMPARISONS: [Comparison; 4] = [
    Comparison::Method(MotionMethod::Linear),
    Comparison::Method(MotionMethod::Guided),
    Comparison::Method(MotionMethod::Stylized),
    Comparison::NothingDrawn,
];

/// The name of a comparison.
fn name(comparison: Comparison) -> &'static str {
    match comparison {
        Comparison::Method(MotionMethod::Flow) => "The flow",
        Comparison::Method(MotionMethod::Guided) => "Guided photons",
        Comparison::Method(MotionMethod::Stylized) => "Method of 2016",
        Comparison::Method(MotionMethod::Linear) => "Straight lines",
        Comparison::NothingDrawn => "No constraints",
    }
}
