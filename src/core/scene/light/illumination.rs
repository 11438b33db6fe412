//! The light that falls on a point, for shadow rays.

use glam::Vec3;

/// The illumination of a point by one light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Illumination {
    /// Unit vector from the point to the light.
    pub direction: Vec3,
    /// Distance to the light (m); infinite for a directional one.
    pub distance: f32,
    /// RGB irradiance on a surface that faces it [W/m^2]; for area lights an unbiased sample.
    pub irradiance: Vec3,
}
