//! The selection tool.

use egui::{CursorIcon, Key, Painter, Rect, Stroke};
use glam::Vec2;
use lightloom_core::constraint::Constraint;

use super::hit_test::{self, Hit};
use super::snap::Snap;
use super::tool::{Gesture, Ghost, Tool, ToolContext, ToolInfo};
use super::{arrange, icon};
use crate::editor::action::Action;
use crate::editor::document::Edit;
use crate::editor::selection::Selection;

/// A drag shorter than this is a click, screen points.
const CLICK: f32 = 3.0;

/// The selection tool: selects and moves constraints and points, adds and deletes points.
#[derive(Default)]
pub(super) struct Select {
    over: Option<Hit>,
    doing: Doing,
    caught: Option<Vec2>,
}

/// The gesture in progress.
#[derive(Default)]
enum Doing {
    #[default]
    Nothing,
    /// The button is down without a drag yet.
    Pressed { at: Vec2, hit: Option<Hit>, selection: Selection },
    /// The selection follows the pointer.
    Moving { from: Vec2, selection: Selection, base: Vec<(usize, Constraint)> },
    /// A selection box is drawn.
    Boxing { from: Vec2, to: Vec2 },
}

impl Select {
    fn press(&mut self, p: Vec2, context: &ToolContext) -> Vec<Action> {
        let hit = hit_test::hit(p, context);
        let before = &context.session.selection;
        let selection = hit.map_or_else(|| before.clone(), |hit| clicked(hit, before, context));
        self.doing = Doing::Pressed { at: p, hit, selection: selection.clone() };
        if selection == *before { Vec::new() } else { vec![Action::Select(selection)] }
    }

    fn drag(&mut self, p: Vec2, context: &ToolContext) -> Vec<Action> {
        if let Doing::Pressed { at, hit, selection } = &self.doing
            && at.distance(p) >= context.points(CLICK)
        {
            self.doing = match hit {
                Some(hit) => {
                    let base =
                        arrange::chosen(context.project, selection).map(|(i, c)| (i, c.clone())).collect();
                    Doing::Moving { from: grabbed(*hit, *at, context), selection: selection.clone(), base }
                }
                None => Doing::Boxing { from: *at, to: p },
            };
        }
        match &mut self.doing {
            Doing::Boxing { to, .. } => *to = p,
            Doing::Moving { from, selection, base } if !base.is_empty() => {
                let skip = |i: usize, k: usize| selection.moves(i, k);
                let snap = Snap { from: Some(*from).filter(|_| context.held.shift), skip: &skip, own: &[] };
                let snapped = snap.find(p, context);
                self.caught = snapped.caught.then_some(snapped.at);
                return vec![arrange::moved(base, selection, snapped.at - *from).into()];
            }
            _ => (),
        }
        Vec::new()
    }

    fn release(&mut self, context: &ToolContext) -> Vec<Action> {
        self.caught = None;
        match std::mem::take(&mut self.doing) {
            Doing::Moving { .. } => vec![Action::Settle],
            Doing::Boxing { from, to } => {
                let inside = hit_test::within(from, to, context);
                vec![Action::Select(combined(&inside, context))]
            }
            Doing::Pressed { hit: None, .. } if !context.held.shift && !context.held.alt => {
                vec![Action::Select(Selection::default())]
            }
            Doing::Pressed { .. } | Doing::Nothing => Vec::new(),
        }
    }

    fn escape(&mut self, context: &ToolContext) -> Vec<Action> {
        self.caught = None;
        match std::mem::take(&mut self.doing) {
            Doing::Moving { .. } => vec![Action::Abort],
            Doing::Nothing if !context.session.selection.is_empty() => {
                vec![Action::Select(Selection::default())]
            }
            _ => Vec::new(),
        }
    }
}

/// The position that follows the pointer: a hit point itself, so that it snaps.
fn grabbed(hit: Hit, at: Vec2, context: &ToolContext) -> Vec2 {
    match hit {
        Hit::Point(i, k) => {
            let point = context.project.constraints.get(i).and_then(|c| c.points().get(k));
            point.map_or(at, |&p| p.into())
        }
        Hit::Piece(..) => at,
    }
}

