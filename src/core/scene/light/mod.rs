//! Light sources. One kind, one file: values, `check`, how photons leave it ([`Emission`]), how it lights a point.
//!
//! Power is in watts and colour a factor on it, so a lamp of 10 W and colour (1, 0.5, 0) sends out 10 W of red and 5 W
//! of green. Only the sun-like directional light, which has no total, is given by its irradiance. Lights stand in
//! nobody's way: photons and camera rays pass them.

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

pub use common::{Common, Illumination};
pub use directional::DirectionalLight;
pub use emission::{Ball, Emission};
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
    /// The artist's name for it.
    pub fn name(&self) -> &str {
        match self {
            Self::Point(light) => &light.name,
            Self::Spot(light) => &light.name,
            Self::Directional(light) => &light.name,
            Self::Rectangle(light) => &light.name,
            Self::Sphere(light) => &light.name,
        }
    }

    /// Where it stands, world [m]; none for a directional one.
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

    /// How its photons leave: those that may meet the ball `target`, or all of them. `world` encloses the scene.
    pub fn emission(&self, target: Option<Ball>, world: Ball) -> Emission {
        match self {
            Self::Point(light) => light.emission(target),
            Self::Spot(light) => light.emission(target),
            Self::Directional(light) => light.emission(target, world),
            Self::Rectangle(light) => light.emission(target),
            Self::Sphere(light) => light.emission(target),
        }
    }

    /// Whether any of its photons starts in the box between two corners, perhaps.
    pub(crate) fn touches(&self, lower: Vec3, upper: Vec3) -> bool {
        let ball = match self {
            Self::Point(light) => Ball { centre: light.position.into(), radius: 0.0 },
            Self::Spot(light) => Ball { centre: light.position.into(), radius: 0.0 },
            Self::Directional(_) => return false,
            Self::Rectangle(light) => light.ball(),
            Self::Sphere(light) => light.ball(),
        };
        ball.centre.distance_squared(ball.centre.clamp(lower, upper)) <= ball.radius * ball.radius
    }

    /// How it lights `point` (world), for shadow rays; `u` picks the place on lights that have a size, uniform in
    /// [0, 1)^2. None where it sends no light.
    pub fn illuminate(&self, point: Vec3, u: [f32; 2]) -> Option<Illumination> {
        match self {
            Self::Point(light) => light.illuminate(point),
            Self::Spot(light) => light.illuminate(point),
            Self::Directional(light) => light.illuminate(u),
            Self::Rectangle(light) => light.illuminate(point, u),
            Self::Sphere(light) => light.illuminate(point, u),
        }
    }

    /// Distance and radiance [W/(sr m^2)] where a ray meets the light itself; none for lights without a size.
    pub fn intersect(&self, ray: &super::Ray) -> Option<(f32, Vec3)> {
        match self {
            Self::Point(_) | Self::Spot(_) | Self::Directional(_) => None,
            Self::Rectangle(light) => light.intersect(ray),
            Self::Sphere(light) => light.intersect(ray),
        }
    }
}
