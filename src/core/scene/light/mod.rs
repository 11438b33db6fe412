//! Light sources. One kind, one file: values, `check`, [`Emission`] of photons, [`Illumination`] of a point.
//!
//! Power is in watts and colour a factor on it, so a lamp of 10 W and colour (1, 0.5, 0) emits 10 W of red and 5 W of
//! green. Only the directional light, which has no total power, is given by its irradiance. Photons and camera rays pass
//! through lights.

mod common;
mod directional;
mod emission;
mod point;
mod rectangle;
mod sphere;
mod spot;

use glam::Vec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use common::{Common, Illumination, LightRole};
pub use directional::DirectionalLight;
pub use emission::{Emission, Sphere};
pub use point::PointLight;
pub use rectangle::RectangleLight;
pub use sphere::SphereLight;
pub use spot::SpotLight;

use crate::Result;
use crate::setting::schema::Describe;
use crate::setting::{Choice, Setting, settings};

/// A light, as saved.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "type", rename_all = "snake_case")]
#[schemars(transform = Describe(Self::KIND))]
pub enum LightDesc {
    /// A point.
    Point(PointLight),
    /// A cone from a point.
    Spot(SpotLight),
    /// The sun.
    Directional(DirectionalLight),
    /// A flat panel.
    Rectangle(RectangleLight),
    /// A ball.
    Sphere(SphereLight),
}

settings! { LightDesc {
    /// Kind of light. Small lights cast sharp caustics, large ones soft.
    KIND = Setting::choice("scene.lights[]", &[
        Choice { value: "point", help: "shines evenly to all sides from one point" },
        Choice { value: "spot", help: "a cone of light from one point" },
        Choice { value: "directional", help: "the sun: parallel light, or nearly" },
        Choice { value: "rectangle", help: "a flat panel that shines to one side" },
        Choice { value: "sphere", help: "a glowing ball" },
    ]).required();
} }

impl LightDesc {
    /// Its name in the project.
    pub fn name(&self) -> &str {
        match self {
            Self::Point(light) => &light.name,
            Self::Spot(light) => &light.name,
            Self::Directional(light) => &light.name,
            Self::Rectangle(light) => &light.name,
            Self::Sphere(light) => &light.name,
        }
    }

    /// Gives it another name.
    pub fn rename(&mut self, name: String) {
        match self {
            Self::Point(light) => light.name = name,
            Self::Spot(light) => light.name = name,
            Self::Directional(light) => light.name = name,
            Self::Rectangle(light) => light.name = name,
            Self::Sphere(light) => light.name = name,
        }
    }

    /// What it does in the picture.
    pub fn role(&self) -> LightRole {
        match self {
            Self::Point(light) => light.role,
            Self::Spot(light) => light.role,
            Self::Directional(light) => light.role,
            Self::Rectangle(light) => light.role,
            Self::Sphere(light) => light.role,
        }
    }

    /// Whether it shines.
    pub fn is_enabled(&self) -> bool {
        match self {
            Self::Point(light) => light.enabled,
            Self::Spot(light) => light.enabled,
            Self::Directional(light) => light.enabled,
            Self::Rectangle(light) => light.enabled,
            Self::Sphere(light) => light.enabled,
        }
    }

    /// Whether its light through glass and mirrors is traced: it is on, and not there for the background alone.
    pub fn casts_caustics(&self) -> bool {
        self.is_enabled() && self.role() != LightRole::Background
    }

    /// Its position, world (m); none for a directional one.
    pub fn position(&self) -> Option<Vec3> {
        match self {
            Self::Point(light) => Some(light.position.into()),
            Self::Spot(light) => Some(light.position.into()),
            Self::Directional(_) => None,
            Self::Rectangle(light) => Some(light.position.into()),
            Self::Sphere(light) => Some(light.position.into()),
        }
    }

    /// Refuses values out of range, naming `place.field`.
    pub fn check(&self, place: &str) -> Result<()> {
        match self {
            Self::Point(light) => light.check(place),
            Self::Spot(light) => light.check(place),
            Self::Directional(light) => light.check(place),
            Self::Rectangle(light) => light.check(place),
            Self::Sphere(light) => light.check(place),
        }
    }

    /// Its emission: of photons that may hit the sphere `target`, or of all. `world` encloses the scene. One that is off has no
    /// flux.
    pub fn emission(&self, target: Option<Sphere>, world: Sphere) -> Emission {
        let emission = match self {
            Self::Point(light) => light.emission(target),
            Self::Spot(light) => light.emission(target),
            Self::Directional(light) => light.emission(target, world),
            Self::Rectangle(light) => light.emission(target),
            Self::Sphere(light) => light.emission(target),
        };
        if self.is_enabled() { emission } else { Emission { flux: Vec3::ZERO, ..emission } }
    }

    /// Whether photons may start in the box between two corners.
    pub(crate) fn overlaps_box(&self, lower: Vec3, upper: Vec3) -> bool {
        let sphere = match self {
            Self::Point(light) => Sphere { centre: light.position.into(), radius: 0.0 },
            Self::Spot(light) => Sphere { centre: light.position.into(), radius: 0.0 },
            Self::Directional(_) => return false,
            Self::Rectangle(light) => light.bounding_sphere(),
            Self::Sphere(light) => light.sphere(),
        };
        sphere.centre.distance_squared(sphere.centre.clamp(lower, upper)) <= sphere.radius * sphere.radius
    }

    /// Whether the light is a ball around the box between two corners.
    pub(crate) fn encloses_box(&self, lower: Vec3, upper: Vec3) -> bool {
        let Self::Sphere(light) = self else { return false };
        let Sphere { centre, radius } = light.sphere();
        (centre - lower).abs().max((centre - upper).abs()).length() <= radius
    }

    /// The illumination of `point` (world), for shadow rays; `u`, uniform in [0, 1)^2, selects the point on area lights.
    /// None where it emits nothing.
    pub fn illuminate(&self, point: Vec3, u: [f32; 2]) -> Option<Illumination> {
        match self {
            _ if !self.is_enabled() => None,
            Self::Point(light) => light.illuminate(point),
            Self::Spot(light) => light.illuminate(point),
            Self::Directional(light) => light.illuminate(u),
            Self::Rectangle(light) => light.illuminate(point, u),
            Self::Sphere(light) => light.illuminate(point, u),
        }
    }

    /// Distance and radiance [W/(sr m^2)] where a ray hits the light itself; area lights that are on, only.
    pub fn intersect(&self, ray: &super::Ray) -> Option<(f32, Vec3)> {
        match self {
            _ if !self.is_enabled() => None,
            Self::Point(_) | Self::Spot(_) | Self::Directional(_) => None,
            Self::Rectangle(light) => light.intersect(ray),
            Self::Sphere(light) => light.intersect(ray),
        }
    }
}
