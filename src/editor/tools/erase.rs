//! The eraser of lines and walls.

use egui::{Key, Painter, Rect, Stroke};
use glam::Vec2;
use lightloom_core::constraint::{Constraint, stroke};

use super::tool::{Gesture, Ghost, Tool, ToolContext, ToolInfo};
use super::{arrange, cut, icon};
use crate::editor::action::Action;
use crate::editor::document::Edit;
use crate::editor::selection::Selection;

/// Radius, screen points.
const RADIUS: f32 = 9.0;
/// Pieces shorter than this are removed too, screen points.
const CRUMB: f32 = 3.0;

/// The eraser: removes the touched parts of lines and walls.
#[derive(Default)]
pub(super) struct Erase {
    /// Position of the pointer.
    at: Option<Vec2>,
    /// The remaining constraints, while the button is down.
    left: Option<Vec<Constraint>>,
}

impl Erase {
    /// Erases from the last position to `to`.
    fn sweep(&mut self, to: Vec2, context: &ToolContext) -> Vec<Action> {
        let from = self.at.replace(to).unwrap_or(to);
        let Some(left) = &mut self.left else { return Vec::new() };
        let radius = context.points(RADIUS);
        // Dense enough that the swept outline deviates by less than a tenth of the radius.
        let steps = (from.distance(to) / (0.8 * radius)).ceil().clamp(1.0, 1000.0) as usize;
        let before = left.clone();
        for i in 1..=steps {
            let centre = from.lerp(to, i as f32 / steps as f32);
            *left = left.iter().flat_map(|constraint| rub(constraint, centre, radius, context)).collect();
        }
        if *left == before {
            return Vec::new();
        }
        vec![Edit::Constraints(left.clone()).into(), Action::Select(Selection::default())]
    }
}

fn rub(constraint: &Constraint, centre: Vec2, radius: f32, context: &ToolContext) -> Vec<Constraint> {
    let radius = match constraint {
        Constraint::Wall(wall) => radius.max(0.5 * wall.thickness),
        Constraint::DirectedLine(_) => radius,
    };
    let points = arrange::points(constraint);
    let far = points.windows(2).all(|s| stroke::distance_to_segment(centre, s[0], s[1]) >= radius);
    if constraint.is_locked() || far {
        return vec![constraint.clone()];
    }
    let parts = cut::cut(&points, centre, radius).into_iter();
    let whole = parts.filter(|part| stroke::length(part) > context.points(CRUMB));
    whole.map(|part| arrange::through(constraint, &part)).collect()
}

impl Tool for Erase {
    fn info(&self) -> ToolInfo {
        ToolInfo { name: "Erase", key: Key::E, hint: "Drag over lines and walls to remove the touched parts" }
    }

    fn icon(&self, painter: &Painter, square: Rect, stroke: Stroke) {
        let lines: &[&[[f32; 2]]] = &[
            &[[0.38, 0.86], [0.1, 0.58], [0.56, 0.12], [0.9, 0.46], [0.5, 0.86], [0.34, 0.86]],
            &[[0.32, 0.36], [0.66, 0.7]],
            &[[0.34, 0.86], [0.94, 0.86]],
        ];
        icon::lines(painter, square, stroke, lines);
    }

    fn cursor(&self) -> egui::CursorIcon {
        egui::CursorIcon::None
    }

    fn gesture(&mut self, gesture: Gesture, context: &ToolContext) -> Vec<Action> {
        match gesture {
            Gesture::Hover(p) => {
                self.at = Some(p);
                Vec::new()
            }
            Gesture::Press(p) => {
                self.at = Some(p);
                self.left =
                    Some(context.project.constraints.clone()).filter(|_| context.session.overlays.drawn);
                self.sweep(p, context)
            }
            Gesture::Drag(p) => self.sweep(p, context),
            Gesture::Release(_) => {
                if self.left.take().is_some() {
                    vec![Action::Settle]
                } else {
                    Vec::new()
                }
            }
            Gesture::Key(Key::Escape) => {
                if self.left.take().is_some() {
                    vec![Action::Abort]
                } else {
                    Vec::new()
                }
            }
            Gesture::DoubleClick(_) | Gesture::Key(_) => Vec::new(),
        }
    }

    fn ghosts(&self, context: &ToolContext) -> Vec<Ghost> {
        self.at.map(|at| Ghost::Eraser(at, context.points(RADIUS))).into_iter().collect()
    }

    fn put_down(&mut self) {
        *self = Self::default();
    }

    fn is_busy(&self) -> bool {
        self.left.is_some()
    }
}
