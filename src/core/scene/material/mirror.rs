//! Polished metal: specular reflection from both sides, coloured by its reflectance.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::Result;
use crate::setting::schema::Describe;
use crate::setting::{Setting, settings};

/// A mirror.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(transform = Describe(Self::SETTINGS))]
pub struct Mirror {
    /// Share of light it reflects, linear Rec.709.
    pub reflectance: [f32; 3],
}

settings! { Mirror {
    /// Share of light the surface reflects at every angle, linear Rec.709.
    REFLECTANCE = Setting::colour("scene.meshes[].material.reflectance", [0.0, 1.0], &[0.95, 0.95, 0.95]);
} }

impl Default for Mirror {
    fn default() -> Self {
        Self { reflectance: Self::REFLECTANCE.value() }
    }
}

impl Mirror {
    pub(super) fn check(&self, place: &str) -> Result<()> {
        Self::REFLECTANCE.check(self.reflectance, place)
    }
}
