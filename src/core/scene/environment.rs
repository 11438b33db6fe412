//! The sky: a gradient of radiance that the camera, mirrors and glass see. It casts no caustics.

use glam::Vec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::check;
use crate::Result;

/// A sky of three colours, linear Rec.709 radiance [W/(sr m^2)].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct EnvironmentDesc {
    /// Straight up. Default 0.
    pub zenith: [f32; 3],
    /// At the horizon. Default 0.
    pub horizon: [f32; 3],
    /// Below the horizon, where no floor hides it. Default 0.
    pub ground: [f32; 3],
}

impl Default for EnvironmentDesc {
    fn default() -> Self {
        Self { zenith: [0.0; 3], horizon: [0.0; 3], ground: [0.0; 3] }
    }
}

impl EnvironmentDesc {
    /// Radiance that arrives from `direction` (unit): from horizon to zenith with the sine of the elevation.
    pub fn radiance(&self, direction: Vec3) -> Vec3 {
        let end = if direction.y >= 0.0 { self.zenith } else { self.ground };
        Vec3::from(self.horizon).lerp(end.into(), direction.y.abs().min(1.0))
    }

    /// Refuses negative or non-finite radiance.
    pub fn check(&self, place: &str) -> Result<()> {
        check::within(place, "zenith", &self.zenith, 0.0, 1e6)?;
        check::within(place, "horizon", &self.horizon, 0.0, 1e6)?;
        check::within(place, "ground", &self.ground, 0.0, 1e6)
    }
}
