//! Bridges over gaps narrower than the walls are thick: light does not pass where two walls, drawn to scale, overlap.

use glam::Vec2;

use super::edge::Edge;
use crate::constraint::stroke;
use crate::constraint::wall::ActiveWall;

/// Length by which a wall that ends at the border is continued beyond it, plane units: light that flowed off the
/// receiver does not come back on the other side.
const BEYOND: f32 = 0.5;
/// Overlap of a bridge with the walls that it joins: more than rounding, far less than a cell.
const OVERLAP: f32 = 1e-5;
/// A wall's own ends meet its other parts only from this many clearances along it; nearer parts are just its bend.
const OWN_BEND: f32 = 8.0;

/// What is closed, by the numbers of walls.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Deserialize, serde::Serialize)]
pub enum Closed {
    /// Two walls touch, or leave a gap narrower than they are thick.
    Between(usize, usize),
    /// A wall reaches the border at both ends: no way leads around it.
    Across(usize),
}

/// The closing edges, and why those between walls and at the border are there.
pub(super) fn closing_edges(walls: &[&ActiveWall], extent: Vec2) -> (Vec<[Vec2; 2]>, Vec<Closed>) {
    let mut closing_edges = Vec::new();
    let mut notes = Vec::new();
    let coarse: Vec<Vec<Vec2>> =
        walls.iter().map(|wall| stroke::simplify(&wall.points, 0.1 * wall.clearance)).collect();
    for (i, wall) in walls.iter().enumerate() {
        for (j, other) in walls.iter().enumerate().filter(|(j, _)| *j != i) {
            let reach = wall.clearance + other.clearance;
            let close: Vec<_> = coarse[i]
                .iter()
                .filter_map(|&p| {
                    let nearest = nearest_on(p, &other.points);
                    (p.distance(nearest) < reach).then(|| bridge(p, nearest, &other.points))
                })
                .collect();
            if !close.is_empty() {
                notes.push(Closed::Between(i.min(j), i.max(j)));
            }
            closing_edges.extend(close);
        }
        closing_edges.extend(own_gaps(wall));
        let outward = border_pieces(wall, extent);
        if outward.len() == 2 {
            notes.push(Closed::Across(i));
        }
        closing_edges.extend(outward);
    }
    (closing_edges, notes)
}

/// The gaps that are open as drawn, but count as closed: those between two walls, and between a wall's ends and its other
/// parts, that are narrower than the walls are thick. The narrowest of each two walls.
pub(super) fn closed_gaps(walls: &[&ActiveWall]) -> Vec<[Vec2; 2]> {
    let pairs = walls.iter().enumerate().flat_map(|(i, a)| walls[..i].iter().map(move |b| [*a, *b]));
    let between = pairs.filter(|[a, b]| !cross(a, b)).filter_map(|[a, b]| {
        let ways = [(a, b), (b, a)].into_iter().flat_map(|(from, to)| {
            stroke::simplify(&from.points, 0.1 * from.clearance)
                .into_iter()
                .map(|p| [p, nearest_on(p, &to.points)])
                .collect::<Vec<_>>()
        });
        ways.filter(|gap| wide(gap) < a.clearance + b.clearance)
            .min_by(|one, other| wide(one).total_cmp(&wide(other)))
    });
    let own = walls.iter().flat_map(|wall| own_gaps(wall));
    between.chain(own).filter(|gap| wide(gap) > 4.0 * OVERLAP).collect()
}

fn wide([from, to]: &[Vec2; 2]) -> f32 {
    from.distance(*to)
}

fn cross(a: &ActiveWall, b: &ActiveWall) -> bool {
    let edges = |wall: &ActiveWall| -> Vec<Edge> {
        wall.points.windows(2).map(|pair| Edge { from: pair[0], to: pair[1] }).collect()
    };
    let others = edges(b);
    edges(a).iter().any(|edge| others.iter().any(|other| edge.blocks(other.from, other.to)))
}

/// Between the ends of a wall and its other parts, such as the two ends of a loop that was not quite closed.
fn own_gaps(wall: &ActiveWall) -> Vec<[Vec2; 2]> {
    let mut gaps = Vec::new();
    let reversed: Vec<Vec2> = wall.points.iter().rev().copied().collect();
    for points in [&wall.points, &reversed] {
        let end = points[0];
        let (mut walked, mut best) = (0.0, (2.0 * wall.clearance, None));
        for pair in points.windows(2) {
            let nearest = stroke::nearest_on_segment(end, pair[0], pair[1]);
            let far_along = walked + pair[0].distance(nearest) >= OWN_BEND * wall.clearance;
            let gap = end.distance(nearest);
            if far_along && gap < best.0 {
                best = (gap, Some(nearest));
            }
            walked += pair[0].distance(pair[1]);
        }
        gaps.extend(best.1.filter(|nearest| *nearest != end).map(|nearest| bridge(end, nearest, points)));
    }
    gaps
}

/// Continuations of the ends that reach the border, outwards.
fn border_pieces(wall: &ActiveWall, extent: Vec2) -> Vec<[Vec2; 2]> {
    let ends = [wall.points[0], wall.points[wall.points.len() - 1]];
    ends.iter()
        .filter_map(|&end| {
            let sides = [
                (end.x, Vec2::NEG_X),
                (end.y, Vec2::NEG_Y),
                (extent.x - end.x, Vec2::X),
                (extent.y - end.y, Vec2::Y),
            ];
            let (gap, outward) = sides.into_iter().min_by(|a, b| a.0.total_cmp(&b.0))?;
            (gap < wall.clearance).then(|| [end, end + outward * (gap.max(0.0) + BEYOND)])
        })
        .collect()
}

/// From `p` to a little beyond `nearest`, which lies on `points` but for rounding.
fn bridge(p: Vec2, nearest: Vec2, points: &[Vec2]) -> [Vec2; 2] {
    let across = (nearest - p).try_normalize().unwrap_or_else(|| {
        let on = |pair: &&[Vec2]| stroke::distance_to_segment(p, pair[0], pair[1]);
        let touched = points.windows(2).min_by(|a, b| on(a).total_cmp(&on(b)));
        touched.map_or(Vec2::X, |pair| (pair[1] - pair[0]).perp().normalize_or(Vec2::X))
    });
    [p - across * OVERLAP, nearest + across * OVERLAP]
}

fn nearest_on(p: Vec2, points: &[Vec2]) -> Vec2 {
    let pieces = points.windows(2).map(|pair| stroke::nearest_on_segment(p, pair[0], pair[1]));
    pieces.min_by(|a, b| a.distance_squared(p).total_cmp(&b.distance_squared(p))).unwrap_or(p)
}
