//! The tool that draws walls.

use egui::{Key, Painter, Rect, Stroke};
use lightloom_core::constraint::{Constraint, Wall};

use super::icon;
use super::pen::{Pen, add};
use super::tool::{Gesture, Ghost, Tool, ToolContext, ToolInfo};
use crate::editor::action::Action;

/// The tool that draws walls.
pub(super) struct DrawWall {
    pen: Pen,
}

impl Default for DrawWall {
    fn default() -> Self {
        Self { pen: Pen::closing() }
    }
}

impl Tool for DrawWall {
    fn info(&self) -> ToolInfo {
        ToolInfo {
            name: "Wall",
            key: Key::W,
            hint: "Drag to draw freehand, or click point by point; at the first point the wall closes. Enter finishes, Esc cancels",
        }
    }

    fn icon(&self, painter: &Painter, square: Rect, stroke: Stroke) {
        let lines: &[&[[f32; 2]]] = &[
            &[[0.08, 0.18], [0.92, 0.18], [0.92, 0.82], [0.08, 0.82], [0.08, 0.15]],
            &[[0.08, 0.5], [0.92, 0.5]],
            &[[0.56, 0.18], [0.56, 0.5]],
            &[[0.36, 0.5], [0.36, 0.82]],
        ];
        icon::lines(painter, square, stroke, lines);
    }

    fn gesture(&mut self, gesture: Gesture, context: &ToolContext) -> Vec<Action> {
        let Some(points) = self.pen.gesture(gesture, context) else { return Vec::new() };
        let points = points.into_iter().map(Into::into).collect();
        add(Constraint::Wall(Wall::new(points)), context)
    }

    fn ghosts(&self, _look: &ToolContext) -> Vec<Ghost> {
        let thickness = Wall::new(Vec::new()).thickness;
        std::iter::once(Ghost::Wall(self.pen.points(), thickness)).chain(self.pen.marks()).collect()
    }

    fn put_down(&mut self) {
        self.pen.clear();
    }

    fn is_busy(&self) -> bool {
        self.pen.is_busy()
    }
}
