//! The zoom tool.

use egui::{CursorIcon, Key, Painter, Rect, Stroke};

use super::icon;
use super::tool::{PointerMode, Tool, ToolInfo};

/// The zoom tool; the wheel zooms with any tool.
pub(super) struct Zoom;

impl Tool for Zoom {
    fn info(&self) -> ToolInfo {
        ToolInfo {
            name: "Zoom",
            key: Key::Z,
            hint: "Click to zoom in, with Shift or Alt to zoom out, or drag; the wheel zooms with any tool",
        }
    }

    fn icon(&self, painter: &Painter, square: Rect, stroke: Stroke) {
        icon::circle(painter, square, stroke, [0.42, 0.42], 0.32);
        let lines: &[&[[f32; 2]]] =
            &[&[[0.66, 0.66], [0.93, 0.93]], &[[0.42, 0.28], [0.42, 0.56]], &[[0.28, 0.42], [0.56, 0.42]]];
        icon::lines(painter, square, stroke, lines);
    }

    fn cursor(&self) -> CursorIcon {
        CursorIcon::ZoomIn
    }

    fn pointer_mode(&self) -> PointerMode {
        PointerMode::Zoom
    }
}
