//! The sun: light from one direction, or from a small disk of the sky.

use glam::Vec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::common::{Common, Illumination, LightRole};
use super::emission::{Cone, Emission, Source, Sphere};
use crate::Result;
use crate::scene::check;
use crate::setting::schema::Describe;
use crate::setting::{ANY, Setting, settings};

/// A directional light. It is infinitely far and has no total power: its strength is an irradiance.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(transform = Describe(Common::SETTINGS), transform = Describe(Self::SETTINGS))]
pub struct DirectionalLight {
    /// Its name.
    pub name: String,
    /// What it does in the picture.
    pub role: LightRole,
    /// Whether it shines ([`Common::ENABLED`]).
    pub enabled: bool,
    /// Irradiance on a surface that faces it [W/m^2].
    pub irradiance: f32,
    /// Factor on the irradiance, linear Rec.709.
    pub colour: [f32; 3],
    /// Where the light goes; any length but 0.
    pub direction: [f32; 3],
    /// Angular diameter of the disk in the sky, degrees.
    pub angle_deg: f32,
}

settings! { DirectionalLight {
    /// Irradiance on a surface that faces the light; sunlight has about 1000.
    IRRADIANCE = Setting::real("scene.lights[directional].irradiance", [0.0, 1e9], &[10.0]).unit("W/m²");
    /// Where the light goes, not where it comes from; any length but 0.
    DIRECTION = Setting::vector("scene.lights[directional].direction", ANY, &[0.0, -1.0, 0.0]);
    /// Angular diameter of the disk in the sky; the sun has 0.53, 0 is perfectly parallel. Wider is softer.
    ANGLE = Setting::real("scene.lights[directional].angle_deg", [0.0, 90.0], &[0.0]).unit("°");
} }

impl Default for DirectionalLight {
    fn default() -> Self {
        Self {
            name: Common::DEFAULT_NAME.into(),
            role: LightRole::default(),
            enabled: Common::ENABLED.is_on(),
            irradiance: Self::IRRADIANCE.value(),
            colour: Common::COLOUR.value(),
            direction: Self::DIRECTION.value(),
            angle_deg: Self::ANGLE.value(),
        }
    }
}

impl DirectionalLight {
    pub(super) fn check(&self, place: &str) -> Result<()> {
        Self::IRRADIANCE.check(self.irradiance, place)?;
        Common::COLOUR.check(self.colour, place)?;
        check::direction(place, "direction", self.direction)?;
        Self::ANGLE.check(self.angle_deg, place)
    }

    fn sun(&self) -> Cone {
        let one_minus_cos = 2.0 * (self.angle_deg.to_radians() / 4.0).sin().powi(2);
        Cone { axis: Vec3::from(self.direction).normalize_or(Vec3::NEG_Y), one_minus_cos }
    }

    /// Normal irradiance, integrated over the disk. A disk of even radiance L gives
    /// E = L pi sin^2(a) on a surface that faces its middle, and L x solid angle = E x 2 / (1 + cos a) here.
    fn normal_irradiance(&self) -> Vec3 {
        Vec3::from(self.colour) * (self.irradiance * 2.0 / (2.0 - self.sun().one_minus_cos))
    }

    pub(super) fn emission(&self, target: Option<Sphere>, world: Sphere) -> Emission {
        let target = target.unwrap_or(world);
        let area = std::f32::consts::PI * target.radius * target.radius;
        // Any point of the disk, moved back by this, lies outside the world.
        let distance = world.centre.distance(target.centre) + world.radius + target.radius;
        Emission {
            flux: self.normal_irradiance() * area,
            source: Source::Parallel { sun: self.sun(), target, distance },
        }
    }

    pub(super) fn illuminate(&self, u: [f32; 2]) -> Option<Illumination> {
        let direction = -self.sun().direction(u);
        Some(Illumination { direction, distance: f32::INFINITY, irradiance: self.normal_irradiance() })
    }
}
