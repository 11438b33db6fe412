//! Vector icons of the timeline.

use egui::{
    Color32, Painter, Pos2, Rect, Response, Role, Sense, Shape, Stroke, Ui, Vec2, WidgetInfo, pos2, vec2,
};
use lightloom_core::project::Ease;

/// An icon.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::editor) enum Icon {
    First,
    PreviousKey,
    Back,
    Play,
    Pause,
    Forward,
    NextKey,
    Last,
    Loop,
    AddKey,
    Fit,
}

/// A button with an icon; `label` is its accessible name.
pub(in crate::editor) fn button(ui: &mut Ui, icon: Icon, label: &str, on: bool) -> Response {
    let (rect, response) = ui.allocate_exact_size(vec2(28.0, 24.0), Sense::click());
    response.widget_info(|| WidgetInfo::selected(Role::Button, ui.is_enabled(), on, label));
    let visuals = ui.style().interact_selectable(&response, on);
    if on || response.hovered() || response.has_focus() {
        ui.painter().rect_filled(rect, visuals.corner_radius, visuals.weak_bg_fill);
    }
    paint(ui.painter(), icon, rect.center(), visuals.fg_stroke.color);
    response
}

fn paint(painter: &Painter, icon: Icon, at: Pos2, colour: Color32) {
    let triangle = |x: f32, direction: f32| {
        let tip = pos2(at.x + x + 4.5 * direction, at.y);
        let base = at.x + x - 4.5 * direction;
        let corners = vec![tip, pos2(base, at.y - 6.0), pos2(base, at.y + 6.0)];
        painter.add(Shape::convex_polygon(corners, colour, Stroke::NONE));
    };
    let bar = |x: f32| {
        painter.rect_filled(Rect::from_center_size(at + vec2(x, 0.0), vec2(2.0, 12.0)), 0.5, colour);
    };
    match icon {
        Icon::First => {
            bar(-5.0);
            triangle(1.5, -1.0);
        }
        Icon::Last => {
            bar(5.0);
            triangle(-1.5, 1.0);
        }
        Icon::Back => {
            triangle(-2.0, -1.0);
            bar(4.5);
        }
        Icon::Forward => {
            triangle(2.0, 1.0);
            bar(-4.5);
        }
        Icon::Play => triangle(0.5, 1.25),
        Icon::Pause => {
            for x in [-3.5, 3.5] {
                painter.rect_filled(Rect::from_center_size(at + vec2(x, 0.0), vec2(3.5, 12.0)), 0.5, colour);
            }
        }
        Icon::PreviousKey => {
            triangle(-4.5, -1.0);
            diamond(painter, at + vec2(5.0, 0.0), 4.0, colour, Stroke::NONE);
        }
        Icon::NextKey => {
            triangle(4.5, 1.0);
            diamond(painter, at - vec2(5.0, 0.0), 4.0, colour, Stroke::NONE);
        }
        Icon::Loop => repeat(painter, at, colour),
        Icon::AddKey => {
            diamond(painter, at - vec2(3.0, 0.0), 5.5, Color32::TRANSPARENT, Stroke::new(1.4, colour));
            let plus = at + vec2(6.5, -4.0);
            painter.hline(plus.x - 3.0..=plus.x + 3.0, plus.y, Stroke::new(1.4, colour));
            painter.vline(plus.x, plus.y - 3.0..=plus.y + 3.0, Stroke::new(1.4, colour));
        }
        Icon::Fit => {
            let stroke = Stroke::new(1.4, colour);
            for side in [-1.0, 1.0] {
                painter.vline(at.x + 8.0 * side, at.y - 5.0..=at.y + 5.0, stroke);
                painter.arrow(at + vec2(1.5 * side, 0.0), vec2(5.0 * side, 0.0), stroke);
            }
        }
    }
}

/// Two arrows around.
fn repeat(painter: &Painter, at: Pos2, colour: Color32) {
    let stroke = Stroke::new(1.5, colour);
    for side in [-1.0_f32, 1.0] {
        let arc = |i: u8| {
            let angle =
                f32::from(i) / 10.0 * 2.4 + if side > 0.0 { 0.35 } else { 0.35 + std::f32::consts::PI };
            at + 6.0 * Vec2::angled(angle)
        };
        let points: Vec<Pos2> = (0..=10).map(arc).collect();
        let (end, before) = (points[10], points[8]);
        painter.line(points, stroke);
        let along = (end - before).normalized();
        let across = along.rot90();
        let head = vec![end + 3.0 * along, end + 3.0 * across - along, end - 3.0 * across - along];
        painter.add(Shape::convex_polygon(head, colour, Stroke::NONE));
    }
}

/// The diamond of a key frame.
pub(super) fn diamond(painter: &Painter, at: Pos2, radius: f32, fill: Color32, stroke: Stroke) {
    let corners = [vec2(radius, 0.0), vec2(0.0, radius), vec2(-radius, 0.0), vec2(0.0, -radius)];
    painter.add(Shape::convex_polygon(corners.map(|c| at + c).to_vec(), fill, stroke));
}

/// The curve of an ease in a square.
pub(super) fn ease(painter: &Painter, ease: Ease, square: Rect, stroke: Stroke) {
    let square = square.shrink(2.0);
    let point = |i: u8| {
        let x = f32::from(i) / 12.0;
        let y = ease.apply(f64::from(x)) as f32;
        pos2(square.left() + x * square.width(), square.bottom() - y * square.height())
    };
    painter.line((0..=12).map(point).collect(), stroke);
}

/// The icon of the physical caustic: rays through a lens.
pub(super) fn physical(painter: &Painter, rect: Rect, colour: Color32) {
    let (centre, unit) = (rect.center(), rect.height() / 2.0);
    let stroke = Stroke::new(1.2, colour);
    let lens: Vec<Pos2> = (0..=24)
        .map(|i| {
            let angle = i as f32 / 24.0 * std::f32::consts::TAU;
            centre + vec2(0.22 * angle.cos(), 0.72 * angle.sin()) * unit - vec2(0.3, 0.0) * unit
        })
        .collect();
    painter.line(lens, stroke);
    for height in [-0.45, 0.0, 0.45] {
        let entry = centre + vec2(-0.3, height) * unit;
        painter.line_segment(
            [entry - vec2(0.75, 0.0) * unit, entry],
            Stroke::new(1.2, colour.gamma_multiply(0.6)),
        );
        painter.line_segment([entry, centre + vec2(0.85, 0.0) * unit], stroke);
    }
    painter.circle_filled(centre + vec2(0.85, 0.0) * unit, 1.8, colour);
}
