//! Emission: a map from the unit square to rays with area in proportion to flux, so that photons of equal flux are uniform
//! points of the square. Uneven emission is by rejection sampling.

use std::f32::consts::{PI, TAU};

use glam::{Vec2, Vec3, vec2};

use super::common::frame;
use crate::math::rng::Stream;
use crate::scene::Ray;

/// A sphere in world space (m).
#[derive(Clone, Copy, Debug, PartialEq, serde::Deserialize, serde::Serialize)]
pub struct Sphere {
    /// Its centre.
    pub centre: Vec3,
    /// Its radius.
    pub radius: f32,
}

impl Sphere {
    /// The bounding sphere of a box.
    pub fn around_box(lower: Vec3, upper: Vec3) -> Self {
        // A little larger than the box, so that rounding leaves no corner outside.
        Self { centre: (lower + upper) / 2.0, radius: (upper - lower).length() / 2.0 * 1.0001 + 1e-30 }
    }

    /// Whether a ray hits it.
    pub fn intersects(&self, ray: &Ray) -> bool {
        let offset = self.centre - ray.origin;
        let along = offset.dot(ray.direction);
        let closest = (offset - ray.direction * along).length_squared();
        let inside = offset.length_squared() <= self.radius * self.radius;
        inside || (along > 0.0 && closest <= self.radius * self.radius)
    }

    /// The cone that it subtends at `point`; from inside, all directions.
    pub(super) fn subtended_cone(&self, point: Vec3) -> Cone {
        let offset = self.centre - point;
        let distance = offset.length();
        if distance <= self.radius {
            return Cone::ALL;
        }
        let sine = self.radius / distance;
        Cone { axis: offset / distance, one_minus_cos: sine * sine / (1.0 + (1.0 - sine * sine).sqrt()) }
    }
}

/// A cone of directions: unit axis and 1 - cosine of its half angle.
#[derive(Clone, Copy, Debug, serde::Deserialize, serde::Serialize)]
pub(super) struct Cone {
    pub axis: Vec3,
    pub one_minus_cos: f32,
}

impl Cone {
    pub(super) const ALL: Self = Self { axis: Vec3::NEG_Y, one_minus_cos: 2.0 };

    /// Its solid angle [sr].
    pub(super) fn solid_angle(&self) -> f32 {
        TAU * self.one_minus_cos
    }

    /// The direction (unit) of a point of the unit square; area in proportion to solid angle.
    pub(super) fn direction(&self, u: [f32; 2]) -> Vec3 {
        let disk = disk(u);
        let height = disk.length_squared() * self.one_minus_cos; // 1 - cosine
        let across = disk * (self.one_minus_cos * (2.0 - height)).max(0.0).sqrt();
        let (x, y) = frame(self.axis);
        (x * across.x + y * across.y + self.axis * (1.0 - height)).normalize()
    }
}

/// The concentric, area-preserving map of the unit square to the unit disk (Shirley & Chiu 1997).
pub(super) fn disk(u: [f32; 2]) -> Vec2 {
    let (a, b) = (2.0 * u[0] - 1.0, 2.0 * u[1] - 1.0);
    if a == 0.0 && b == 0.0 {
        return Vec2::ZERO;
    }
    let (radius, angle) =
        if a.abs() > b.abs() { (a, PI / 4.0 * (b / a)) } else { (b, PI / 2.0 - PI / 4.0 * (a / b)) };
    let (sine, cosine) = angle.sin_cos();
    radius * vec2(cosine, sine)
}

/// A cosine-weighted direction around the unit `normal`.
pub(super) fn cosine_direction(normal: Vec3, u: [f32; 2]) -> Vec3 {
    let disk = disk(u);
    let (x, y) = frame(normal);
    (x * disk.x + y * disk.y + normal * (1.0 - disk.length_squared()).max(0.0).sqrt()).normalize()
}

/// Relative intensity by direction, 0..=1.
#[derive(Clone, Debug, serde::Deserialize, serde::Serialize)]
pub(super) struct Profile {
    pub axis: Vec3,
    /// 1 - cosine where the fading begins and ends.
    pub inner: f32,
    pub outer: f32,
}

impl Profile {
    /// Smoothstep in the cosine of the angle; its mean over the soft edge is one half.
    pub(super) fn at(&self, direction: Vec3) -> f32 {
        // 1 - cosine by the chord: accurate for narrow cones too.
        let off = (direction - self.axis).length_squared() / 2.0;
        if off <= self.inner {
            return 1.0;
        }
        let x = ((self.outer - off) / (self.outer - self.inner)).clamp(0.0, 1.0);
        x * x * (3.0 - 2.0 * x)
    }

    /// Integral over all directions [sr].
    pub(super) fn solid_angle(&self) -> f32 {
        TAU * (self.inner + self.outer) / 2.0
    }
}

