//! Hit testing of constraints; locked ones are not hit.

use glam::Vec2;
use lightloom_core::constraint::{Constraint, stroke};

use super::tool::ToolContext;
use crate::editor::selection::Selection;

/// Hit distance of a line, screen points.
const LINE: f32 = 6.0;
/// Hit distance of a handle, screen points.
const HANDLE: f32 = 7.0;
/// Maximum hit distance of a handle as a fraction of the distance to the next, so that the line between can be grabbed.
const SHARE: f32 = 0.35;

/// A hit: what is under the pointer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Hit {
    /// A point of a selected constraint: indices of constraint and point.
    Point(usize, usize),
    /// A segment of a polyline: indices of constraint and first point, and the position on it.
    Piece(usize, usize, Vec2),
}

impl Hit {
    /// The constraint that was hit.
    pub(super) fn constraint(self) -> usize {
        match self {
            Self::Point(constraint, _) | Self::Piece(constraint, ..) => constraint,
        }
    }
}

/// The nearest hit at `p`; handles win over lines.
pub(super) fn hit(p: Vec2, context: &ToolContext) -> Option<Hit> {
    handle(p, context).or_else(|| piece(p, context))
}

fn free<'a>(context: &ToolContext<'a>) -> impl Iterator<Item = (usize, &'a Constraint)> {
    let drawn = context.session.overlays.drawn;
    context.project.constraints.iter().enumerate().filter(move |(_, c)| drawn && !c.is_locked())
}

fn handle(p: Vec2, context: &ToolContext) -> Option<Hit> {
    let selected = free(context).filter(|(i, _)| context.session.selection.contains(*i));
    let near = selected.flat_map(|(i, constraint)| {
        let points = constraint.points();
        points.iter().enumerate().filter_map(move |(k, &point)| {
            let room = |other: Option<&[f32; 2]>| {
                other.map_or(f32::INFINITY, |o| SHARE * Vec2::from(point).distance(Vec2::from(*o)))
            };
            let reach = room(k.checked_sub(1).map(|k| &points[k])).min(room(points.get(k + 1)));
            let distance = p.distance(point.into());
            (distance <= reach.min(context.points(HANDLE))).then_some((distance, Hit::Point(i, k)))
        })
    });
    near.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, hit)| hit)
}

/// The nearest segment at `p`.
pub(super) fn piece(p: Vec2, context: &ToolContext) -> Option<Hit> {
    let near = free(context).flat_map(|(i, constraint)| {
        let half = match constraint {
            Constraint::Wall(wall) => 0.5 * wall.thickness,
            Constraint::DirectedLine(_) => 0.0,
        };
        let reach = half.max(context.points(LINE));
        constraint.points().windows(2).enumerate().filter_map(move |(k, piece)| {
            let on = stroke::nearest_on_segment(p, piece[0].into(), piece[1].into());
            (on.distance(p) <= reach).then_some((on.distance(p), Hit::Piece(i, k, on)))
        })
    });
    near.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, hit)| hit)
}

/// The selection within a box of two corners: points, and whole constraints where all points are inside.
pub(super) fn within(a: Vec2, b: Vec2, context: &ToolContext) -> Selection {
    let (low, high) = (a.min(b), a.max(b));
    let inside = |p: &[f32; 2]| {
        let p = Vec2::from(*p);
        p.cmpge(low).all() && p.cmple(high).all()
    };
    let mut selection = Selection::default();
    for (i, constraint) in free(context).filter(|(_, constraint)| !constraint.points().is_empty()) {
        let points = constraint.points();
        if points.iter().all(inside) {
            selection.toggle(i);
        } else {
            let some = points.iter().enumerate().filter(|(_, p)| inside(p)).map(|(k, _)| k);
            selection.extend(&Selection::some(i, some));
        }
    }
    selection
}
