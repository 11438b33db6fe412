//! The wipe: this flow on the left of a handle, another way to move the light on its right.

use egui::{Align2, Color32, CursorIcon, FontId, Rect, Sense, Ui, WidgetInfo, pos2};
use lightloom_core::flow::Movement;

use crate::editor::session::{Other, Wipe};
use crate::editor::theme;

/// Width of the place where the handle is caught, points.
const CATCH: f32 = 12.0;

/// The two sides of a view.
pub(super) fn sides(view: Rect, wipe: Option<Wipe>) -> [Option<Rect>; 2] {
    let Some(wipe) = wipe else { return [Some(view), None] };
    let middle = view.left() + view.width() * wipe.split;
    [Some(view.with_max_x(middle)), Some(view.with_min_x(middle))]
}

/// The handle, which moves the wipe, and the names of both sides.
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
    let names = [("This flow", Align2::RIGHT_BOTTOM, -10.0), (name(wipe.with), Align2::LEFT_BOTTOM, 10.0)];
    for (text, align, x) in names {
        let at = pos2(middle + x, view.bottom() - 10.0);
        let rect = painter.text(at, align, text, FontId::proportional(13.0), Color32::TRANSPARENT);
        painter.rect_filled(rect.expand(4.0), 3.0, Color32::from_black_alpha(150));
        painter.text(at, align, text, FontId::proportional(13.0), Color32::WHITE);
    }
}

/// What something is called that a flow is compared with.
fn name(other: Other) -> &'static str {
    match other {
        Other::Method(Movement::Flow) => "The flow",
        Other::Method(Movement::Stylized) => "Method of 2016",
        Other::Method(Movement::Linear) => "Straight lines",
        Other::NothingDrawn => "Nothing drawn",
    }
}