/// The emission of one light.
#[derive(Clone, Debug, serde::Deserialize, serde::Serialize)]
pub struct Emission {
    /// RGB flux (W) of the whole square, without rejection.
    pub flux: Vec3,
    pub(super) source: Source,
}

/// The maps, by kind of source.
#[derive(Clone, Debug, serde::Deserialize, serde::Serialize)]
pub(super) enum Source {
    /// From a point into a cone.
    Point { origin: Vec3, cone: Cone },
    /// From a point into a cone, with rejection by the profile of a spot light.
    Spot { origin: Vec3, cone: Cone, profile: Profile },
    /// Nearly parallel, through a disk around the target sphere.
    Parallel { sun: Cone, target: Sphere, distance: f32 },
    /// From a Lambertian surface, in all directions.
    Surface { surface: Emitter },
    /// From a Lambertian surface towards a sphere; `widest` is the largest solid angle that it subtends at any point.
    SurfaceTo { surface: Emitter, target: Sphere, widest: f32 },
}

/// Lambertian surfaces of area lights.
#[derive(Clone, Copy, Debug, serde::Deserialize, serde::Serialize)]
pub(super) enum Emitter {
    Rectangle { centre: Vec3, half_x: Vec3, half_y: Vec3, normal: Vec3 },
    Sphere(Sphere),
}

impl Emitter {
    /// A uniform point with its normal.
    fn point(&self, u: [f32; 2]) -> (Vec3, Vec3) {
        match self {
            Self::Rectangle { centre, half_x, half_y, normal } => {
                (*centre + *half_x * (2.0 * u[0] - 1.0) + *half_y * (2.0 * u[1] - 1.0), *normal)
            }
            Self::Sphere(sphere) => {
                let normal = Cone::ALL.direction(u);
                (sphere.centre + normal * sphere.radius, normal)
            }
        }
    }

    /// Distance from `point`.
    fn distance(&self, point: Vec3) -> f32 {
        match self {
            Self::Rectangle { centre, half_x, half_y, .. } => {
                let offset = point - *centre;
                let clamped = |half: Vec3| {
                    half * (offset.dot(half) / half.length_squared().max(f32::MIN_POSITIVE)).clamp(-1.0, 1.0)
                };
                (offset - clamped(*half_x) - clamped(*half_y)).length()
            }
            Self::Sphere(sphere) => (point.distance(sphere.centre) - sphere.radius).max(0.0),
        }
    }
}

impl Emission {
    /// The emission of a Lambertian surface of total `flux`, narrowed to `target` where that saves candidates.
    pub(super) fn of_surface(surface: Emitter, flux: Vec3, target: Option<Sphere>) -> Self {
        let widest = target.map_or(TAU, |sphere| {
            let nearest = surface.distance(sphere.centre);
            if nearest <= sphere.radius {
                TAU
            } else {
                sphere.subtended_cone(sphere.centre + Vec3::Y * nearest).solid_angle()
            }
        });
        // Radiance is flux / (pi area): a photon towards the sphere carries cosine x solid angle / pi of the flux.
        match target {
            Some(target) if widest < PI => {
                // 1e-5: rounding must not raise an acceptance above 1.
                let widest = widest * 1.000_01;
                Self { flux: flux * (widest / PI), source: Source::SurfaceTo { surface, target, widest } }
            }
            Some(_) | None => Self { flux, source: Source::Surface { surface } },
        }
    }

    /// The ray of a point of the unit square; none if rejected.
    pub fn sample(&self, u: [f32; 2], rng: &mut Stream) -> Option<Ray> {
        match &self.source {
            Source::Point { origin, cone } => Some(Ray::new(*origin, cone.direction(u))),
            Source::Spot { origin, cone, profile } => {
                let direction = cone.direction(u);
                (rng.f32() < profile.at(direction)).then(|| Ray::new(*origin, direction))
            }
            Source::Parallel { sun, target, distance } => {
                let direction = sun.direction([rng.f32(), rng.f32()]);
                let (x, y) = frame(direction);
                let across = disk(u) * target.radius;
                Some(Ray::new(target.centre + x * across.x + y * across.y - direction * *distance, direction))
            }
            Source::Surface { surface } => {
                let (origin, normal) = surface.point([rng.f32(), rng.f32()]);
                Some(Ray::new(origin, cosine_direction(normal, u)))
            }
            Source::SurfaceTo { surface, target, widest } => {
                let (origin, normal) = surface.point([rng.f32(), rng.f32()]);
                let cone = target.subtended_cone(origin);
                let direction = cone.direction(u);
                let share = direction.dot(normal) * cone.solid_angle() / widest;
                (rng.f32() < share).then(|| Ray::new(origin, direction))
            }
        }
    }
}
