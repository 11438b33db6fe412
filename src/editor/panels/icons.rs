//! Vector icons of the panels, sharp at every scale.

use std::f32::consts::PI;

use egui::{Color32, Painter, Pos2, Rect, Response, Role, Sense, Shape, Stroke, Ui, WidgetInfo, pos2, vec2};

/// An icon.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Icon {
    Add,
    Remove,
    Up,
    Down,
    /// A list opens below.
    List,
    Eye,
    EyeShut,
    Lock,
    LockOpen,
}

/// Side of a button, points.
pub(super) const SIDE: f32 = 22.0;

/// A button with an icon; `name` is its tooltip and accessible name. `strong` where it is on.
pub(super) fn button(ui: &mut Ui, icon: Icon, name: &str, strong: bool) -> Response {
    let (rect, response) = ui.allocate_exact_size(vec2(SIDE, SIDE), Sense::click());
    paint_button(ui, rect, &response, icon, strong);
    named(ui, response, name)
}

/// As [`button`], in a given rectangle.
pub(super) fn button_at(ui: &mut Ui, rect: Rect, icon: Icon, name: &str, strong: bool) -> Response {
    let response = ui.interact(rect, ui.scope_id().with(name), Sense::click());
    paint_button(ui, rect, &response, icon, strong);
    named(ui, response, name)
}

fn named(ui: &Ui, response: Response, name: &str) -> Response {
    response.widget_info(|| WidgetInfo::labeled(Role::Button, ui.is_enabled(), name));
    response.on_hover_text(name)
}

fn paint_button(ui: &Ui, rect: Rect, response: &Response, icon: Icon, strong: bool) {
    let visuals = ui.style().interact(response);
    if ui.is_enabled() && (response.hovered() || response.has_focus()) {
        ui.painter().rect_filled(rect, visuals.corner_radius, visuals.weak_bg_fill);
    }
    let colour =
        if strong && ui.is_enabled() { visuals.fg_stroke.color } else { ui.visuals().weak_text_color() };
    paint(ui.painter(), icon, rect.center(), colour);
}

fn paint(painter: &Painter, icon: Icon, at: Pos2, colour: Color32) {
    let stroke = Stroke::new(1.4, colour);
    let line = |a: [f32; 2], b: [f32; 2]| {
        painter.line_segment([pos2(at.x + a[0], at.y + a[1]), pos2(at.x + b[0], at.y + b[1])], stroke);
    };
    match icon {
        Icon::Add => {
            line([-4.5, 0.0], [4.5, 0.0]);
            line([0.0, -4.5], [0.0, 4.5]);
        }
        Icon::Remove => {
            line([-4.0, -4.0], [4.0, 4.0]);
            line([-4.0, 4.0], [4.0, -4.0]);
        }
        Icon::Up => {
            line([0.0, -5.0], [0.0, 5.0]);
            line([-4.0, -1.0], [0.0, -5.0]);
            line([4.0, -1.0], [0.0, -5.0]);
        }
        Icon::Down => {
            line([0.0, -5.0], [0.0, 5.0]);
            line([-4.0, 1.0], [0.0, 5.0]);
            line([4.0, 1.0], [0.0, 5.0]);
        }
        Icon::List => {
            line([-4.0, -2.0], [0.0, 2.5]);
            line([4.0, -2.0], [0.0, 2.5]);
        }
        Icon::Eye => {
            lid(painter, at, -1.0, stroke);
            lid(painter, at, 1.0, stroke);
            painter.circle_filled(at, 2.0, colour);
        }
        Icon::EyeShut => {
            lid(painter, at, 1.0, stroke);
            line([-3.5, 3.2], [-5.0, 5.2]);
            line([0.0, 4.4], [0.0, 6.6]);
            line([3.5, 3.2], [5.0, 5.2]);
        }
        Icon::Lock | Icon::LockOpen => padlock(painter, at, icon == Icon::LockOpen, colour),
    }
}

/// Half the outline of an eye: its upper lid for -1, its lower for 1.
fn lid(painter: &Painter, at: Pos2, side: f32, stroke: Stroke) {
    let point = |i: u8| {
        let x = f32::from(i) / 6.0 - 1.0;
        pos2(at.x + 7.0 * x, at.y + side * 4.4 * (1.0 - x * x))
    };
    painter.add(Shape::line((0..=12).map(point).collect(), stroke));
}

fn padlock(painter: &Painter, at: Pos2, open: bool, colour: Color32) {
    let body = Rect::from_center_size(at + vec2(0.0, 2.5), vec2(10.0, 7.0));
    painter.rect_filled(body, 1.5, colour);
    // An open one is turned to the side.
    let middle = at + vec2(if open { 4.5 } else { 0.0 }, -2.0);
    let point = |i: u8| {
        let angle = PI * f32::from(i) / 8.0;
        pos2(middle.x - 3.2 * angle.cos(), middle.y - 3.2 * angle.sin())
    };
    let mut shackle: Vec<Pos2> = (0..=8).map(point).collect();
    shackle.insert(0, pos2(middle.x - 3.2, at.y - 0.5));
    if !open {
        shackle.push(pos2(middle.x + 3.2, at.y - 0.5));
    }
    painter.add(Shape::line(shackle, Stroke::new(1.5, colour)));
}
