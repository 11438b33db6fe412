//! Polished metal: specular reflection from both sides, coloured by its reflectance.

use glam::Vec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Beam;
use super::fresnel::{facing_normals, reflect};
use crate::Result;
use crate::scene::{Hit, check};

/// A mirror.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Mirror {
    /// Share of light it reflects, linear Rec.709, 0 to 1, at every angle. Default 0.95.
    pub reflectance: [f32; 3],
}

impl Default for Mirror {
    fn default() -> Self {
        Self { reflectance: [0.95; 3] }
    }
}

impl Mirror {
    pub(super) fn check(&self, place: &str) -> Result<()> {
        check::within(place, "reflectance", &self.reflectance, 0.0, 1.0)
    }

    pub(super) fn scatter(&self, hit: &Hit, direction: Vec3, beam: &mut Beam) -> Vec3 {
        beam.weight *= Vec3::from(self.reflectance);
        let (geometric, shading) = facing_normals(hit, direction);
        let reflected = reflect(direction, shading);
        if reflected.dot(geometric) > 0.0 { reflected } else { reflect(direction, geometric) }
    }
}
