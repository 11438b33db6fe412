//! One light path: from a light over glass and mirrors until it lands or is lost. The mean of a photon's channels stays
//! constant: losses at surfaces and in glass end whole photons by Russian roulette (Arvo & Kirk 1990), so that all that
//! land have equal flux, but for what a [`Watch`] changes.

use glam::{DVec3, Vec2, Vec3};

use crate::math::rng::Stream;
use crate::scene::material::Beam;
use crate::scene::{Hit, Media, Ray, Scene, SurfaceId};

/// Most surfaces of a path. Light trapped in a block of glass by total reflection ends here.
const MAX_SURFACES: usize = 256;
/// Surfaces after which true normals replace smooth ones. Smooth normals on coarse facets can trap light in a cycle of total
/// reflections that a smooth body, by reversibility, does not have; true normals let it out.
const SMOOTH_SURFACES: usize = 32;

/// The part of the caustics that is traced.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Deserialize, serde::Serialize)]
pub enum LightPart {
    /// What flows: on the receiver, within its soft border.
    Flowing,
    /// All that is shown: on the receiver and the floor beside it.
    Shown,
}

impl LightPart {
    /// Its share of the light at a point of the plane.
    fn share(self, scene: &Scene, place: Vec2) -> f32 {
        match self {
            Self::Flowing => scene.receiver().flowing_share(place),
            Self::Shown => scene.receiver().shown_share(place),
        }
    }
}

/// A caustic photon on the receiver, or on the floor beside it.
pub(super) struct Landing {
    pub position: Vec2,
    pub flux: Vec3,
    pub mesh: u16,
}

/// The balance of the lights' flux (W) per channel. `emitted` is the sum of all others, to rounding.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Deserialize, serde::Serialize)]
pub struct FluxBalance {
    /// Sent towards glass and mirrors.
    pub emitted: DVec3,
    /// Fell on the receiver after a specular surface: the caustics.
    pub landed: DVec3,
    /// Fell around the light that is traced, after a specular surface: on the receiver's soft border, or the floor.
    pub surround: DVec3,
    /// Left the scene after a specular surface.
    pub escaped: DVec3,
    /// Ended on a matt mesh or the back of the receiver after a specular surface.
    pub blocked: DVec3,
    /// Absorbed by coloured glass and mirrors.
    pub absorbed: DVec3,
    /// Cut off after 256 surfaces.
    pub capped: DVec3,
    /// On paths that were ended early, as they hardly ever land, less what the others of their kind carry for them: zero but
    /// for noise.
    pub ended: DVec3,
    /// Met no specular surface.
    pub direct: DVec3,
    /// Number of rays of all candidates.
    pub rays: u64,
}

impl FluxBalance {
    fn fluxes(&mut self) -> [&mut DVec3; 9] {
        let Self { emitted, landed, surround, escaped, blocked, absorbed, capped, ended, direct, .. } = self;
        [emitted, landed, surround, escaped, blocked, absorbed, capped, ended, direct]
    }

    /// Whether any light met a specular surface.
    pub(super) fn met_specular(&self) -> bool {
        (self.emitted - self.direct).max_element() > 1e-12 * self.emitted.max_element()
    }

    /// Adds another balance.
    pub(super) fn add(&mut self, mut other: Self) {
        for (column, more) in self.fluxes().into_iter().zip(other.fluxes()) {
            *column += *more;
        }
        self.rays += other.rays;
    }

    /// The balance with all flux times a factor.
    pub(super) fn scaled(mut self, factor: f64) -> Self {
        self.fluxes().into_iter().for_each(|column| *column *= factor);
        self
    }
}

/// The light of a path: what is left of it, and the flux to which roulette restores its mean.
pub(super) struct Carried<'a> {
    pub weight: &'a mut Vec3,
    pub flux: &'a mut Vec3,
}

/// Watches paths at every surface that sends them on.
pub(super) trait Watch {
    /// A path starts, with this flux over that of one from an active cell.
    fn starts(&mut self, _factor: f32) {}

    /// Whether the path goes on along a ray; it may then carry other light.
    fn goes_on(&mut self, ray: &Ray, light: Carried, rng: &mut Stream, balance: &mut FluxBalance) -> bool;

