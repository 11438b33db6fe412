//! Materials. One kind, one file: values, `check`, `scatter`.

mod diffuse;
mod dispersion;
pub mod fresnel;
mod glass;
mod mirror;

use glam::Vec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use diffuse::Diffuse;
pub use dispersion::{VISIBLE_NM, rgb_of_wavelength};
pub use glass::Glass;
pub use mirror::Mirror;

use super::{Hit, Media, Mesh};
use crate::Result;
use crate::math::rng::Stream;
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
        Choice { value: "", help: "the materials of the MTL file beside the mesh, one object for each" },
        Choice { value: "diffuse", help: "matt: scatters light evenly; caustics end here" },
        Choice { value: "mirror", help: "polished metal" },
        Choice { value: "glass", help: "clear or coloured glass, water, crystal" },
    ]);
} }

/// The light carried along a path: flux for a photon, throughput for a camera path.
#[derive(Clone, Debug)]
pub struct Beam {
    /// RGB, linear Rec.709.
    pub weight: Vec3,
    /// The glass solids around it.
    pub media: Media,
    /// Its wavelength (nm) after dispersive glass; none while white.
    pub wavelength: Option<f32>,
}

impl Beam {
    /// A beam that starts in the given solids.
    pub fn new(weight: Vec3, media: Media) -> Self {
        Self { weight, media, wavelength: None }
    }

    /// Absorption over `distance` (m) (Beer-Lambert); exactly none in clear glass and air.
    pub fn travel(&mut self, meshes: &[Mesh], distance: f32) {
        if let Some(glass) = self.media.glass(meshes) {
            self.weight *= glass.transmittance(distance);
        }
    }
}

impl Material {
    /// Whether it casts caustics.
    pub fn is_specular(&self) -> bool {
        match self {
            Self::Diffuse(_) => false,
            Self::Mirror(_) | Self::Glass(_) => true,
        }
    }

    /// The next direction (unit) of a path along `direction` at `hit`, sampled in proportion to energy; updates colour, media
    /// and wavelength of the beam. None for a matt surface, where specular paths end.
    pub fn scatter(
        &self,
        meshes: &[Mesh],
        hit: &Hit,
        direction: Vec3,
        beam: &mut Beam,
        rng: &mut Stream,
    ) -> Option<Vec3> {
        match self {
            Self::Diffuse(_) => None,
            Self::Mirror(mirror) => Some(mirror.scatter(hit, direction, beam)),
            Self::Glass(glass) => Some(glass.scatter(meshes, hit, direction, beam, rng)),
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
