//! The walls' geometry: which straight moves they block, and where.
//!
//! Whether a move crosses an edge is decided by exact orientation predicates (Shewchuk 1997, crate `robust`), so that no
//! photon slips through by rounding: a move is blocked where its ends lie strictly on different sides of an edge and it
//! meets that edge, end points included. A point exactly on a wall may leave it to either side.

mod edge;
mod gap_closing;
mod lookup;

use glam::Vec2;

use super::stroke;
use super::wall::ActiveWall;
pub use edge::Edge;
pub use gap_closing::Closed;
use lookup::Lookup;

/// The wall edges at one moment, with a grid to find those near a move.
#[derive(serde::Deserialize, serde::Serialize)]
pub struct Barriers {
    edges: Vec<Edge>,
    lookup: Lookup,
    closed: Vec<Closed>,
}

/// The first contact of a move with a wall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// Fraction of the move before the contact, 0..=1.
    pub share: f32,
    /// The edge that is met.
    pub edge: Edge,
}

impl Barriers {
    /// The walls on the rectangle `extent`, with the gaps closed that are narrower than their thickness.
    pub fn new(walls: &[&ActiveWall], extent: Vec2) -> Self {
        let (closing_edges, closed) = gap_closing::closing_edges(walls, extent);
        let drawn = walls.iter().flat_map(|wall| wall.points.windows(2)).map(|pair| [pair[0], pair[1]]);
        let edges: Vec<Edge> = drawn
            .chain(closing_edges)
            .filter(|[from, to]| from != to)
            .map(|[from, to]| Edge { from, to })
            .collect();
        let lookup = Lookup::new(&edges, extent);
        Self { edges, lookup, closed }
    }

    /// The gaps that are open as drawn, but count as closed, because they are narrower than the walls are thick; from one side to
    /// the other. Those to the border of the receiver are left out.
    pub fn closed_gaps(walls: &[&ActiveWall]) -> Vec<[Vec2; 2]> {
        gap_closing::closed_gaps(walls)
    }

    /// What is closed that the artist should know of.
    pub fn closed(&self) -> &[Closed] {
        &self.closed
    }

    /// Whether the straight move from `a` to `b` crosses a wall; false where a point is not finite.
    pub fn blocks(&self, a: Vec2, b: Vec2) -> bool {
        self.lookup.any(a, b, |i| self.edges[i as usize].blocks(a, b))
    }

    /// Where the straight move from `a` to `b` first crosses a wall.
    pub fn first_contact(&self, a: Vec2, b: Vec2) -> Option<Contact> {
        let mut first: Option<Contact> = None;
        self.lookup.any(a, b, |i| {
            let edge = self.edges[i as usize];
            if edge.blocks(a, b) {
                let share = edge.share_of(a, b);
                if first.is_none_or(|contact| share < contact.share) {
                    first = Some(Contact { share, edge });
                }
            }
            false
        });
        first
    }

    /// A quick conservative test whether a wall may lie within `reach` of the straight move from `a` to `b`.
    pub fn may_touch(&self, a: Vec2, b: Vec2, reach: f32) -> bool {
        self.lookup.nearby(a, a.distance(b) + reach)
    }

    /// Distance from `p` to the nearest wall; infinite without walls.
    pub fn distance(&self, p: Vec2) -> f32 {
        let near = |s: &Edge| stroke::distance_to_segment(p, s.from, s.to);
        self.edges.iter().map(near).fold(f32::INFINITY, f32::min)
    }
}

