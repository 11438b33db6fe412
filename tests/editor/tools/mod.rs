//! Every tool, given gestures as the plane view gives them: without a window and without a GPU.

use std::ops::{Deref, DerefMut};
use std::sync::Arc;

use crate::window::Editor;
use egui::Key;
use glam::{Vec2, vec2};
use lightloom::editor::action::Action;
use lightloom::editor::selection::Selection;
use lightloom::editor::tools::arrange::{self, Arranged};
use lightloom::editor::tools::{Gesture, Ghost, HeldKeys, ToolContext, Toolbox};
use lightloom_core::constraint::{Constraint, DirectedLine, Wall, stroke};
use lightloom_core::project::{Project, Shows};

mod arranging;
mod drawing;
mod erasing;
mod locking;
mod placing;
mod selecting;

/// Plane units per point of the screen: the plane is 1000 points wide.
const PER_POINT: f32 = 0.001;

/// An editor with a tool in hand.
struct ToolHarness {
    editor: Editor,
    toolbox: Toolbox,
    held: HeldKeys,
    photons: Vec<Vec2>,
}

impl Deref for ToolHarness {
    type Target = Editor;

    fn deref(&self) -> &Editor {
        &self.editor
    }
}

impl DerefMut for ToolHarness {
    fn deref_mut(&mut self) -> &mut Editor {
        &mut self.editor
    }
}

impl ToolHarness {
    fn new(tool: &str, constraints: Vec<Constraint>) -> Self {
        let text = r#"{ "lightloom": 1, "keys": [ { "frame": 1, "shows": { "image": { "file": "a.png" } } },
            { "frame": 60, "shows": { "image": { "file": "b.png" } } } ] }"#;
        let mut editor = Editor::with_project(Project { constraints, ..serde_json::from_str(text).unwrap() });
        let mut toolbox = Toolbox::default();
        let index = toolbox.tools().position(|known| known.info().name == tool).unwrap();
        toolbox.take(index);
        editor.session.tool = index;
        Self { editor, toolbox, held: HeldKeys::default(), photons: Vec::new() }
    }

    fn with_context<R>(&mut self, with: impl FnOnce(&mut Toolbox, &ToolContext) -> R) -> R {
        let project = self.editor.document.project().clone();
        let context = ToolContext {
            project: &project,
            session: &self.editor.session,
            extent: Vec2::ONE,
            per_point: PER_POINT,
            held: self.held,
            picture: Some(vec2(200.0, 100.0)),
            photons: &self.photons,
        };
        with(&mut self.toolbox, &context)
    }

    fn gesture(&mut self, gesture: Gesture) {
        for action in self.with_context(|toolbox, context| toolbox.gesture(gesture, context)) {
            assert_eq!(self.editor.apply(action), None, "no tool needs the window");
        }
    }

    /// The messages for the status bar.
    fn said(&self) -> usize {
        self.asked.iter().filter(|action| matches!(action, Action::Say(_))).count()
    }

    fn arrange(&mut self, with: impl Fn(&Project, &Selection) -> Arranged) -> bool {
        let arranged = with(self.document.project(), &self.session.selection);
        let any = arranged.is_some();
        self.editor.arrange(arranged);
        any
    }

    fn click(&mut self, p: Vec2) {
        for gesture in [Gesture::Hover(p), Gesture::Press(p), Gesture::Release(p)] {
            self.gesture(gesture);
        }
    }

    fn double_click(&mut self, p: Vec2) {
        self.click(p);
        self.click(p);
        self.gesture(Gesture::DoubleClick(p));
    }

    fn press_and_drag(&mut self, path: &[Vec2]) {
        self.gesture(Gesture::Hover(path[0]));
        self.gesture(Gesture::Press(path[0]));
        for &p in &path[1..] {
            self.gesture(Gesture::Drag(p));
        }
    }

    fn drag(&mut self, path: &[Vec2]) {
        self.press_and_drag(path);
        self.gesture(Gesture::Release(path[path.len() - 1]));
    }

    fn key(&mut self, key: Key) {
        self.gesture(Gesture::Key(key));
    }

    fn constraints(&self) -> &[Constraint] {
        &self.document.project().constraints
    }

    fn points(&self, constraint: usize) -> Vec<Vec2> {
        self.constraints()[constraint].points().iter().map(|&p| p.into()).collect()
    }

    /// Steps that undo takes back until nothing changes.
    fn steps(&mut self) -> usize {
        let mut document = self.document.clone();
        let mut steps = 0;
        while document.history().undoes().is_some() {
            document.undo();
            steps += 1;
        }
        steps
    }
}

fn line(points: &[[f32; 2]]) -> Constraint {
    Constraint::DirectedLine(DirectedLine::new(points.to_vec()))
}

fn wall(points: &[[f32; 2]]) -> Constraint {
    Constraint::Wall(Wall::new(points.to_vec()))
}

fn locked(points: &[[f32; 2]]) -> Constraint {
    Constraint::Wall(Wall { locked: true, ..Wall::new(points.to_vec()) })
}

fn path(from: Vec2, to: Vec2, steps: usize) -> Vec<Vec2> {
    (0..=steps).map(|i| from.lerp(to, i as f32 / steps as f32)).collect()
}

/// How far any of the points lies from the polyline.
fn stray(points: &[Vec2], line: &[Vec2]) -> f32 {
    let distance = |p: Vec2| {
        line.windows(2).map(|s| stroke::distance_to_segment(p, s[0], s[1])).fold(f32::INFINITY, f32::min)
    };
    points.iter().map(|&p| distance(p)).fold(0.0, f32::max)
}

#[test]
fn the_probe_follows_the_nearest_photon_and_none_far_away() {
    let mut harness = ToolHarness::new("Probe", Vec::new());
    harness.photons = vec![vec2(0.1, 0.1), vec2(0.5, 0.5), vec2(0.52, 0.5)];
    harness.click(vec2(0.515, 0.5));
    assert_eq!(harness.session.probe, Some(2));
    harness.click(vec2(0.9, 0.1));
    assert_eq!(harness.session.probe, None);
    harness.click(vec2(0.5, 0.5));
    harness.key(Key::Escape);
    assert_eq!(harness.session.probe, None);
}
