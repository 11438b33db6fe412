//! A flat panel that shines to one side after Lambert's law, like a window or a soft box.

use std::f32::consts::PI;

use glam::Vec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::common::{Common, Illumination, LightRole, check_lamp, check_target, frame};
use super::emission::{Emission, Emitter, Sphere};
use crate::Result;
use crate::scene::Ray;
use crate::setting::schema::Describe;
use crate::setting::{Setting, settings};

/// A rectangle of light. Its width lies horizontal where it can.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(transform = Describe(Common::SETTINGS), transform = Describe(Self::SETTINGS))]
pub struct RectangleLight {
    /// Its name.
    pub name: String,
    /// What it does in the picture.
    pub role: LightRole,
    /// Whether it shines ([`Common::ENABLED`]).
    pub enabled: bool,
    /// Power of the whole panel (W).
    pub watts: f32,
    /// Factor on the power, linear Rec.709.
    pub colour: [f32; 3],
    /// Its centre, world (m).
    pub position: [f32; 3],
    /// The point it faces, world (m).
    pub target: [f32; 3],
    /// Width and height (m).
    pub size: [f32; 2],
}

settings! { RectangleLight {
    /// Width and height of the panel. Larger panels cast softer caustics.
    SIZE = Setting::vector("scene.lights[rectangle].size", [1e-6, 1e5], &[0.5, 0.5]).unit("m");
} }

impl Default for RectangleLight {
    fn default() -> Self {
        Self {
            name: Common::DEFAULT_NAME.into(),
            role: LightRole::default(),
            enabled: Common::ENABLED.is_on(),
            watts: Common::WATTS.value(),
            colour: Common::COLOUR.value(),
            position: Common::POSITION.value(),
            target: Common::TARGET.value(),
            size: Self::SIZE.value(),
        }
    }
}

impl RectangleLight {
    pub(super) fn check(&self, place: &str) -> Result<()> {
        check_lamp(place, self.watts, self.colour, self.position)?;
        Self::SIZE.check(self.size, place)?;
        check_target(place, self.position, self.target)
    }

    /// Normal and the two half edges.
    fn axes(&self) -> (Vec3, Vec3, Vec3) {
        let normal = (Vec3::from(self.target) - Vec3::from(self.position)).normalize_or(Vec3::NEG_Y);
        let x = normal.cross(Vec3::Y).try_normalize().unwrap_or_else(|| frame(normal).0);
        let y = x.cross(normal);
        (normal, x * (self.size[0] / 2.0), y * (self.size[1] / 2.0))
    }

    /// Its corners, one after the other, world (m).
    pub fn corners(&self) -> [Vec3; 4] {
        let (_, x, y) = self.axes();
        let centre = Vec3::from(self.position);
        [centre - x - y, centre + x - y, centre + x + y, centre - x + y]
    }

    /// Its bounding sphere.
    pub(super) fn bounding_sphere(&self) -> Sphere {
        let radius = glam::Vec2::from(self.size).length() / 2.0;
        Sphere { centre: self.position.into(), radius }
    }

    fn radiance(&self) -> Vec3 {
        Vec3::from(self.colour) * (self.watts / (PI * self.size[0] * self.size[1]))
    }

    pub(super) fn emission(&self, target: Option<Sphere>) -> Emission {
        let (normal, half_x, half_y) = self.axes();
        let surface = Emitter::Rectangle { centre: self.position.into(), half_x, half_y, normal };
        Emission::of_surface(surface, Vec3::from(self.colour) * self.watts, target)
    }

    pub(super) fn illuminate(&self, point: Vec3, u: [f32; 2]) -> Option<Illumination> {
        let (normal, half_x, half_y) = self.axes();
        let place = Vec3::from(self.position) + half_x * (2.0 * u[0] - 1.0) + half_y * (2.0 * u[1] - 1.0);
        let distance = place.distance(point);
        let direction = (place - point) / distance;
        let cosine = -direction.dot(normal);
        let area = self.size[0] * self.size[1];
        (cosine > 0.0).then(|| Illumination {
            direction,
            distance,
            irradiance: self.radiance() * (cosine * area / (distance * distance)),
        })
    }

    pub(super) fn intersect(&self, ray: &Ray) -> Option<(f32, Vec3)> {
        // Nearly all rays pass by; its axes take longer to find than that.
        if !self.bounding_sphere().intersects(ray) {
            return None;
        }
        let (normal, half_x, half_y) = self.axes();
        let against = -ray.direction.dot(normal);
        let t = (ray.origin - Vec3::from(self.position)).dot(normal) / against;
        let offset = ray.origin + ray.direction * t - Vec3::from(self.position);
        let within = |half: Vec3| offset.dot(half).abs() <= half.length_squared();
        (against > 0.0 && t > 0.0 && within(half_x) && within(half_y)).then(|| (t, self.radiance()))
    }
}
