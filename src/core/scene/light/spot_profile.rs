//! How the light of a spot fades towards the edge of its cone.

use std::f32::consts::TAU;

use glam::Vec3;

/// Relative intensity by direction, 0..=1.
#[derive(Clone, Debug)]
pub(super) struct Profile {
    pub axis: Vec3,
    /// 1 - cosine where the fading begins and ends.
    pub inner: f32,
    pub outer: f32,
}

impl Profile {
    /// Smoothstep in the cosine of the angle; its mean over the soft edge is one half.
    pub(super) fn at(&self, direction: Vec3) -> f32 {
        // 1 - cosine by the chord: accurate for narrow cones too.
        let off = (direction - self.axis).length_squared() / 2.0;
        if off <= self.inner {
            return 1.0;
        }
        let x = ((self.outer - off) / (self.outer - self.inner)).clamp(0.0, 1.0);
        x * x * (3.0 - 2.0 * x)
    }

    /// Integral over all directions [sr].
    pub(super) fn solid_angle(&self) -> f32 {
        TAU * (self.inner + self.outer) / 2.0
    }
}
