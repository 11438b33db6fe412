//! The temporary shapes of the active tool.

use egui::{Color32, Stroke, StrokeKind};
use glam::Vec2;

use super::{ConstraintStyle, Overlay};
use crate::editor::theme;
use crate::editor::tools::Ghost;

impl Overlay<'_> {
    /// Draws the temporary shapes of the active tool.
    pub(super) fn ghosts(&self, ghosts: &[Ghost]) {
        for ghost in ghosts {
            match ghost {
                Ghost::Line(points) if points.len() > 1 => self.line(points, ConstraintStyle::DRAWING),
                Ghost::Wall(points, thickness) if points.len() > 1 => {
                    self.wall(points, *thickness, ConstraintStyle::DRAWING);
                }
                Ghost::Line(_) | Ghost::Wall(..) | Ghost::Hover(_) => (),
                Ghost::Box(a, b) => self.selection_box(*a, *b),
                Ghost::Snap(at) => self.snap(*at),
                Ghost::Pin(at) => self.dot(*at, 3.5, Color32::WHITE),
                Ghost::Eraser(at, radius) => self.eraser(*at, *radius),
                Ghost::Frame(corners, knob) => self.frame(*corners, *knob),
            }
        }
    }

    fn selection_box(&self, a: Vec2, b: Vec2) {
        let Some((a, b)) = (self.screen)(a).zip((self.screen)(b)) else { return };
        let rect = egui::Rect::from_two_pos(a, b);
        let border = Stroke::new(1.0, theme::ACCENT);
        self.painter.rect(rect, 0.0, theme::ACCENT.gamma_multiply(0.15), border, StrokeKind::Inside);
    }

    fn snap(&self, at: Vec2) {
        let Some(at) = (self.screen)(at) else { return };
        self.painter.circle_stroke(at, 7.0, Stroke::new(3.0, Color32::from_black_alpha(140)));
        self.painter.circle_stroke(at, 7.0, Stroke::new(1.5, theme::ACCENT));
    }

    fn dot(&self, at: Vec2, radius: f32, colour: Color32) {
        if let Some(at) = (self.screen)(at) {
            self.painter.circle(at, radius, colour, Stroke::new(1.2, theme::ACCENT));
        }
    }

    fn eraser(&self, at: Vec2, radius: f32) {
        let (Some(place), Some(scale)) = ((self.screen)(at), self.scale(at)) else { return };
        let radius = radius * scale;
        self.painter.circle_filled(place, radius, Color32::from_white_alpha(24));
        self.painter.circle_stroke(place, radius, Stroke::new(3.0, Color32::from_black_alpha(140)));
        self.painter.circle_stroke(place, radius, Stroke::new(1.5, Color32::WHITE));
    }
}
