//! Matt surfaces: the same radiance in all directions (Lambert). Caustic photons end here.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::Result;
use crate::scene::check;

/// A matt surface.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Diffuse {
    /// Share of light it gives back, linear Rec.709, 0 to 1. Default 0.8.
    pub albedo: [f32; 3],
}

impl Default for Diffuse {
    fn default() -> Self {
        Self { albedo: [0.8; 3] }
    }
}

impl Diffuse {
    pub(super) fn check(&self, place: &str) -> Result<()> {
        check::within(place, "albedo", &self.albedo, 0.0, 1.0)
    }
}
