//! Walls: magenta bands of their true thickness with a brick pattern. Where they are too thin on the screen, a
//! line with ticks across is drawn instead.

use egui::{Color32, Stroke};
use glam::Vec2;
use lightloom_core::constraint::stroke;

use super::{ConstraintStyle, Overlay, band};
use crate::editor::theme;

/// Fill of the band: dark enough to stand out from bright light.
const FILL: Color32 = Color32::from_rgba_unmultiplied_const(96, 14, 82, 190);
/// Minimum thickness on the screen for bricks, points.
const BRICKS: f32 = 7.0;
/// Length of a brick over the wall's thickness.
const BRICK: f32 = 1.4;
/// Distance between two ticks of a thin wall, and their half length, points.
const TICKS: [f32; 2] = [9.0, 3.5];
/// Maximum number of bricks and ticks of one wall.
const MOST: usize = 1500;

impl Overlay<'_> {
    /// Draws a wall of a thickness in plane units.
    pub(super) fn wall(&self, points: &[Vec2], thickness: f32, style: ConstraintStyle) {
        let Some(scale) =
            points.get(points.len() / 2).and_then(|&p| self.scale(p)).filter(|_| points.len() > 1)
        else {
            return;
        };
        let colour = style.tint(theme::WALL);
        if thickness * scale < BRICKS {
            self.thin(points, scale, colour, style);
            return;
        }
        // Details far smaller than the wall would only fold its borders.
        let smooth = stroke::simplify(points, 0.02 * thickness);
        let half = 0.5 * thickness;
        let mut outline = band::beside(&smooth, half);
        let mut right = band::beside(&smooth, -half);
        let closed = points[0] == points[points.len() - 1] && points.len() > 3;
        if !closed {
            outline.extend(right.drain(..).rev());
            outline.push(outline[0]);
        }
        if !style.off {
            let fill = style.tint(FILL);
            self.band(&smooth, &[(-half, fill), (half, fill)]);
        }
        for border in [&outline, &right] {
            self.glow(border, 1.6, style);
            self.polyline(border, Stroke::new(1.6, colour), style.off);
        }
        if !style.off {
            self.bricks(&smooth, thickness, colour.gamma_multiply(0.7));
        }
    }

    /// Joints: one along the centre line, and alternating ones across.
    fn bricks(&self, points: &[Vec2], thickness: f32, colour: Color32) {
        let joint = Stroke::new(1.0, colour);
        self.polyline(points, joint, false);
        let joints = stroke::resample(points, 0.5 * BRICK * thickness, MOST);
        for (i, &(p, direction)) in joints.iter().enumerate().skip(1) {
            let side = direction.perp() * (0.5 * thickness) * if i % 2 == 0 { 1.0 } else { -1.0 };
            self.polyline(&[p, p + side], joint, false);
        }
    }

    fn thin(&self, points: &[Vec2], scale: f32, colour: Color32, style: ConstraintStyle) {
        self.glow(points, 3.0, style);
        self.polyline(points, Stroke::new(5.0, style.tint(Color32::from_black_alpha(150))), style.off);
        self.polyline(points, Stroke::new(2.6, colour), style.off);
        for (p, direction) in stroke::resample(points, TICKS[0] / scale, MOST) {
            let side = direction.perp() * (TICKS[1] / scale);
            self.polyline(&[p - side, p + side], Stroke::new(1.4, colour), false);
        }
    }

    fn glow(&self, points: &[Vec2], width: f32, style: ConstraintStyle) {
        if style.selected {
            self.polyline(points, Stroke::new(width + 4.0, theme::ACCENT.gamma_multiply(0.6)), false);
        } else if style.hovered {
            self.polyline(points, Stroke::new(width + 3.5, Color32::from_white_alpha(110)), false);
        }
    }
}
