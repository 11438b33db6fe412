//! Snapping of the pointer to points, lines, directions and the grid.

use glam::{Vec2, vec2};
use lightloom_core::constraint::stroke;

use super::tool::ToolContext;

/// Snapping distance, screen points.
const REACH: f32 = 5.0;
/// Step of the snapping directions, radians.
const STEP: f32 = std::f32::consts::PI / 12.0;
/// Snapping angle, radians: close to the start all directions are within the snapping distance.
const NEAR: f32 = 0.05;

/// A snapped position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Snapped {
    /// The position, plane units.
    pub(super) at: Vec2,
    /// Whether it snapped.
    pub(super) caught: bool,
}

/// The candidates for snapping.
pub(super) struct Snap<'a> {
    /// Origin of the snapping directions.
    pub(super) from: Option<Vec2>,
    /// Further points.
    pub(super) own: &'a [Vec2],
    /// Points of the document that are skipped: indices of constraint and point.
    pub(super) skip: &'a dyn Fn(usize, usize) -> bool,
}

impl Snap<'_> {
    /// Snapping to everything in the document.
    pub(super) const ALL: Self = Self { from: None, own: &[], skip: &|_, _| false };

    /// The snapped position of the pointer at `p`. Shift restricts it to the snapping directions.
    pub(super) fn find(&self, p: Vec2, context: &ToolContext) -> Snapped {
        if let Some(from) = self.from.filter(|_| context.held.shift) {
            return Snapped { at: straight(p, from), caught: false };
        }
        let off = context.held.ctrl || !context.session.snapping;
        let caught =
            if off { None } else { self.to_point(p, context).or_else(|| self.to_others(p, context)) };
        Snapped { at: caught.unwrap_or(p), caught: caught.is_some() }
    }

    fn to_point(&self, p: Vec2, context: &ToolContext) -> Option<Vec2> {
        let drawn = context.project.constraints.iter().enumerate().filter(|_| context.session.overlays.drawn);
        let points = drawn.flat_map(|(i, constraint)| {
            let points = constraint.points().iter().enumerate();
            points.filter(move |(k, _)| !(self.skip)(i, *k)).map(|(_, &point)| Vec2::from(point))
        });
        nearest(p, points.chain(self.own.iter().copied()), context.points(REACH))
    }

    fn to_others(&self, p: Vec2, context: &ToolContext) -> Option<Vec2> {
        let drawn = context.project.constraints.iter().enumerate().filter(|_| context.session.overlays.drawn);
        let along = drawn.flat_map(|(i, constraint)| {
            let pieces = constraint.points().windows(2).enumerate();
            pieces
                .filter(move |(k, _)| !(self.skip)(i, *k) && !(self.skip)(i, k + 1))
                .map(move |(_, piece)| stroke::nearest_on_segment(p, piece[0].into(), piece[1].into()))
        });
        let turned = self.from.map(|from| (from, straight(p, from)));
        let turned = turned.filter(|(from, to)| p.distance(*to) < NEAR * p.distance(*from)).map(|(_, to)| to);
        let node = context.session.overlays.grid.then(|| grid_node(p, context));
        nearest(p, along.chain(turned).chain(node), context.points(REACH))
    }
}

/// The projection of `p` on the nearest snapping direction from `from`.
pub(super) fn straight(p: Vec2, from: Vec2) -> Vec2 {
    let along = p - from;
    if along == Vec2::ZERO {
        return p;
    }
    let direction = Vec2::from_angle((along.to_angle() / STEP).round() * STEP);
    from + direction * along.dot(direction)
}

fn grid_node(p: Vec2, context: &ToolContext) -> Vec2 {
    let [x, y] = context.project.flow.grid.cells(context.extent);
    let cells = vec2(x as f32, y as f32) / context.extent;
    (p * cells).round() / cells
}

fn nearest(p: Vec2, candidates: impl Iterator<Item = Vec2>, reach: f32) -> Option<Vec2> {
    let near = candidates.map(|c| (c.distance(p), c)).filter(|(distance, _)| *distance <= reach);
    near.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, c)| c)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn straight_ways_are_multiples_of_fifteen_degrees() {
        for i in 0..200 {
            let from = vec2(0.3, 0.4);
            let angle = 0.1 * i as f32;
            let to = straight(from + Vec2::from_angle(angle) * 0.2, from);
            let turns = (to - from).to_angle() / STEP;
            // Angles of f32 vectors of length 0.2.
            assert!((turns - turns.round()).abs() < 1e-4, "{turns}");
        }
    }
}
