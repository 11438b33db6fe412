//! A point that shines evenly to all sides.

use std::f32::consts::PI;

use glam::Vec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::common::{Common, Illumination, LightRole, check_lamp};
use super::emission::{Cone, Emission, Source, Sphere};
use crate::Result;
use crate::setting::schema::Describe;

/// A point light.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(transform = Describe(Common::SETTINGS))]
pub struct PointLight {
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
    /// World (m).
    pub position: [f32; 3],
}

impl Default for PointLight {
    fn default() -> Self {
        Self {
            name: Common::DEFAULT_NAME.into(),
            role: LightRole::default(),
            enabled: Common::ENABLED.is_on(),
            watts: Common::WATTS.value(),
            colour: Common::COLOUR.value(),
            position: Common::POSITION.value(),
        }
    }
}

impl PointLight {
    pub(super) fn check(&self, place: &str) -> Result<()> {
        check_lamp(place, self.watts, self.colour, self.position)
    }

    pub(super) fn emission(&self, target: Option<Sphere>) -> Emission {
        let origin = Vec3::from(self.position);
        let cone = target.map_or(Cone::ALL, |sphere| sphere.subtended_cone(origin));
        let share = cone.solid_angle() / (4.0 * PI);
        Emission {
            flux: Vec3::from(self.colour) * (self.watts * share),
            source: Source::Point { origin, cone },
        }
    }

    pub(super) fn illuminate(&self, point: Vec3) -> Option<Illumination> {
        let offset = Vec3::from(self.position) - point;
        let distance = offset.length();
        let intensity = Vec3::from(self.colour) * (self.watts / (4.0 * PI));
        (distance > 0.0).then(|| Illumination {
            direction: offset / distance,
            distance,
            irradiance: intensity / (distance * distance),
        })
    }
}
