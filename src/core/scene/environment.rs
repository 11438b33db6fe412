//! The sky: a gradient of radiance that the camera, mirrors and glass see. It casts no caustics.

use glam::Vec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::Result;
use crate::setting::schema::Describe;
use crate::setting::{Setting, settings};

/// A sky of three colours, linear Rec.709 radiance [W/(sr m^2)].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(transform = Describe(Self::SETTINGS))]
pub struct EnvironmentDesc {
    /// Radiance from straight up.
    pub zenith: [f32; 3],
    /// Radiance from the horizon.
    pub horizon: [f32; 3],
    /// Radiance from below the horizon, where no floor hides it.
    pub ground: [f32; 3],
}

settings! { EnvironmentDesc {
    /// Light from straight up, linear Rec.709 radiance. It casts no caustics.
    ZENITH = Setting::colour("scene.environment.zenith", [0.0, 1e6], &[0.0; 3]).unit("W/(sr m²)");
    /// Light from the horizon, linear Rec.709 radiance.
    HORIZON = Setting::colour("scene.environment.horizon", [0.0, 1e6], &[0.0; 3]).unit("W/(sr m²)");
    /// Light from below the horizon where no floor hides it, linear Rec.709 radiance.
    GROUND = Setting::colour("scene.environment.ground", [0.0, 1e6], &[0.0; 3]).unit("W/(sr m²)");
} }

impl Default for EnvironmentDesc {
    fn default() -> Self {
        Self { zenith: Self::ZENITH.value(), horizon: Self::HORIZON.value(), ground: Self::GROUND.value() }
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
        Self::ZENITH.check(self.zenith, place)?;
        Self::HORIZON.check(self.horizon, place)?;
        Self::GROUND.check(self.ground, place)
    }
}
