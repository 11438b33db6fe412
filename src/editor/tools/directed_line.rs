//! The tool that draws directed lines.

use egui::{Key, Painter, Rect, Stroke};
use lightloom_core::constraint::{Constraint, DirectedLine};

use super::icon;
use super::pen::{Pen, add};
use super::tool::{Gesture, Ghost, Tool, ToolContext, ToolInfo};
use crate::editor::action::Action;

/// The tool that draws directed lines.
#[derive(Default)]
pub(super) struct DrawLine {
    pen: Pen,
}

impl Tool for DrawLine {
    fn info(&self) -> ToolInfo {
        ToolInfo {
            name: "Directed line",
            key: Key::D,
            hint: "Drag to draw freehand, or click point by point: Enter finishes, Backspace removes a point, Esc cancels, Shift draws straight",
        }
    }

    fn icon(&self, painter: &Painter, square: Rect, stroke: Stroke) {
        icon::curve(painter, square, stroke, [[0.06, 0.86], [0.42, 0.92], [0.3, 0.3], [0.78, 0.22]]);
        icon::filled(painter, square, stroke, [[0.97, 0.17], [0.7, 0.02], [0.74, 0.42]].as_slice());
    }

    fn gesture(&mut self, gesture: Gesture, context: &ToolContext) -> Vec<Action> {
        let Some(points) = self.pen.gesture(gesture, context) else { return Vec::new() };
        let points = points.into_iter().map(Into::into).collect();
        add(Constraint::DirectedLine(DirectedLine::new(points)), context)
    }

    fn ghosts(&self, _look: &ToolContext) -> Vec<Ghost> {
        std::iter::once(Ghost::Line(self.pen.points())).chain(self.pen.marks()).collect()
    }

    fn put_down(&mut self) {
        self.pen.clear();
    }

    fn is_busy(&self) -> bool {
        self.pen.is_busy()
    }
}
