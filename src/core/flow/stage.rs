//! One moment of a step: everything that moves photons there.

use glam::Vec2;

use super::field::Field;

/// The velocity at one of the times that RK4 asks for, and how much it counts.
pub(super) struct Stage {
    /// The fitted field, taken to this time.
    pub field: Field,
    /// The turbulence at this time, one field per grid; none costs nothing.
    pub noise: Vec<Field>,
    /// (1-s)/(1-t).
    pub rate: f32,
}

impl Stage {
    /// The velocity u at `p`, in plane units per unit of t.
    #[inline(always)]
    pub(super) fn velocity(&self, p: Vec2) -> Vec2 {
        let [velocity] = self.velocities([p]);
        velocity
    }

    /// As [`Self::velocity`] at some points.
    #[inline(always)]
    pub(super) fn velocities<const N: usize>(&self, p: [Vec2; N]) -> [Vec2; N] {
        let mut velocities = self.field.velocities(p);
        for noise in &self.noise {
            let swirls = noise.velocities(p);
            (0..N).for_each(|i| velocities[i] += swirls[i]);
        }
        velocities
    }
}
