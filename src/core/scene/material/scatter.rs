//! Scattering: the light of a path and where it goes from a surface.
//!
//! Solids may overlap, such as wine that reaches a little into its glass: the mesh of higher priority fills the overlap, and
//! the other's surface within it has no effect (Schmidt & Budge 2002). Surfaces that lie in one another are one boundary
//! (`scene::contact`). Meshes should be closed; behind an open sheet the solid never ends.

use glam::Vec3;

use super::dispersion::sample_wavelength;
use super::fresnel::{facing_normals, fresnel, reflect, refract};
use super::{Glass, Material, Mirror};
use crate::math::rng::Stream;
use crate::scene::{Geometry, Hit, Media, Mesh, SurfaceId};

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
    /// The next direction (unit) of a path along `direction` at `hit`, sampled in proportion to energy; updates colour, media
    /// and wavelength of the beam. None for a matt surface, where specular paths end.
    pub fn scatter(
        &self,
        geometry: &Geometry,
        hit: &Hit,
        direction: Vec3,
        beam: &mut Beam,
        rng: &mut Stream,
    ) -> Option<Vec3> {
        match self {
            Self::Diffuse(_) => None,
            Self::Mirror(mirror) => Some(mirror.scatter(hit, direction, beam)),
            Self::Glass(glass) => Some(glass.scatter(geometry, hit, direction, beam, rng)),
        }
    }
}

/// A way on from a surface: its direction (unit) and the light that takes it.
pub type Way = (Vec3, Beam);

impl Material {
    /// As [`Self::scatter`], but both ways from glass, each with its share of the light, instead of one chosen at random. Where
    /// the fainter would have less than `least` of any colour, one is chosen all the same.
    pub fn split(
        &self,
        geometry: &Geometry,
        hit: &Hit,
        direction: Vec3,
        mut beam: Beam,
        least: f32,
        rng: &mut Stream,
    ) -> [Option<Way>; 2] {
        match self {
            Self::Diffuse(_) => [None, None],
            Self::Mirror(mirror) => {
                let next = mirror.scatter(hit, direction, &mut beam);
                [Some((next, beam)), None]
            }
            Self::Glass(glass) => glass.split(geometry, hit, direction, beam, least, rng),
        }
    }
}

impl Mirror {
    fn scatter(&self, hit: &Hit, direction: Vec3, beam: &mut Beam) -> Vec3 {
        beam.weight *= Vec3::from(self.reflectance);
        let (geometric, shading) = facing_normals(hit, direction);
        let reflected = reflect(direction, shading);
        if reflected.dot(geometric) > 0.0 { reflected } else { reflect(direction, geometric) }
    }
}

impl Glass {
    fn scatter(
        &self,
        geometry: &Geometry,
        hit: &Hit,
        direction: Vec3,
        beam: &mut Beam,
        rng: &mut Stream,
    ) -> Vec3 {
        let Some(boundary) = Boundary::met(self, geometry, hit, direction, beam, rng) else {
            return direction;
        };
        boundary.cross(hit, direction, rng.f32(), beam)
    }

    fn split(
        &self,
        geometry: &Geometry,
        hit: &Hit,
        direction: Vec3,
        mut beam: Beam,
        least: f32,
        rng: &mut Stream,
    ) -> [Option<Way>; 2] {
        let Some(boundary) = Boundary::met(self, geometry, hit, direction, &mut beam, rng) else {
            return [Some((direction, beam)), None];
        };
        let reflected = boundary.reflectance(hit, direction);
        if beam.weight.max_element() * reflected.min(1.0 - reflected) < least {
            let next = boundary.cross(hit, direction, rng.f32(), &mut beam);
            return [Some((next, beam)), None];
        }
        // A choice at random within each way's share of all choices: together they are all of them.
        let mut way = |from: f32, share: f32| {
            let mut beam = beam.clone();
            beam.weight *= share;
            let next = boundary.cross(hit, direction, from + share * rng.f32(), &mut beam);
            Some((next, beam))
        };
        [way(reflected, 1.0 - reflected), way(0.0, reflected)]
    }
}

/// A boundary between two media that a ray meets.
struct Boundary {
    before: Media,
    after: Media,
    /// Index of refraction after it over that before it.
    eta: f32,
}

impl Boundary {
    /// The boundary that a ray meets at a hit of `glass`; none where the glass changes nothing. A beam that meets dispersive glass gets its
    /// wavelength, one that passes straight on its media.
    fn met(
        glass: &Glass,
        geometry: &Geometry,
        hit: &Hit,
        direction: Vec3,
        beam: &mut Beam,
        rng: &mut Stream,
    ) -> Option<Self> {
        let inward = direction.dot(hit.geometric_normal) < 0.0;
        let (mut before, mut after) = (beam.media, beam.media);
        match hit.surface {
            SurfaceId::Mesh(mesh) if inward => after.enter(mesh),
            SurfaceId::Mesh(mesh) => {
                if !after.leave(mesh) {
                    before.enter(mesh);
                }
            }
            other => geometry.cross_contact(other, inward, (&mut before, &mut after)),
        }
        let meshes = geometry.meshes();
        if before.filling(meshes) == after.filling(meshes) {
            beam.media = after;
            return None;
        }
        let disperses = match hit.surface {
            SurfaceId::Contact(_) => [&before, &after]
                .iter()
                .any(|media| media.glass(meshes).is_some_and(|glass| glass.dispersion.is_some())),
            _ => glass.dispersion.is_some(),
        };
        if disperses && beam.wavelength.is_none() {
            let (nm, colour) = sample_wavelength(beam.weight, rng);
            beam.weight = colour;
            beam.wavelength = Some(nm);
        }
        let index = |media: &Media| media.glass(meshes).map_or(1.0, |glass| glass.index(beam.wavelength));
        Some(Self { eta: index(&after) / index(&before), before, after })
    }

    /// The reflectance by the shading normal: the share of choices for which a ray is reflected, silhouettes apart.
    fn reflectance(&self, hit: &Hit, direction: Vec3) -> f32 {
        let (_, shading) = facing_normals(hit, direction);
        fresnel(-direction.dot(shading), self.eta).0
    }

    /// The direction that a ray takes by a `choice` in [0, 1); updates the media of the beam.
    fn cross(&self, hit: &Hit, direction: Vec3, choice: f32, beam: &mut Beam) -> Vec3 {
        let (next, through) = scatter_at_boundary(hit, direction, self.eta, choice);
        beam.media = if through { self.after } else { self.before };
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
