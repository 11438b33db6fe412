//! The domains of emission guiding: which rays of which light go to which caster.

use crate::math::rng::Stream;
use crate::scene::light::{Emission, Sphere};
use crate::scene::{Media, Ray, Scene};

/// Most casters with bounding spheres of their own; more of them share one.
const MAX_CASTERS: usize = 16;

/// How emission is importance-sampled. All have the same expectation; only their cost differs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EmissionGuiding {
    /// All the light of every source.
    Unguided,
    /// Towards the bounding spheres of glass and mirrors.
    Bounds,
    /// By the cells from which trial photons reached the receiver; all paths are followed to their end.
    Cells,
    /// By these cells, and paths that hardly ever land are ended early, where that pays; the default.
    Learned,
}

/// The rays from one light that meet the bounding sphere of one caster and none of the spheres before it.
#[derive(serde::Deserialize, serde::Serialize)]
pub(super) struct Domain {
    pub light: u16,
    pub emission: Emission,
    /// The sphere of the caster; none for the rays to everywhere.
    target: Option<Sphere>,
    /// Spheres whose rays belong to other domains.
    before: Vec<Sphere>,
    /// Whether photons may start inside glass.
    in_glass: bool,
}

impl Domain {
    /// The ray of a point of the square and the glass it starts in; none if no photon leaves there.
    pub(super) fn sample(&self, scene: &Scene, u: [f32; 2], rng: &mut Stream) -> Option<(Ray, Media)> {
        let ray = self.emission.sample(u, rng)?;
        // A lamp's own cone, where it is the narrower one, also holds rays past the sphere: those are of other domains.
        let is_past = self.target.is_some_and(|sphere| !sphere.intersects(&ray));
        if is_past || self.before.iter().any(|sphere| sphere.intersects(&ray)) {
            return None;
        }
        let media = if self.in_glass { scene.media_at(ray.origin) } else { Media::default() };
        Some((ray, media))
    }

    /// Power of its rays (W), the mean of the channels.
    pub(super) fn power(&self) -> f64 {
        self.emission.flux.as_dvec3().element_sum() / 3.0
    }
}

/// The domains: one for each light and caster.
pub(super) fn domains(scene: &Scene, guiding: EmissionGuiding) -> Vec<Domain> {
    let (lower, upper) = scene.bounds();
    let world = Sphere::around_box(lower, upper);
    let specular = || scene.meshes().iter().filter(|mesh| mesh.material.is_specular());
    let mut casters: Vec<Sphere> = specular().map(|mesh| mesh.bounding_sphere()).collect();
    if casters.len() > MAX_CASTERS {
        let lower = specular().map(|mesh| mesh.lower).fold(lower, glam::Vec3::min);
        let upper = specular().map(|mesh| mesh.upper).fold(upper, glam::Vec3::max);
        casters = vec![Sphere::around_box(lower, upper)];
    }
    let mut domains = Vec::new();
    let lights = scene.lights().iter().enumerate();
    for (light, desc) in lights.filter(|(_, desc)| desc.casts_caustics()) {
        let in_glass = specular().any(|mesh| desc.overlaps_box(mesh.lower, mesh.upper));
        let domain = |target, before: &[Sphere]| Domain {
            light: light as u16,
            emission: desc.emission(target, world),
            target,
            before: before.to_vec(),
            in_glass,
        };
        match guiding {
            EmissionGuiding::Unguided => domains.push(domain(None, &[])),
            EmissionGuiding::Bounds | EmissionGuiding::Cells | EmissionGuiding::Learned => {
                domains.extend((0..casters.len()).map(|i| domain(Some(casters[i]), &casters[..i])));
            }
        }
    }
    domains
}
