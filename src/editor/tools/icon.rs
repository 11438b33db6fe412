//! Icons of the tools: strokes in the unit square, y down.

use egui::{Painter, Pos2, Rect, Shape, Stroke, lerp, pos2};

/// Screen position of a point of the unit square.
pub(super) fn at(square: Rect, [x, y]: [f32; 2]) -> Pos2 {
    pos2(lerp(square.x_range(), x), lerp(square.y_range(), y))
}

/// Draws polylines.
pub(super) fn lines(painter: &Painter, square: Rect, stroke: Stroke, lines: &[&[[f32; 2]]]) {
    for line in lines {
        painter.line(line.iter().map(|&p| at(square, p)).collect(), stroke);
    }
}

/// Draws a filled, convex polygon.
pub(super) fn filled(painter: &Painter, square: Rect, stroke: Stroke, corners: &[[f32; 2]]) {
    let corners = corners.iter().map(|&p| at(square, p)).collect();
    painter.add(Shape::convex_polygon(corners, stroke.color, Stroke::new(0.5, stroke.color)));
}

/// Draws a circle with its centre and radius in the unit square.
pub(super) fn circle(painter: &Painter, square: Rect, stroke: Stroke, centre: [f32; 2], radius: f32) {
    painter.circle_stroke(at(square, centre), radius * square.width(), stroke);
}

/// Draws a smooth curve through four points of a cubic Bézier curve.
pub(super) fn curve(painter: &Painter, square: Rect, stroke: Stroke, control: [[f32; 2]; 4]) {
    let points = (0..=16).map(|i| {
        let (t, s) = (i as f32 / 16.0, 1.0 - i as f32 / 16.0);
        let weights = [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t];
        let sum = |axis: usize| weights.iter().zip(&control).map(|(w, p)| w * p[axis]).sum();
        at(square, [sum(0), sum(1)])
    });
    painter.line(points.collect(), stroke);
}
