//! The tool that follows one photon.

use egui::{Key, Painter, Rect, Stroke};
use glam::Vec2;

use super::icon;
use super::tool::{Gesture, Tool, ToolContext, ToolInfo};
use crate::editor::action::Action;

/// Maximum distance of the photon from the pointer, screen points.
const REACH: f32 = 40.0;

/// The probe: follows the photon nearest to a click.
#[derive(Default)]
pub(super) struct Probe {
    down: bool,
}

impl Tool for Probe {
    fn info(&self) -> ToolInfo {
        ToolInfo {
            name: "Probe",
            key: Key::P,
            hint: "Click light to follow its photon: its path, its target, the way around walls. Esc ends",
        }
    }

    fn icon(&self, painter: &Painter, square: Rect, stroke: Stroke) {
        icon::circle(painter, square, stroke, [0.5, 0.5], 0.28);
        let lines: &[&[[f32; 2]]] = &[
            &[[0.5, 0.04], [0.5, 0.34]],
            &[[0.5, 0.66], [0.5, 0.96]],
            &[[0.04, 0.5], [0.34, 0.5]],
            &[[0.66, 0.5], [0.96, 0.5]],
        ];
        icon::lines(painter, square, stroke, lines);
    }

    fn gesture(&mut self, gesture: Gesture, context: &ToolContext) -> Vec<Action> {
        match gesture {
            Gesture::Press(p) => {
                self.down = true;
                vec![Action::Probe(nearest(p, context))]
            }
            Gesture::Drag(p) if self.down => vec![Action::Probe(nearest(p, context))],
            Gesture::Key(Key::Escape) => vec![Action::Probe(None)],
            Gesture::Release(_) => {
                self.down = false;
                Vec::new()
            }
            _ => Vec::new(),
        }
    }

    fn put_down(&mut self) {
        self.down = false;
    }
}

fn nearest(p: Vec2, context: &ToolContext) -> Option<usize> {
    let distances = context.photons.iter().enumerate().map(|(row, photon)| (row, photon.distance_squared(p)));
    let nearest = distances.min_by(|a, b| a.1.total_cmp(&b.1));
    nearest.filter(|(_, squared)| squared.sqrt() <= context.points(REACH)).map(|(row, _)| row)
}
