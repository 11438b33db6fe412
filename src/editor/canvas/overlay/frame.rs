//! The target picture over the plane, and its frame.

use egui::{Color32, Mesh, Pos2, Shape, Stroke, TextureId, epaint::Vertex, pos2};
use glam::{Vec2, vec2};

use super::Overlay;
use crate::editor::theme;

/// Opacity of the outline.
const OPACITY: f32 = 0.6;
/// Subdivisions along each side, for perspective views.
const PIECES: u32 = 12;
/// Radius of a handle, points.
const HANDLE: f32 = 5.0;

impl Overlay<'_> {
    /// The picture's outline between its corners: lower left, lower right, upper right, upper left.
    pub(super) fn target(&self, texture: TextureId, corners: [Vec2; 4]) {
        let [origin, right, _, up] = corners;
        let tint = theme::TARGET.gamma_multiply(OPACITY);
        let mut mesh = Mesh::with_texture(texture);
        for (y, x) in (0..=PIECES).flat_map(|y| (0..=PIECES).map(move |x| (y, x))) {
            let share = vec2(x as f32, y as f32) / PIECES as f32;
            let p = origin + (right - origin) * share.x + (up - origin) * share.y;
            let Some(pos) = (self.screen)(p) else { return };
            mesh.vertices.push(Vertex { pos, uv: pos2(share.x, 1.0 - share.y), color: tint });
        }
        for (y, x) in (0..PIECES).flat_map(|y| (0..PIECES).map(move |x| (y, x))) {
            let (at, row) = (y * (PIECES + 1) + x, PIECES + 1);
            mesh.add_triangle(at, at + 1, at + row);
            mesh.add_triangle(at + 1, at + row + 1, at + row);
        }
        self.painter.add(mesh);
        self.outline(corners, Stroke::new(1.0, theme::TARGET.gamma_multiply(0.6)), true);
    }

    /// The frame of a picture, with its rotation handle.
    pub(super) fn frame(&self, corners: [Vec2; 4], knob: Vec2) {
        self.outline(corners, Stroke::new(3.0, Color32::from_black_alpha(120)), false);
        self.outline(corners, Stroke::new(1.4, theme::TARGET), false);
        self.polyline(&[corners[2].midpoint(corners[3]), knob], Stroke::new(1.4, theme::TARGET), false);
        for corner in corners.into_iter().filter_map(|p| (self.screen)(p)) {
            let square = egui::Rect::from_center_size(corner, egui::Vec2::splat(1.8 * HANDLE));
            let border = Stroke::new(1.4, theme::TARGET);
            self.painter.rect(square, 1.0, Color32::WHITE, border, egui::StrokeKind::Outside);
        }
        if let Some(knob) = (self.screen)(knob) {
            self.painter.circle(knob, HANDLE, Color32::WHITE, Stroke::new(1.4, theme::TARGET));
        }
    }

    fn outline(&self, corners: [Vec2; 4], stroke: Stroke, dashed: bool) {
        let seen: Option<Vec<Pos2>> = corners.iter().map(|&p| (self.screen)(p)).collect();
        let Some(mut seen) = seen else { return };
        if dashed {
            seen.push(seen[0]);
            self.painter.extend(Shape::dashed_line(&seen, stroke, 4.0, 4.0));
        } else {
            self.painter.add(Shape::closed_line(seen, stroke));
        }
    }
}
