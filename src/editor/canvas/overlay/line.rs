//! Directed lines: orange, with arrow heads and a faint band of influence.

use egui::{Color32, Pos2, Shape, Stroke};
use glam::Vec2;
use lightloom_core::constraint::stroke;

use super::{ConstraintStyle, Overlay};
use crate::editor::theme;

/// Width of the line, points.
const WIDTH: f32 = 2.2;
/// Width of the dark outline, points: it separates the line from bright light.
const RIM: f32 = 5.0;
/// Distance between two arrow heads, points.
const BETWEEN: f32 = 76.0;
/// Length and half width of an arrow head, points.
const HEAD: [f32; 2] = [12.0, 5.0];
/// Positions across the band, relative to its width.
const ACROSS: [f32; 7] = [-1.0, -0.66, -0.33, 0.0, 0.33, 0.66, 1.0];
/// Opacity of the band at its maximum.
const BAND: f32 = 0.2;

impl Overlay<'_> {
    /// The band of influence of a line: its opacity is the weight in the fit.
    pub(super) fn influence(&self, points: &[Vec2], width: f32, style: ConstraintStyle) {
        if style.off || points.len() < 2 {
            return;
        }
        let strength = BAND * if style.selected || style.hovered { 1.6 } else { 1.0 };
        let colour = |x: f32| {
            let pull = (1.0 - x * x) * (1.0 - x * x);
            style.tint(theme::LINE.gamma_multiply(strength * pull))
        };
        // Details far smaller than the band would only fold its borders.
        let smooth = stroke::simplify(points, 0.05 * width);
        self.band(&smooth, &ACROSS.map(|x| (x * width, colour(x))));
    }

    /// The line itself.
    pub(super) fn line(&self, points: &[Vec2], style: ConstraintStyle) {
        if style.selected {
            self.polyline(points, Stroke::new(WIDTH + 6.0, theme::ACCENT.gamma_multiply(0.6)), false);
        } else if style.hovered {
            self.polyline(points, Stroke::new(WIDTH + 5.0, Color32::from_white_alpha(110)), false);
        }
        self.polyline(points, Stroke::new(RIM, style.tint(Color32::from_black_alpha(130))), style.off);
        let colour = style.tint(theme::LINE);
        self.polyline(points, Stroke::new(WIDTH, colour), style.off);
        self.heads(points, colour);
    }

    fn heads(&self, points: &[Vec2], colour: Color32) {
        let Some(scale) = points.get(points.len() / 2).and_then(|&p| self.scale(p)) else { return };
        let total = stroke::length(points) * scale;
        if !(total.is_finite() && total > 1.0) {
            return;
        }
        let count = (total / BETWEEN).round().clamp(1.0, 500.0);
        let places = stroke::resample(points, stroke::length(points) / count, 501);
        for &(p, direction) in places.iter().skip(1) {
            let ahead = direction * (4.0 / scale);
            let Some((back, tip)) = (self.screen)(p - ahead).zip((self.screen)(p)) else { continue };
            self.head(tip, (tip - back).normalized(), colour);
        }
    }

    /// An arrow head with its tip at a screen position.
    fn head(&self, tip: Pos2, along: egui::Vec2, colour: Color32) {
        let tip = tip + along * (0.25 * HEAD[0]);
        let (back, side) = (tip - along * HEAD[0], along.rot90() * HEAD[1]);
        let corners = vec![tip, back + side, back + along * 2.5, back - side];
        let rim =
            Stroke::new(1.2, Color32::from_black_alpha(150).gamma_multiply(f32::from(colour.a()) / 255.0));
        // Two triangles: the notched head is not convex.
        for half in [[0, 1, 2], [0, 2, 3]] {
            let half = half.map(|i| corners[i]).to_vec();
            self.painter.add(Shape::convex_polygon(half, colour, Stroke::NONE));
        }
        self.painter.add(Shape::closed_line(corners, rim));
    }
}
