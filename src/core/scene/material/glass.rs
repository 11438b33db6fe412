//! Glass: refraction and reflection by Fresnel, absorption by Beer-Lambert, optional dispersion.
//!
//! Solids may overlap, such as wine that reaches a little into its glass: the mesh of higher priority fills the overlap, and
//! the other's surface within it has no effect (Schmidt & Budge 2002). Meshes should be closed; behind an open sheet the
//! solid never ends.

use glam::Vec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Beam;
use super::dispersion::sample_wavelength;
use super::fresnel::{facing_normals, fresnel, reflect, refract};
use crate::Result;
use crate::math::rng::Stream;
use crate::scene::{Hit, Mesh, SurfaceId};
use crate::setting::schema::Describe;
use crate::setting::{Setting, settings};

/// Fraunhofer lines d, F and C [um], between which the Abbe number is defined.
const LINE_D: f32 = 0.587_56;
const LINE_F: f32 = 0.486_13;
const LINE_C: f32 = 0.656_27;

/// Clear or coloured glass.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(transform = Describe(Self::SETTINGS))]
pub struct Glass {
    /// Index of refraction at 587.6 nm.
    pub ior: f32,
    /// Absorption per metre, linear Rec.709.
    pub absorption: [f32; 3],
    /// Abbe number.
    pub dispersion: Option<f32>,
}

settings! { Glass {
    /// Index of refraction at 587.6 nm: water 1.33, window glass 1.52, diamond 2.42. Higher bends light more.
    IOR = Setting::real("scene.meshes[].material.ior", [1.0, 4.0], &[1.5]);
    /// Absorption, linear Rec.709: light falls to exp(-absorption x metres). The glass has the colour it absorbs least.
    ABSORPTION = Setting::colour("scene.meshes[].material.absorption", [0.0, 1e6], &[0.0; 3]).unit("1/m");
    /// Abbe number; none for no dispersion. Smaller spreads the colours more: crown glass 60, flint 36.
    DISPERSION = Setting::real("scene.meshes[].material.dispersion", [5.0, 1000.0], &[]);
} }

impl Default for Glass {
    fn default() -> Self {
        Self {
            ior: Self::IOR.value(),
            absorption: Self::ABSORPTION.value(),
            dispersion: Self::DISPERSION.value(),
        }
    }
}

impl Glass {
    pub(super) fn check(&self, place: &str) -> Result<()> {
        Self::IOR.check(self.ior, place)?;
        Self::ABSORPTION.check(self.absorption, place)?;
        Self::DISPERSION.check(self.dispersion, place)
    }

    /// Index of refraction at a wavelength (nm) by Cauchy's two-term equation n = A + B / lambda^2, fixed by index and
    /// Abbe number V = (n_d - 1) / (n_F - n_C); without dispersion or wavelength it is `ior`.
    pub fn index(&self, wavelength: Option<f32>) -> f32 {
        let (Some(abbe), Some(nm)) = (self.dispersion, wavelength) else { return self.ior };
        let inverse_square = |um: f32| 1.0 / (um * um);
        let b = (self.ior - 1.0) / (abbe * (inverse_square(LINE_F) - inverse_square(LINE_C)));
        self.ior + b * (inverse_square(nm / 1000.0) - inverse_square(LINE_D))
    }

    /// RGB transmittance over `distance` (m).
    pub fn transmittance(&self, distance: f32) -> Vec3 {
        if self.absorption == [0.0; 3] {
            return Vec3::ONE;
        }
        (Vec3::from(self.absorption) * -distance).exp()
    }

    pub(super) fn scatter(
        &self,
        meshes: &[Mesh],
        hit: &Hit,
        direction: Vec3,
        beam: &mut Beam,
        rng: &mut Stream,
    ) -> Vec3 {
        let SurfaceId::Mesh(mesh) = hit.surface else { return direction };
        let entering = direction.dot(hit.geometric_normal) < 0.0;
        let (mut before, mut after) = (beam.media, beam.media);
        if entering {
            after.enter(mesh);
        } else if !after.leave(mesh) {
            before.enter(mesh);
        }
        if before.filling(meshes) == after.filling(meshes) {
            beam.media = after;
            return direction;
        }
        if self.dispersion.is_some() && beam.wavelength.is_none() {
            let (nm, colour) = sample_wavelength(beam.weight, rng);
            beam.weight = colour;
            beam.wavelength = Some(nm);
        }
        let index =
            |media: &super::Media| media.glass(meshes).map_or(1.0, |glass| glass.index(beam.wavelength));
        let eta = index(&after) / index(&before);
        let (next, through) = scatter_at_boundary(hit, direction, eta, rng.f32());
        beam.media = if through { after } else { before };
        next
    }
}

/// Reflection with the Fresnel probability, else refraction; whether it went through. The geometric normal replaces the
/// shading normal where that would lead to the wrong side of the surface, so that no energy is lost or gained.
fn scatter_at_boundary(hit: &Hit, direction: Vec3, eta: f32, choice: f32) -> (Vec3, bool) {
    let (geometric, shading) = facing_normals(hit, direction);
    for normal in [shading, geometric] {
        let cos_i = -direction.dot(normal);
        let (reflectance, cos_t) = fresnel(cos_i, eta);
        if choice < reflectance {
            let next = reflect(direction, normal);
            if next.dot(geometric) > 0.0 {
                return (next, false);
            }
        } else {
            let next = refract(direction, normal, cos_i, cos_t, eta);
            if next.dot(geometric) < 0.0 {
                return (next, true);
            }
        }
    }
    (direction, true) // Exactly along the surface: passes straight on.
}
