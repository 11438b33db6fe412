//! A Lambertian sphere.

use std::f32::consts::PI;

use glam::Vec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::emission::{Cone, Emitter};
use super::{Emission, Illumination, Sphere, check_power};
use crate::Result;
use crate::scene::{Ray, check};

/// A ball of light.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct SphereLight {
    /// Shown in the list of caustics. Default "light".
    pub name: String,
    /// Power to all sides together [W], 0 to 1e9. Default 10.
    pub watts: f32,
    /// Factor on the power, linear Rec.709, 0 to 1000. Default white.
    pub colour: [f32; 3],
    /// Its middle, world [m]. Default (0, 2, 0).
    pub position: [f32; 3],
    /// Its radius [m], 1e-6 to 1e5. Default 0.05.
    pub radius: f32,
}

impl Default for SphereLight {
    fn default() -> Self {
        let position = [0.0, 2.0, 0.0];
        Self { name: "light".into(), watts: 10.0, colour: [1.0; 3], position, radius: 0.05 }
    }
}

impl SphereLight {
    pub(super) fn check(&self, place: &str) -> Result<()> {
        check_power(place, self.watts, self.colour)?;
        check::within(place, "position", &self.position, -1e6, 1e6)?;
        check::within(place, "radius", &[self.radius], 1e-6, 1e5)
    }

    pub(super) fn sphere(&self) -> Sphere {
        Sphere { centre: self.position.into(), radius: self.radius }
    }

    fn radiance(&self) -> Vec3 {
        Vec3::from(self.colour) * (self.watts / (4.0 * PI * PI * self.radius * self.radius))
    }

    pub(super) fn emission(&self, target: Option<Sphere>) -> Emission {
        Emission::of_surface(Emitter::Sphere(self.sphere()), Vec3::from(self.colour) * self.watts, target)
    }

    /// By a uniform direction of the subtended cone.
    pub(super) fn illuminate(&self, point: Vec3, u: [f32; 2]) -> Option<Illumination> {
        let cone: Cone = self.sphere().subtended_cone(point);
        if cone.one_minus_cos >= 2.0 {
            return None; // Inside: it emits outward.
        }
        let direction = cone.direction(u);
        let (distance, radiance) = self.intersect(&Ray::new(point, direction)).unwrap_or_else(|| {
            let tangent = self.sphere().centre.distance_squared(point) - self.radius * self.radius;
            (tangent.max(0.0).sqrt(), self.radiance())
        });
        Some(Illumination { direction, distance, irradiance: radiance * cone.solid_angle() })
    }

    pub(super) fn intersect(&self, ray: &Ray) -> Option<(f32, Vec3)> {
        let sphere = self.sphere();
        let offset = sphere.centre - ray.origin;
        let along = offset.dot(ray.direction);
        let closest = (offset - ray.direction * along).length_squared();
        let reach = sphere.radius * sphere.radius - closest;
        if reach < 0.0 {
            return None;
        }
        let t = along - reach.sqrt();
        (t > 0.0).then(|| (t, self.radiance()))
    }
}
