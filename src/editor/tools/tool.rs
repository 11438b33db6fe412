//! The interface of a tool: gestures in, actions and temporary shapes out.

use egui::Key;
use glam::Vec2;
use lightloom_core::project::Project;

use crate::editor::action::Action;
use crate::editor::session::Session;

/// A pointer or key gesture, plane coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Gesture {
    /// The pointer moves with no button down.
    Hover(Vec2),
    /// The primary button goes down.
    Press(Vec2),
    /// The pointer moves with the primary button down.
    Drag(Vec2),
    /// The primary button comes up.
    Release(Vec2),
    /// The primary button was clicked twice in one place.
    DoubleClick(Vec2),
    /// A key: Enter, Escape, Backspace, Delete, an arrow.
    Key(Key),
}

/// The modifier keys.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct HeldKeys {
    /// Shift: straight, or add to the selection.
    pub shift: bool,
    /// Alt: subtract from the selection.
    pub alt: bool,
    /// Ctrl or Command: no snapping for now.
    pub ctrl: bool,
}

/// The state that a tool reads.
#[derive(Clone, Copy)]
pub struct ToolContext<'a> {
    /// The project.
    pub project: &'a Project,
    /// The session.
    pub session: &'a Session,
    /// Size of the plane; its longer side is 1.
    pub extent: Vec2,
    /// Plane units per screen point: hit distances are in points.
    pub per_point: f32,
    /// The modifier keys.
    pub held: HeldKeys,
    /// Size in pixels of the target picture at the playhead; none where there is none, or it is not loaded yet.
    pub picture: Option<Vec2>,
    /// Photon positions at the playhead, by row; empty while unknown.
    pub photons: &'a [Vec2],
}

impl ToolContext<'_> {
    /// A length in screen points, as plane units.
    pub fn points(&self, count: f32) -> f32 {
        count * self.per_point
    }

    /// The step of an arrow key: one screen point, ten with Shift; none for other keys.
    pub(super) fn arrow(&self, key: Key) -> Option<Vec2> {
        let direction = match key {
            Key::ArrowLeft => Vec2::NEG_X,
            Key::ArrowRight => Vec2::X,
            Key::ArrowUp => Vec2::Y,
            Key::ArrowDown => Vec2::NEG_Y,
            _ => return None,
        };
        Some(direction * self.points(if self.held.shift { 10.0 } else { 1.0 }))
    }
}

/// A temporary shape that a tool shows, plane coordinates.
#[derive(Clone, Debug, PartialEq)]
pub enum Ghost {
    /// An unfinished directed line.
    Line(Vec<Vec2>),
    /// An unfinished wall, with its thickness in plane units.
    Wall(Vec<Vec2>, f32),
    /// A selection box: two corners.
    Box(Vec2, Vec2),
    /// A point that the pointer snapped to.
    Snap(Vec2),
    /// A placed point.
    Pin(Vec2),
    /// The eraser: centre, and radius in plane units.
    Eraser(Vec2, f32),
    /// Index of the constraint under the pointer.
    Hover(usize),
    /// The frame of a target: its corners, and its rotation handle.
    Frame([Vec2; 4], Vec2),
}

/// What handles the pointer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PointerMode {
    /// The tool: it receives gestures.
    #[default]
    Tool,
    /// The view: dragging pans.
    Pan,
    /// The view: a click zooms in, with Shift or Alt out; dragging does both.
    Zoom,
}

/// Name, key and tooltip of a tool.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ToolInfo {
    /// Its name.
    pub name: &'static str,
    /// The key that selects it.
    pub key: Key,
    /// One line on its use.
    pub hint: &'static str,
}

/// A tool.
pub trait Tool: Send {
    /// Its name, key and tooltip.
    fn info(&self) -> ToolInfo;
    /// Paints its icon in a square, with one stroke.
    fn icon(&self, painter: &egui::Painter, square: egui::Rect, stroke: egui::Stroke);
    /// The cursor over the plane.
    fn cursor(&self) -> egui::CursorIcon {
        egui::CursorIcon::Crosshair
    }
    /// What handles the pointer while it is active.
    fn pointer_mode(&self) -> PointerMode {
        PointerMode::Tool
    }
    /// Handles a gesture.
    fn gesture(&mut self, _gesture: Gesture, _look: &ToolContext) -> Vec<Action> {
        Vec::new()
    }
    /// The temporary shapes it shows.
    fn ghosts(&self, _look: &ToolContext) -> Vec<Ghost> {
        Vec::new()
    }
    /// Discards an unfinished gesture: another tool or document is active.
    fn put_down(&mut self) {}
    /// Whether it has an unfinished gesture, which Escape and Enter end.
    fn is_busy(&self) -> bool {
        false
    }
}
