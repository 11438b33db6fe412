//! The lines that no light crosses, as geometry: which straight ways they block, and where.
//!
//! Whether two segments cross is decided by exact orientation predicates (Shewchuk 1997, crate `robust`), so that no
//! photon slips through by rounding: a way is blocked where its ends lie strictly on different sides of a wall's segment
//! and it meets that segment, its two ends included. A point exactly on a wall may leave it to either side.

mod lookup;
mod weld;

use glam::{DVec2, Vec2};
use robust::{Coord, orient2d};

use super::stroke;
use super::wall::ActiveWall;
use lookup::Lookup;

/// All wall segments of one moment, with a grid to find those near a way.
pub struct Barriers {
    segments: Vec<Segment>,
    lookup: Lookup,
    notes: Vec<String>,
}

/// A straight piece of a wall, or of what closes a narrow gap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// Where it begins.
    pub from: Vec2,
    /// Where it ends.
    pub to: Vec2,
}

/// Where a way first meets a wall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// Share of the way before it, 0..=1.
    pub share: f32,
    /// The piece of wall that is met.
    pub segment: Segment,
}

impl Barriers {
    /// The walls on the rectangle `extent`, with the gaps closed that are narrower than their thickness.
    pub fn new(walls: &[&ActiveWall], extent: Vec2) -> Self {
        let (bridges, notes) = weld::bridges(walls, extent);
        let drawn = walls.iter().flat_map(|wall| wall.points.windows(2)).map(|pair| [pair[0], pair[1]]);
        let segments: Vec<Segment> = drawn
            .chain(bridges)
            .filter(|[from, to]| from != to)
            .map(|[from, to]| Segment { from, to })
            .collect();
        let lookup = Lookup::new(&segments, extent);
        Self { segments, lookup, notes }
    }

    /// What the artist should know: gaps that were closed.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// Whether the straight way from `a` to `b` crosses a wall.
    pub fn blocks(&self, a: Vec2, b: Vec2) -> bool {
        self.lookup.any(a, b, |i| self.segments[i as usize].blocks(a, b))
    }

    /// Where the straight way from `a` to `b` first crosses a wall.
    pub fn first_contact(&self, a: Vec2, b: Vec2) -> Option<Contact> {
        let mut first: Option<Contact> = None;
        self.lookup.any(a, b, |i| {
            let segment = self.segments[i as usize];
            if segment.blocks(a, b) {
                let share = segment.share_of(a, b);
                if first.is_none_or(|contact| share < contact.share) {
                    first = Some(Contact { share, segment });
                }
            }
            false
        });
        first
    }

    /// Whether a wall may be within `reach` of the straight way from `a` to `b`: never wrong with no, quick.
    pub fn may_touch(&self, a: Vec2, b: Vec2, reach: f32) -> bool {
        self.lookup.nearby(a, a.distance(b) + reach)
    }

    /// Distance from `p` to the nearest wall; infinite without walls.
    pub fn distance(&self, p: Vec2) -> f32 {
        let near = |s: &Segment| stroke::distance_to_segment(p, s.from, s.to);
        self.segments.iter().map(near).fold(f32::INFINITY, f32::min)
    }
}

impl Segment {
    /// Whether the way from `a` to `b` crosses this piece.
    #[inline]
    fn blocks(&self, a: Vec2, b: Vec2) -> bool {
        let (p, q) = (coord(self.from), coord(self.to));
        let (a, b) = (coord(a), coord(b));
        let (side_a, side_b) = (orient2d(p, q, a), orient2d(p, q, b));
        if side_a * side_b >= 0.0 {
            return false;
        }
        let (side_p, side_q) = (orient2d(a, b, p), orient2d(a, b, q));
        side_p.signum() * side_q.signum() <= 0.0 || side_p == 0.0 || side_q == 0.0
    }

    /// Share of the way from `a` to `b` before it meets the line of this piece, which it crosses.
    fn share_of(&self, a: Vec2, b: Vec2) -> f32 {
        let (p, q) = (coord(self.from), coord(self.to));
        let (side_a, side_b) = (orient2d(p, q, coord(a)).abs(), orient2d(p, q, coord(b)).abs());
        (side_a / (side_a + side_b)) as f32
    }

    /// Direction of the piece, of length 1.
    pub fn direction(&self) -> Vec2 {
        let way: DVec2 = self.to.as_dvec2() - self.from.as_dvec2();
        way.normalize_or_zero().as_vec2()
    }
}

fn coord(p: Vec2) -> Coord<f64> {
    Coord { x: f64::from(p.x), y: f64::from(p.y) }
}

#[cfg(test)]
mod tests {
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
            let all = barriers.segments.iter().any(|segment| segment.blocks(a, b));
            assert_eq!(barriers.blocks(a, b), all, "{a} to {b}");
        }
    }
}
