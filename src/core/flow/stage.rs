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
        let mut velocity = self.field.velocity(p);
        for noise in &self.noise {
            velocity += noise.velocity(p);
        }
        velocity
    }
}
