//! Tools receive gestures in plane coordinates and answer with actions, so each is tested without a window.

use egui::Key;
use glam::Vec2;
use lightloom_core::project::Project;

use super::action::Action;
use super::session::Session;

/// What the pointer or a key does, plane coordinates.
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
    /// The primary button was pressed and released twice in one place.
    DoubleClick(Vec2),
    /// A key: Enter, Escape, Backspace, Delete, an arrow.
    Key(Key),
}

/// What is held beside the pointer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Held {
    /// Shift: straight, or add to the selection.
    pub shift: bool,
    /// Alt: subtract from the selection.
    pub alt: bool,
    /// Ctrl or Command: no snapping for now.
    pub ctrl: bool,
}

/// What a tool sees.
#[derive(Clone, Copy)]
pub struct Look<'a> {
    /// The document.
    pub project: &'a Project,
    /// The state of the window.
    pub session: &'a Session,
    /// Size of the plane; its longer side is 1.
    pub extent: Vec2,
    /// Plane units per point of the screen: hit distances are in points.
    pub per_point: f32,
    /// What is held.
    pub held: Held,
}

/// Something a tool shows while it works, plane coordinates.
#[derive(Clone, Debug, PartialEq)]
pub enum Ghost {
    /// A directed line in the making.
    Line(Vec<Vec2>),
    /// A wall in the making, with its thickness in plane units.
    Wall(Vec<Vec2>, f32),
    /// A box of selection: two corners.
    Box(Vec2, Vec2),
    /// A place to which the pointer snapped.
    Snap(Vec2),
    /// The place around which something is erased, with its radius in plane units.
    Eraser(Vec2, f32),
}

/// A tool.
pub trait Tool: Send {
    /// What it is called.
    fn name(&self) -> &'static str;
    /// The key that takes it.
    fn key(&self) -> Key;
    /// One line on how it is used, for the status bar.
    fn hint(&self) -> &'static str;
    /// Draws its icon into a square, with one stroke.
    fn icon(&self, painter: &egui::Painter, square: egui::Rect, stroke: egui::Stroke);
    /// The cursor over the plane.
    fn cursor(&self) -> egui::CursorIcon {
        egui::CursorIcon::Crosshair
    }
    /// Answers a gesture.
    fn gesture(&mut self, gesture: Gesture, look: &Look) -> Vec<Action>;
    /// What it shows now.
    fn ghosts(&self, _look: &Look) -> Vec<Ghost> {
        Vec::new()
    }
    /// Another tool is taken, or the document is another: forget what was begun.
    fn put_down(&mut self) {}
    /// Whether it has something in the making, which Escape and Enter end.
    fn is_busy(&self) -> bool {
        false
    }
}
