//! Drawing of polylines, freehand or point by point, for directed lines and walls.

use egui::Key;
use glam::Vec2;
use lightloom_core::constraint::Constraint;

use super::curve;
use super::snap::Snap;
use super::tool::{Gesture, Ghost, ToolContext};
use crate::editor::action::Action;
use crate::editor::document::Edit;
use crate::editor::selection::Selection;

/// A drag shorter than this is a click, screen points.
const CLICK: f32 = 4.0;
/// Distance to the start at which a loop closes, screen points.
const CLOSES: f32 = 8.0;
/// Tolerance of a freehand curve, screen points.
const STRAY: f32 = 1.0;
/// Maximum coordinate of a point, plane units.
const FARTHEST: f32 = 10.0;

/// An unfinished polyline.
#[derive(Default)]
pub(super) struct Pen {
    /// Whether it closes where it returns to its start.
    loops: bool,
    /// The placed points.
    placed: Vec<Vec2>,
    /// The path of the pointer since its button went down.
    trail: Vec<Vec2>,
    /// Position of the next point, and whether it snapped.
    next: Option<(Vec2, bool)>,
}

impl Pen {
    /// A pen that closes loops.
    pub(super) fn closing() -> Self {
        Self { loops: true, ..Self::default() }
    }

    /// Handles a gesture; returns at least two points when the line is finished.
    pub(super) fn gesture(&mut self, gesture: Gesture, context: &ToolContext) -> Option<Vec<Vec2>> {
        match gesture {
            Gesture::Hover(p) => self.aim(p, context),
            Gesture::Press(p) => {
                self.aim(p, context);
                self.trail = self.next.map(|(at, _)| at).into_iter().collect();
            }
            Gesture::Drag(p) => self.drag(p, context),
            Gesture::Release(p) => return self.release(p, context),
            Gesture::DoubleClick(_) | Gesture::Key(Key::Enter) => return self.finish(),
            Gesture::Key(Key::Backspace) => {
                self.placed.pop();
            }
            Gesture::Key(Key::Escape) => self.clear(),
            Gesture::Key(_) => (),
        }
        None
    }

    /// Whether a line was begun.
    pub(super) fn is_busy(&self) -> bool {
        !self.placed.is_empty() || !self.trail.is_empty()
    }

    /// Discards the line.
    pub(super) fn clear(&mut self) {
        *self = Self { loops: self.loops, ..Self::default() };
    }

    /// The line up to the pointer.
    pub(super) fn points(&self) -> Vec<Vec2> {
        let ahead = if self.trail.len() > 1 { &self.trail[..] } else { &[] };
        let next = self.next.filter(|_| ahead.is_empty() && !self.placed.is_empty()).map(|(at, _)| at);
        self.placed.iter().chain(ahead).copied().chain(next).collect()
    }

    /// Markers of the placed points and of the snapping point.
    pub(super) fn marks(&self) -> Vec<Ghost> {
        let caught = self.next.filter(|(_, caught)| *caught).map(|(at, _)| Ghost::Snap(at));
        self.placed.iter().map(|&p| Ghost::Pin(p)).chain(caught).collect()
    }

    fn aim(&mut self, p: Vec2, context: &ToolContext) {
        let snap = Snap { from: self.placed.last().copied(), own: &self.placed, ..Snap::ALL };
        let snapped = snap.find(p, context);
        let inside = snapped.at.clamp(Vec2::splat(-FARTHEST), Vec2::splat(FARTHEST));
        self.next = Some((inside, snapped.caught));
    }

    fn drag(&mut self, p: Vec2, context: &ToolContext) {
        let Some(&from) = self.trail.first() else { return };
        if self.trail.len() == 1 && from.distance(p) < context.points(CLICK) {
            return;
        }
        let inside = p.clamp(Vec2::splat(-FARTHEST), Vec2::splat(FARTHEST));
        if context.held.shift {
            self.trail = vec![from, Snap { from: Some(from), ..Snap::ALL }.find(inside, context).at];
        } else {
            self.trail.push(inside);
        }
        self.next = None;
    }

    fn release(&mut self, p: Vec2, context: &ToolContext) -> Option<Vec<Vec2>> {
        let trail = std::mem::take(&mut self.trail);
        if trail.len() < 2 {
            return self.set(*trail.first()?, context);
        }
        let mut stroke = trail;
        self.end(&mut stroke, p, context);
        let fitted = curve::fit(&stroke, context.points(STRAY));
        let alone = self.placed.is_empty();
        self.placed.extend(fitted);
        if alone { self.finish() } else { None }
    }

    /// Places the end of a freehand stroke: on its start if it closes, else snapped.
    fn end(&self, stroke: &mut [Vec2], p: Vec2, context: &ToolContext) {
        let long = stroke.windows(2).map(|pair| pair[0].distance(pair[1])).sum::<f32>();
        let (first, near) = (stroke[0], context.points(CLOSES));
        let Some(last) = stroke.last_mut().filter(|_| !context.held.shift) else { return };
        if self.loops && first.distance(p) < near && long > 6.0 * near {
            *last = first;
        } else {
            let snapped = Snap::ALL.find(p, context);
            *last = if snapped.caught { snapped.at } else { *last };
        }
    }

    /// Places a point; on the first one a loop closes.
    fn set(&mut self, at: Vec2, context: &ToolContext) -> Option<Vec<Vec2>> {
        let first = self.placed.first().copied();
        if let Some(first) = first
            && self.loops
            && self.placed.len() > 2
            && first.distance(at) < context.points(CLOSES)
        {
            self.placed.push(first);
            return self.finish();
        }
        // The second click of a double click places no second point.
        if self.placed.last().is_none_or(|last| last.distance(at) > context.points(1.0)) {
            self.placed.push(at);
        }
        None
    }

    fn finish(&mut self) -> Option<Vec<Vec2>> {
        let mut points = std::mem::take(&mut self.placed);
        self.clear();
        points.dedup();
        (points.len() > 1).then_some(points)
    }
}

/// The actions that add a drawn constraint and select it.
pub(super) fn add(constraint: Constraint, context: &ToolContext) -> Vec<Action> {
    let selected = Selection::one(context.project.constraints.len());
    vec![Edit::Add(vec![constraint]).into(), Action::Settle, Action::Select(selected)]
}
