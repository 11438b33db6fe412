//! The step of the classical Runge-Kutta method of order 4.

use glam::Vec2;

/// N photons at `c` after a step of length `h`, and the radius about each within which it was evaluated. `velocities` are those at
/// the begin (0), the middle (1) and the end (2) of the step.
#[inline(always)]
pub(super) fn runge_kutta<const N: usize>(
    h: f32,
    c: [Vec2; N],
    velocities: impl Fn(usize, [Vec2; N]) -> [Vec2; N],
) -> ([Vec2; N], [f32; N]) {
    let moved = |k: [Vec2; N], by: f32| std::array::from_fn(|i| c[i] + by * k[i]);
    let k1 = velocities(0, c);
    let k2 = velocities(1, moved(k1, 0.5 * h));
    let k3 = velocities(1, moved(k2, 0.5 * h));
    let k4 = velocities(2, moved(k3, h));
    let by: [Vec2; N] = std::array::from_fn(|i| (h / 6.0) * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
    let reach = std::array::from_fn(|i| {
        let halves = 0.25 * k1[i].length_squared().max(k2[i].length_squared());
        (h * h * halves.max(k3[i].length_squared())).max(by[i].length_squared()).sqrt()
    });
    (std::array::from_fn(|i| c[i] + by[i]), reach)
}
