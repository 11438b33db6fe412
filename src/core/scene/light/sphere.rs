//! A Lambertian sphere.

use std::f32::consts::PI;

use glam::Vec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::common::{Common, Illumination, LightRole, check_lamp};
use super::emission::{Cone, Emission, Emitter, Sphere};
use crate::Result;
use crate::scene::Ray;
use crate::setting::schema::Describe;
use crate::setting::{Setting, settings};

/// A ball of light.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(transform = Describe(Common::SETTINGS), transform = Describe(Self::SETTINGS))]
pub struct SphereLight {
    /// Its name.
    pub name: String,
    /// What it does in the picture.
    pub role: LightRole,
    /// Whether it shines ([`Common::ENABLED`]).
    pub enabled: bool,
    /// Power to all sides together (W).
    pub watts: f32,
    /// Factor on the power, linear Rec.709.
    pub colour: [f32; 3],
    /// Its centre, world (m).
    pub position: [f32; 3],
    /// Its radius (m).
    pub radius: f32,
}

settings! { SphereLight {
    /// Radius of the ball. Larger balls cast softer caustics.
    RADIUS = Setting::real("scene.lights[sphere].radius", [1e-6, 1e5], &[0.05]).unit("m");
} }

impl Default for SphereLight {
    fn default() -> Self {
        Self {
            name: Common::DEFAULT_NAME.into(),
            role: LightRole::default(),
            enabled: Common::ENABLED.is_on(),
            watts: Common::WATTS.value(),
            colour: Common::COLOUR.value(),
            position: Common::POSITION.value(),
            radius: Self::RADIUS.value(),
        }
    }
}

impl SphereLight {
    pub(super) fn check(&self, place: &str) -> Result<()> {
        check_lamp(place, self.watts, self.colour, self.position)?;
        Self::RADIUS.check(self.radius, place)
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
