//! A straight piece of a wall, with exact orientation predicates (Shewchuk 1997, crate `robust`).

use glam::{DVec2, Vec2};
use robust::{Coord, orient2d};

/// A straight edge of a wall, or of a bridge that closes a narrow gap.
#[derive(Clone, Copy, Debug, PartialEq, serde::Deserialize, serde::Serialize)]
pub struct Edge {
    /// First point.
    pub from: Vec2,
    /// Last point.
    pub to: Vec2,
}

impl Edge {
    /// Whether the move from `a` to `b` crosses this edge.
    #[inline]
    pub(super) fn blocks(&self, a: Vec2, b: Vec2) -> bool {
        let (p, q) = (coord(self.from), coord(self.to));
        let (a, b) = (coord(a), coord(b));
        let (side_a, side_b) = (orient2d(p, q, a), orient2d(p, q, b));
        if side_a * side_b >= 0.0 {
            return false;
        }
        let (side_p, side_q) = (orient2d(a, b, p), orient2d(a, b, q));
        side_p.signum() * side_q.signum() <= 0.0 || side_p == 0.0 || side_q == 0.0
    }

    /// Fraction of the move from `a` to `b` before it meets the line of this edge, which it crosses.
    pub(super) fn share_of(&self, a: Vec2, b: Vec2) -> f32 {
        let (p, q) = (coord(self.from), coord(self.to));
        let (side_a, side_b) = (orient2d(p, q, coord(a)).abs(), orient2d(p, q, coord(b)).abs());
        (side_a / (side_a + side_b)) as f32
    }

    /// Unit direction.
    pub fn direction(&self) -> Vec2 {
        let along: DVec2 = self.to.as_dvec2() - self.from.as_dvec2();
        along.normalize_or_zero().as_vec2()
    }
}

fn coord(p: Vec2) -> Coord<f64> {
    Coord { x: f64::from(p.x), y: f64::from(p.y) }
}
