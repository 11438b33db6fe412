//! The interface of a tool: the gestures that it gets, what it sees, and what it shows while it works.

use egui::Key;
use glam::Vec2;
use lightloom_core::project::Project;

use crate::editor::action::Action;
use crate::editor::session::Session;

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
pub struct HeldKeys {
    /// Shift: straight, or add to the selection.
    pub shift: bool,
    /// Alt: subtract from the selection.
    pub alt: bool,
    /// Ctrl or Command: no snapping for now.
    pub ctrl: bool,
}

/// What a tool sees.
#[derive(Clone, Copy)]
pub struct ToolContext<'a> {
    /// The document.
    pub project: &'a Project,
    /// The state of the window.
    pub session: &'a Session,
    /// Size of the plane; its longer side is 1.
    pub extent: Vec2,
    /// Plane units per point of the screen: hit distances are in points.
    pub per_point: f32,
    /// What is held.
    pub held: HeldKeys,
    /// Pixels of the picture that the key after the playhead shows; none where it shows none, or it is not read yet.
    pub picture: Option<Vec2>,
    /// Where the photons are now, by row; empty while unknown.
    pub photons: &'a [Vec2],
}

impl ToolContext<'_> {
    /// A length of so many points of the screen, in plane units.
    pub fn points(&self, count: f32) -> f32 {
        count * self.per_point
    }

    /// The step of an arrow key: a point of the screen, with Shift ten; none for other keys.
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
    /// A point that was set.
    Pin(Vec2),
    /// The place around which something is erased, with its radius in plane units.
    Eraser(Vec2, f32),
    /// The constraint under the pointer, by index.
    Hover(usize),
    /// The frame of a target: its corners, and the handle that turns it.
    Frame([Vec2; 4], Vec2),
}

/// Who answers the pointer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PointerMode {
    /// The tool: it gets gestures.
    #[default]
    Tool,
    /// The view: dragging moves it.
    Pan,
    /// The view: a click comes closer, with Shift or Alt it goes back; dragging does either.
    Zoom,
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
    /// Who answers the pointer while this is in hand.
    fn pointer_mode(&self) -> PointerMode {
        PointerMode::Tool
    }
    /// Answers a gesture.
    fn gesture(&mut self, _gesture: Gesture, _look: &ToolContext) -> Vec<Action> {
        Vec::new()
    }
    /// What it shows now.
    fn ghosts(&self, _look: &ToolContext) -> Vec<Ghost> {
        Vec::new()
    }
    /// Another tool is taken, or the document is another: forget what was begun.
    fn put_down(&mut self) {}
    /// Whether it has something in the making, which Escape and Enter end.
    fn is_busy(&self) -> bool {
        false
    }
}
