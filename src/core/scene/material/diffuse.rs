//! Matt surfaces: the same radiance in all directions (Lambert). Caustic photons end here.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::Result;
use crate::setting::schema::Describe;
use crate::setting::{Setting, settings};

/// A matt surface.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(transform = Describe(Self::SETTINGS))]
pub struct Diffuse {
    /// Share of light it gives back, linear Rec.709.
    pub albedo: [f32; 3],
}

settings! { Diffuse {
    /// Share of light the surface gives back, linear Rec.709.
    ALBEDO = Setting::colour("scene.meshes[].material.albedo", [0.0, 1.0], &[0.8, 0.8, 0.8]);
} }

impl Default for Diffuse {
    fn default() -> Self {
        Self { albedo: Self::ALBEDO.value() }
    }
}

impl Diffuse {
    pub(super) fn check(&self, place: &str) -> Result<()> {
        Self::ALBEDO.check(self.albedo, place)
    }
}