#[cfg(test)]
pub(crate) mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::constraint::{Wall, Window};
    use crate::math::rng::{Purpose, Stream};

    pub(crate) fn wall(points: &[[f32; 2]], thickness: f32) -> ActiveWall {
        let wall = Wall { thickness, ..Wall::new(points.to_vec()) };
        wall.active(Window::ALWAYS).unwrap()
    }

    #[test]
    fn a_way_is_blocked_by_what_it_crosses_and_by_the_ends_it_touches() {
        let wall = wall(&[[0.5, 0.25], [0.5, 0.75]], 0.01);
        let barriers = Barriers::new(&[&wall], Vec2::ONE);
        let blocks = |a: [f32; 2], b: [f32; 2]| barriers.blocks(a.into(), b.into());
        assert!(blocks([0.25, 0.5], [0.75, 0.5]));
        assert!(blocks([0.25, 0.75], [0.75, 0.75]), "through the very end");
        assert!(!blocks([0.25, 0.76], [0.75, 0.76]));
        assert!(!blocks([0.5, 0.5], [0.9, 0.1]), "from the wall itself");
        assert!(!blocks([0.1, 0.1], [0.4, 0.9]));
        let contact = barriers.first_contact(Vec2::new(0.4, 0.5), Vec2::new(0.8, 0.5)).unwrap();
        assert!((contact.share - 0.25).abs() < 1e-6);
    }

    #[test]
    fn a_gap_that_counts_as_closed_is_told_and_walls_that_meet_or_stand_apart_are_not() {
        let upright = |x: f32, from: f32, to: f32| wall(&[[x, from], [x, to]], 0.02);
        let (lower, upper) = (upright(0.5, 0.1, 0.5), upright(0.5, 0.515, 0.9));
        let gaps = Barriers::closed_gaps(&[&lower, &upper]);
        assert_eq!(gaps.len(), 1);
        let (ends, middle) = (gaps[0], Vec2::new(0.5, 0.5075));
        assert!((ends[0].midpoint(ends[1]) - middle).length() < 1e-4, "{ends:?}");
        let across = wall(&[[0.3, 0.5], [0.7, 0.5]], 0.02);
        for other in [upright(0.5, 0.53, 0.9), upright(0.5, 0.5, 0.9), across] {
            assert!(Barriers::closed_gaps(&[&lower, &other]).is_empty(), "{other:?}");
        }
        let almost = wall(&[[0.2, 0.2], [0.6, 0.2], [0.6, 0.6], [0.2, 0.6], [0.2, 0.21]], 0.02);
        assert!(!Barriers::closed_gaps(&[&almost]).is_empty(), "a loop that is not quite closed");
    }

    #[test]
    fn moves_of_any_length_are_tested_in_finite_time() {
        let wall = wall(&[[0.5, 0.25], [0.5, 0.75]], 0.01);
        let barriers = Barriers::new(&[&wall], Vec2::ONE);
        for far in [1e6, 1e12, 1e37] {
            for (y, blocked) in [(0.5, true), (0.9, false)] {
                assert_eq!(barriers.blocks(Vec2::new(-far, y), Vec2::new(far, y)), blocked, "{far}");
            }
        }
        for wrong in [f32::INFINITY, f32::NEG_INFINITY, f32::NAN] {
            for point in [Vec2::new(wrong, 0.5), Vec2::new(0.5, wrong), Vec2::splat(wrong)] {
                assert!(!barriers.blocks(Vec2::new(0.4, 0.5), point) && !barriers.blocks(point, point));
                assert!(barriers.first_contact(point, Vec2::new(0.6, 0.5)).is_none());
            }
        }
    }

    #[test]
    fn the_lookup_finds_what_a_search_through_all_finds() {
        let mut random = Stream::new(3, Purpose::Trace, 0, 0);
        let mut point =
            |scale: f32| [scale * random.f32() + 0.5 - 0.5 * scale, scale * random.f32() + 0.5 - 0.5 * scale];
        let walls: Vec<ActiveWall> =
            (0..30).map(|_| wall(&[point(1.2), point(1.2), point(1.2)], 1e-3)).collect();
        let barriers = Barriers::new(&walls.iter().collect::<Vec<_>>(), Vec2::ONE);
        for i in 0..20_000 {
            let scale = if i % 2 == 0 { 1.0 } else { 3.0 };
            let (a, b) = (Vec2::from(point(scale)), Vec2::from(point(scale)));
            let b = if i % 3 == 0 { a + 0.01 * (b - a) } else { b };
            let all = barriers.edges.iter().any(|edge| edge.blocks(a, b));
            assert_eq!(barriers.blocks(a, b), all, "{a} to {b}");
        }
    }
}
