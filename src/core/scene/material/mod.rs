//! Materials. One kind, one file: values and `check`. Where light goes from there is in `scatter`, which needs all meshes.

mod diffuse;
mod dispersion;
pub mod fresnel;
mod glass;
mod mirror;
mod scatter;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use diffuse::Diffuse;
pub use dispersion::{VISIBLE_NM, rgb_of_wavelength};
pub use glass::Glass;
pub use mirror::Mirror;
pub use scatter::{Beam, Way};

use crate::Result;
use crate::setting::schema::Describe;
use crate::setting::{Choice, Setting, settings};

/// A material, as saved.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "type", rename_all = "snake_case")]
#[schemars(transform = Describe(Self::KIND))]
pub enum Material {
    /// Matt.
    Diffuse(Diffuse),
    /// Polished metal.
    Mirror(Mirror),
    /// Glass and other clear solids.
    Glass(Glass),
}

settings! { Material {
    /// Material of the whole mesh. Glass and mirrors cast the caustics.
    KIND = Setting::choice("scene.meshes[].material", &[
        Choice { value: "", help: "the materials of the file (of OBJ those of the MTL file beside it), one object for each" },
        Choice { value: "diffuse", help: "matt: scatters light evenly; caustics end here" },
        Choice { value: "mirror", help: "polished metal" },
        Choice { value: "glass", help: "clear or coloured glass, water, crystal" },
    ]);
} }

impl Material {
    /// Whether it casts caustics.
    pub fn is_specular(&self) -> bool {
        match self {
            Self::Diffuse(_) => false,
            Self::Mirror(_) | Self::Glass(_) => true,
        }
    }

    /// Refuses values out of range, naming `place.field`.
    pub fn check(&self, place: &str) -> Result<()> {
        match self {
            Self::Diffuse(diffuse) => diffuse.check(place),
            Self::Mirror(mirror) => mirror.check(place),
            Self::Glass(glass) => glass.check(place),
        }
    }
}
