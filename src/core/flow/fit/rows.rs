//! The rows of A, D and N of Eq. (7).

use glam::Vec2;

/// Rows of A or D: velocities wanted at points, the term weight/2 sum |u(p) - v|^2.
#[derive(Clone, Copy)]
pub struct Rows<'a> {
    /// Points on the plane; one beyond the rectangle acts at the nearest border point, as in the field.
    pub positions: &'a [Vec2],
    /// Velocity wanted at each, plane units per unit of t.
    pub velocities: &'a [Vec2],
    /// 1/K for Term (3), beta/P for Term (6).
    pub weight: f64,
}

/// Rows of N: no flow through walls at points, the term weight/2 sum (n.u(p))^2.
#[derive(Clone, Copy)]
pub struct NoPenetrationRows<'a> {
    /// Points on the walls, plane units.
    pub positions: &'a [Vec2],
    /// Unit normals of the walls there.
    pub normals: &'a [Vec2],
    /// Weight omega of each.
    pub weight: f64,
}
