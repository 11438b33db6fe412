//! The corners of the thickened walls, where shortest paths turn.
//!
//! Around an end, and around the outer side of a bend, the corners form the polygon that touches the circle of the
//! wall's clearance from outside; the edges of neighbouring corners meet the straight sides at that clearance, too.

use std::f32::consts::{FRAC_PI_4, PI};

use glam::Vec2;

use crate::constraint::barrier::Barriers;
use crate::constraint::stroke;
use crate::constraint::wall::ActiveWall;

/// Widest turn of the polygon at one corner.
const TURN: f32 = FRAC_PI_4;
/// Bends below this get no corner: over them, paths come closer to the wall by less than a hundredth of its thickness.
const STRAIGHT: f32 = 0.01;
/// Fractions of the clearance that are tried in order where other walls stand close.
const SHARES: [f32; 4] = [1.0, 0.5, 0.25, 0.125];
/// A corner keeps at least this share of its clearance from any wall.
const KEPT: f32 = 0.5;

/// A point where a path may turn.
#[derive(Clone, Copy, Debug, PartialEq, serde::Deserialize, serde::Serialize)]
pub(super) struct Corner {
    pub(super) at: Vec2,
    /// Unit direction towards the wall.
    inward: Vec2,
    /// Largest |cosine| between a path through here and `inward`; 1 where any path may turn here.
    cosine: f32,
    /// Within this distance paths may begin that are no tangents.
    close: f32,
}

impl Corner {
    /// Whether a shortest path may turn here that comes from or goes to `p`: such a path is a tangent of the thickened
    /// wall, neither towards the wall nor straight away from it.
    #[inline]
    pub(super) fn turns(&self, p: Vec2) -> bool {
        let path = p - self.at;
        let length = path.length();
        length < self.close || path.dot(self.inward).abs() <= self.cosine * length
    }
}

/// The corners of all walls that lie on the rectangle `extent`.
pub(super) fn corners(walls: &[&ActiveWall], barriers: &Barriers, extent: Vec2) -> Vec<Corner> {
    let mut found = Vec::new();
    for wall in walls {
        let line = stroke::simplify(&wall.points, 0.05 * wall.clearance);
        for i in 0..line.len() {
            let before = (i > 0).then(|| line[i] - line[i - 1]);
            let after = line.get(i + 1).map(|next| next - line[i]);
            let fan = Fan::new(line[i], before, after, wall.clearance);
            found.extend(fan.corners(barriers, extent));
        }
    }
    found
}

/// The corners around one point of a wall.
struct Fan {
    vertex: Vec2,
    /// Angle of the first side, and the turn from it to the second.
    start: f32,
    turn: f32,
    clearance: f32,
}

impl Fan {
    fn new(vertex: Vec2, before: Option<Vec2>, after: Option<Vec2>, clearance: f32) -> Self {
        let (start, turn) = match (before, after) {
            (Some(before), Some(after)) => {
                let turn = before.angle_to(after);
                // A left turn has its outer side on the right.
                let side = if turn > 0.0 { -before.perp() } else { before.perp() };
                (side.to_angle(), turn)
            }
            (Some(before), None) => (before.to_angle() - PI / 2.0, PI),
            (None, Some(after)) => (after.to_angle() + PI / 2.0, PI),
            (None, None) => (0.0, 0.0),
        };
        Self { vertex, start, turn, clearance }
    }

    fn corners(&self, barriers: &Barriers, extent: Vec2) -> Vec<Corner> {
        if self.turn.abs() < STRAIGHT {
            return Vec::new();
        }
        let count = (self.turn.abs() / TURN - 1e-3).ceil().max(1.0);
        let half = 0.5 * self.turn.abs() / count;
        let mut free = true;
        let mut found = Vec::new();
        for i in 0..count as usize {
            let outward = Vec2::from_angle(self.start + self.turn * (i as f32 + 0.5) / count);
            let at = |share: f32| self.vertex + outward * (share * self.clearance / half.cos());
            let fits = |share: &f32| self.fits(at(*share), *share, barriers, extent);
            let share = SHARES.into_iter().find(fits);
            free &= share == Some(1.0);
            found.extend(share.map(|share| (at(share), outward)));
        }
        let close = 1.5 * self.clearance;
        let cosine = if free { half.sin() + 0.02 } else { 1.0 };
        found.into_iter().map(|(at, outward)| Corner { at, inward: -outward, cosine, close }).collect()
    }

    /// Whether a corner has its place on the receiver, on this side of other walls and apart from them.
    fn fits(&self, at: Vec2, share: f32, barriers: &Barriers, extent: Vec2) -> bool {
        at.cmpge(Vec2::ZERO).all()
            && at.cmple(extent).all()
            && !barriers.blocks(self.vertex, at)
            && barriers.distance(at) >= KEPT * share * self.clearance
    }
}
