//! A point that shines evenly to all sides.

use std::f32::consts::PI;

use glam::Vec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::emission::{Cone, Source};
use super::{Emission, Illumination, Sphere, check_power};
use crate::Result;
use crate::scene::check;

/// A point light.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct PointLight {
    /// Shown in the list of caustics. Default "light".
    pub name: String,
    /// Power to all sides together [W], 0 to 1e9. Default 10.
    pub watts: f32,
    /// Factor on the power, linear Rec.709, 0 to 1000. Default white.
    pub colour: [f32; 3],
    /// World [m]. Default (0, 2, 0).
    pub position: [f32; 3],
}

impl Default for PointLight {
    fn default() -> Self {
        Self { name: "light".into(), watts: 10.0, colour: [1.0; 3], position: [0.0, 2.0, 0.0] }
    }
}

impl PointLight {
    pub(super) fn check(&self, place: &str) -> Result<()> {
        check_power(place, self.watts, self.colour)?;
        check::within(place, "position", &self.position, -1e6, 1e6)
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