    /// The path ends.
    fn ends(&mut self, _landed: bool) {}
}

/// Nobody watches.
pub(super) struct Unwatched;

impl Watch for Unwatched {
    fn goes_on(&mut self, _: &Ray, _: Carried, _: &mut Stream, _: &mut FluxBalance) -> bool {
        true
    }
}

/// Follows a photon of `flux` along `ray`, from a light in `media`, and records its end in the balance.
pub(super) fn follow(
    (scene, part): (&Scene, LightPart),
    mut ray: Ray,
    (mut flux, media): (Vec3, Media),
    watch: &mut impl Watch,
    rng: &mut Stream,
    balance: &mut FluxBalance,
) -> Option<Landing> {
    let mut beam = Beam::new(flux, media);
    let mut last_specular = None;
    balance.emitted += flux.as_dvec3();
    for surface in 0..MAX_SURFACES {
        balance.rays += 1;
        let Some(mut hit) = scene.intersect(&ray) else {
            let end = if last_specular.is_some() { &mut balance.escaped } else { &mut balance.direct };
            *end += beam.weight.as_dvec3();
            return None;
        };
        if surface >= SMOOTH_SURFACES {
            hit.shading_normal = hit.geometric_normal;
        }
        let arriving = beam.weight;
        beam.travel(scene.meshes(), hit.t);
        let next = match scene.mesh_of(hit.surface) {
            Some(mesh) => {
                let material = &scene.meshes()[usize::from(mesh)].material;
                let next = material.scatter(scene.geometry(), &hit, ray.direction, &mut beam, rng);
                last_specular = next.map(|_| mesh).or(last_specular);
                next
            }
            None => None,
        };
        let survived = roulette(&mut beam.weight, flux, rng);
        balance.absorbed += (arriving - beam.weight).as_dvec3();
        if !survived {
            return None;
        }
        match (next, last_specular) {
            (Some(direction), _) => {
                ray = Ray::leaving(&hit, direction);
                let light = Carried { weight: &mut beam.weight, flux: &mut flux };
                if !watch.goes_on(&ray, light, rng, balance) {
                    return None;
                }
            }
            (None, None) => {
                balance.direct += beam.weight.as_dvec3();
                return None;
            }
            (None, Some(mesh)) => {
                let place = scene.receiver().plane_from_world(hit.point);
                let is_shown = lies_in(part.share(scene, place), rng);
                return land(place, (&hit, &ray), is_shown, (beam.weight, mesh), balance);
            }
        }
    }
    balance.capped += beam.weight.as_dvec3();
    None
}

/// Russian roulette: restores the mean of the channels to that of `flux`, or ends the photon; whether it survived.
fn roulette(weight: &mut Vec3, flux: Vec3, rng: &mut Stream) -> bool {
    let left = weight.element_sum() / flux.element_sum();
    if left > 0.999_999 {
        return true;
    }
    let survived = rng.f32() < left;
    *weight = if survived { *weight / left } else { Vec3::ZERO };
    survived
}

/// Whether a photon belongs to a part that has this share of the light where it fell.
fn lies_in(share: f32, rng: &mut Stream) -> bool {
    share >= 1.0 || (share > 0.0 && rng.f32() < share)
}

/// The end of a caustic photon on a matt surface; `is_in` tells whether it belongs to the part that is traced.
fn land(
    position: Vec2,
    (hit, ray): (&Hit, &Ray),
    is_in: bool,
    (flux, mesh): (Vec3, u16),
    balance: &mut FluxBalance,
) -> Option<Landing> {
    let lit = ray.direction.dot(hit.geometric_normal) < 0.0;
    let column = match hit.surface {
        SurfaceId::Receiver | SurfaceId::Floor if lit && is_in => {
            balance.landed += flux.as_dvec3();
            return Some(Landing { position, flux, mesh });
        }
        SurfaceId::Receiver | SurfaceId::Floor if lit => &mut balance.surround,
        SurfaceId::Mesh(_) | SurfaceId::Contact(_) | SurfaceId::Receiver | SurfaceId::Floor => {
            &mut balance.blocked
        }
    };
    *column += flux.as_dvec3();
    None
}