/// The selection after a click: Shift adds, Alt removes; a click on a selected constraint keeps the rest, so that
/// all of it can be dragged.
fn clicked(hit: Hit, before: &Selection, context: &ToolContext) -> Selection {
    let mut selection = before.clone();
    match hit {
        Hit::Point(i, k) if context.held.shift => selection.toggle_point(i, k),
        Hit::Piece(i, ..) if context.held.shift => selection.toggle(i),
        _ if context.held.alt => selection = combined(&Selection::one(hit.constraint()), context),
        Hit::Point(i, k) if before.is_whole(i) || !before.moves(i, k) => selection = Selection::point(i, k),
        Hit::Piece(i, ..) if !before.contains(i) => selection = Selection::one(i),
        Hit::Piece(i, ..) if !before.is_whole(i) => selection = Selection::one(i),
        Hit::Point(..) | Hit::Piece(..) => (),
    }
    selection
}

/// The selection combined with another: added with Shift, removed with Alt, else replaced.
fn combined(other: &Selection, context: &ToolContext) -> Selection {
    let mut selection = context.session.selection.clone();
    if context.held.alt {
        selection.subtract(other, |i| context.project.constraints.get(i).map_or(0, |c| c.points().len()));
    } else if context.held.shift {
        selection.extend(other);
    } else {
        selection = other.clone();
    }
    selection
}

/// Inserts a point on the line under the pointer.
fn insert(p: Vec2, context: &ToolContext) -> Vec<Action> {
    let Some(Hit::Piece(i, k, at)) = hit_test::hit(p, context) else { return Vec::new() };
    let Some(constraint) = context.project.constraints.get(i) else { return Vec::new() };
    let mut points = arrange::points(constraint);
    points.insert(k + 1, at);
    let change = Edit::Change(vec![(i, arrange::through(constraint, &points))]);
    vec![change.into(), Action::Settle, Action::Select(Selection::point(i, k + 1))]
}

fn key(key: Key, context: &ToolContext) -> Vec<Action> {
    let (project, selection) = (context.project, &context.session.selection);
    let arranged = match (key, context.arrow(key)) {
        (Key::Delete | Key::Backspace, _) => arrange::delete(project, selection),
        (_, Some(step)) => arrange::nudge(project, selection, step),
        _ => None,
    };
    let Some((edit, after)) = arranged else { return Vec::new() };
    vec![edit.into(), Action::Settle, Action::Select(after)]
}

impl Tool for Select {
    fn info(&self) -> ToolInfo {
        ToolInfo {
            name: "Select",
            key: Key::V,
            hint: "Click or drag a box to select (Shift adds, Alt removes), drag to move, double click a line to add a point",
        }
    }

    fn icon(&self, painter: &Painter, square: Rect, stroke: Stroke) {
        let arrow: &[[f32; 2]] = &[
            [0.22, 0.06],
            [0.22, 0.84],
            [0.42, 0.65],
            [0.56, 0.95],
            [0.69, 0.89],
            [0.55, 0.6],
            [0.82, 0.58],
            [0.22, 0.06],
            [0.22, 0.2],
        ];
        icon::lines(painter, square, stroke, &[arrow]);
    }

    fn cursor(&self) -> CursorIcon {
        match (&self.doing, self.over) {
            (Doing::Moving { .. }, _) | (Doing::Nothing, Some(Hit::Piece(..))) => CursorIcon::Move,
            (Doing::Nothing, Some(Hit::Point(..))) => CursorIcon::PointingHand,
            _ => CursorIcon::Default,
        }
    }

    fn gesture(&mut self, gesture: Gesture, context: &ToolContext) -> Vec<Action> {
        match gesture {
            Gesture::Hover(p) => {
                self.over = hit_test::hit(p, context);
                Vec::new()
            }
            Gesture::Press(p) => self.press(p, context),
            Gesture::Drag(p) => self.drag(p, context),
            Gesture::Release(_) => self.release(context),
            Gesture::DoubleClick(p) => insert(p, context),
            Gesture::Key(Key::Escape) => self.escape(context),
            Gesture::Key(pressed) => key(pressed, context),
        }
    }

    fn ghosts(&self, _look: &ToolContext) -> Vec<Ghost> {
        let over = self.over.filter(|_| matches!(self.doing, Doing::Nothing));
        let hover = over.map(|hit| Ghost::Hover(hit.constraint()));
        let frame = match &self.doing {
            Doing::Boxing { from, to } => Some(Ghost::Box(*from, *to)),
            _ => None,
        };
        hover.into_iter().chain(frame).chain(self.caught.map(Ghost::Snap)).collect()
    }

    fn put_down(&mut self) {
        *self = Self::default();
    }

    fn is_busy(&self) -> bool {
        !matches!(self.doing, Doing::Nothing)
    }
}
