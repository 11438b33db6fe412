//! The pan tool.

use egui::{CursorIcon, Key, Painter, Rect, Stroke};

use super::icon;
use super::tool::{PointerMode, Tool, ToolInfo};

/// The pan tool; the middle button and Space pan with any tool.
pub(super) struct Pan;

impl Tool for Pan {
    fn info(&self) -> ToolInfo {
        ToolInfo {
            name: "Pan",
            key: Key::H,
            hint: "Drag to move the view; the middle button, or Space and drag, pans with any tool",
        }
    }

    fn icon(&self, painter: &Painter, square: Rect, stroke: Stroke) {
        let lines: &[&[[f32; 2]]] = &[
            &[[0.5, 0.08], [0.5, 0.92]],
            &[[0.08, 0.5], [0.92, 0.5]],
            &[[0.37, 0.2], [0.5, 0.07], [0.63, 0.2]],
            &[[0.37, 0.8], [0.5, 0.93], [0.63, 0.8]],
            &[[0.2, 0.37], [0.07, 0.5], [0.2, 0.63]],
            &[[0.8, 0.37], [0.93, 0.5], [0.8, 0.63]],
        ];
        icon::lines(painter, square, stroke, lines);
    }

    fn cursor(&self) -> CursorIcon {
        CursorIcon::Grab
    }

    fn pointer_mode(&self) -> PointerMode {
        PointerMode::Pan
    }
}
