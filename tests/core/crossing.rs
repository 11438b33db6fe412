//! Whether a photon's way crosses a wall, for the tests that judge tracks; knows nothing of the program.

use glam::Vec2;

/// Twice the area of the triangle, positive to the left.
fn side(p: Vec2, q: Vec2, r: Vec2) -> f64 {
    let (p, q, r) = (p.as_dvec2(), q.as_dvec2(), r.as_dvec2());
    (q - p).perp_dot(r - p)
}

/// Whether the way from `a` to `b` goes from one side of the segment to the other. The products of differences of
/// single precision numbers are exact in double precision to 1e-16.
pub(crate) fn crosses(a: Vec2, b: Vec2, p: Vec2, q: Vec2) -> bool {
    let different = |s: f64, t: f64| s.min(t) < -1e-15 && s.max(t) > 1e-15;
    different(side(p, q, a), side(p, q, b)) && different(side(a, b, p), side(a, b, q))
}
