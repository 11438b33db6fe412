//! The guidance of a photon, Eq. (2): `v = (b - c) / (1 - t)`.
//!
//! The guidance v itself is integrated. With `c = b - (1-t) v`, the motion `c' = (1-s) u + s v` becomes
//!
//! ```text
//! v' = (1-s)/(1-t) (v - u(c, t))
//! ```
//!
//! whose right side is bounded for all t <= 1, so that any method with any step size ends at c(1) = b to rounding, where
//! plain Runge-Kutta in c divides by zero at its last stage.

use glam::Vec2;

/// Guidance from `positions` to `targets` at time `t` < 1, Eq. (2).
pub fn guidance(positions: &[Vec2], targets: &[Vec2], t: f32) -> Vec<Vec2> {
    let per_time = 1.0 / (1.0 - t);
    positions.iter().zip(targets).map(|(&c, &b)| (b - c) * per_time).collect()
}

/// The position of a photon with guidance `v` to `target` at time `t`: Eq. (2) solved for c.
#[inline(always)]
pub(super) fn position(target: Vec2, v: Vec2, t: f32) -> Vec2 {
    target - v * (1.0 - t)
}

/// Mean straight distance |b - a|, the unit of speeds.
pub fn mean_straight(source: &[Vec2], target: &[Vec2]) -> f32 {
    let sum: f64 = source.iter().zip(target).map(|(a, b)| f64::from(a.distance(*b))).sum();
    (sum / source.len().max(1) as f64) as f32
}
