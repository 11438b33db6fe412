//! Camera paths that look for the plane of the receiver: directly, through glass and in mirrors.

use glam::{Vec2, Vec3, vec2};

use super::sampler::{Sampler, tent};
use crate::math::rng::Stream;
use crate::scene::material::{Beam, Material, Way};
use crate::scene::{Hit, Media, Ray, Scene};

/// Factor on the samples of a pixel that sees glass or a mirror, where paths branch.
const SPECULAR_FACTOR: u32 = 4;
/// Most surfaces of a path.
const MAX_SURFACES: usize = 32;
/// Throughput below which a way is not followed for itself but chosen at random: less than the reflection of a wall of glass.
pub(super) const FAINT: f32 = 0.02;

/// A point of the plane that a camera path sees.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seen {
    /// Plane units.
    pub(super) point: Vec2,
    /// Radiance of the path per irradiance at the point: throughput and reflectance.
    pub(super) weight: Vec3,
    /// Whether the path met glass first.
    pub(super) in_glass: bool,
}

/// The camera paths of a picture.
pub(super) struct CameraSampler<'a> {
    scene: &'a Scene,
    media: Media,
    width: usize,
    height: usize,
}

/// A path that is still to be followed.
struct Open {
    ray: Ray,
    beam: Beam,
    surfaces: usize,
    in_glass: bool,
}

impl<'a> CameraSampler<'a> {
    /// The paths of a picture of `[width, height]` pixels.
    pub(super) fn new(scene: &'a Scene, [width, height]: [usize; 2]) -> Self {
        Self { scene, media: scene.media_at(scene.camera().position), width, height }
    }

    /// The ray through a point of the picture, in pixels from the upper left corner.
    pub(super) fn ray(&self, at: Vec2) -> Ray {
        let size = vec2(self.width as f32, self.height as f32);
        let place = at / size * 2.0 - 1.0;
        self.scene.camera().ray(place.x, -place.y, size.x / size.y)
    }

    /// The points that `samples` samples of a pixel see, or more samples where it sees glass or a mirror; returns their number.
    pub(super) fn pixel(
        &self,
        [x, y]: [usize; 2],
        samples: u32,
        mut rng: Stream,
        see: &mut dyn FnMut(Seen),
    ) -> u32 {
        let sampler = Sampler::new(rng.u32());
        let corner = vec2(x as f32 + 0.5, y as f32 + 0.5);
        let (mut index, mut wanted) = (0, samples);
        while index < wanted {
            let specular = self.sample(corner + tent(sampler.pair(index, 0)), &mut rng, see);
            index += 1;
            if specular && wanted == samples {
                wanted *= SPECULAR_FACTOR;
            }
        }
        wanted
    }

    /// The points that one sample sees; whether it met a specular surface. Ways that branch are followed both, down to
    /// faint ones.
    fn sample(&self, at: Vec2, rng: &mut Stream, see: &mut dyn FnMut(Seen)) -> bool {
        let ray = self.ray(at);
        let Some(first) = self.scene.intersect(&ray) else { return false };
        let material = self.scene.material(first.surface);
        let in_glass = matches!(material, Material::Glass(_));
        let start = Open { ray, beam: Beam::new(Vec3::ONE, self.media), surfaces: 0, in_glass };
        let mut rest = Vec::new();
        let mut next = Some((start, Some(first)));
        while let Some((path, hit)) = next.take().or_else(|| rest.pop().map(|path| (path, None))) {
            self.follow(path, hit, rng, &mut rest, see);
        }
        material.is_specular()
    }

    /// Follows one path to its end; other ways at its branches go to `rest`.
    fn follow(
        &self,
        Open { mut ray, mut beam, surfaces, in_glass }: Open,
        mut known: Option<Hit>,
        rng: &mut Stream,
        rest: &mut Vec<Open>,
        see: &mut dyn FnMut(Seen),
    ) {
        let scene = self.scene;
        for surface in surfaces..MAX_SURFACES {
            let Some(hit) = known.take().or_else(|| scene.intersect(&ray)) else { return };
            beam.travel(scene.meshes(), hit.t);
            let material = scene.material(hit.surface);
            if let Material::Diffuse(diffuse) = material {
                let is_lit_side = ray.direction.dot(hit.geometric_normal) < 0.0;
                if hit.surface.is_ground() && is_lit_side {
                    let weight = beam.weight * Vec3::from(diffuse.albedo) / std::f32::consts::PI;
                    see(Seen { point: scene.receiver().plane_from_world(hit.point), weight, in_glass });
                }
                return;
            }
            let [way, other]: [Option<Way>; 2] =
                material.split(scene.geometry(), &hit, ray.direction, beam, FAINT, rng);
            rest.extend(other.map(|(direction, beam)| Open {
                ray: Ray::leaving(&hit, direction),
                beam,
                surfaces: surface + 1,
                in_glass,
            }));
            let Some((direction, light)) = way else { return };
            (ray, beam) = (Ray::leaving(&hit, direction), light);
        }
    }
}
