//! How photons leave a light: a map from the unit square to rays that keeps area in proportion to flux, so that photons
//! of equal weight are uniform points of the square. What a light sends out unevenly, it refuses at random.

use std::f32::consts::{PI, TAU};

use glam::{Vec2, Vec3, vec2};

use super::common::frame;
use crate::math::rng::Stream;
use crate::scene::Ray;

/// A ball in world space [m].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball {
    /// Its middle.
    pub centre: Vec3,
    /// Its radius.
    pub radius: f32,
}

impl Ball {
    /// The ball around a box.
    pub fn around(lower: Vec3, upper: Vec3) -> Self {
        // A little larger than the box, so that rounding leaves no corner outside.
        Self { centre: (lower + upper) / 2.0, radius: (upper - lower).length() / 2.0 * 1.0001 + 1e-30 }
    }

    /// Whether a ray meets it.
    pub fn meets(&self, ray: &Ray) -> bool {
        let offset = self.centre - ray.origin;
        let along = offset.dot(ray.direction);
        let closest = (offset - ray.direction * along).length_squared();
        let inside = offset.length_squared() <= self.radius * self.radius;
        inside || (along > 0.0 && closest <= self.radius * self.radius)
    }

    /// The cone of directions from `point` that meet it: axis and 1 - cosine of its half angle; from inside, all.
    pub(super) fn cone_from(&self, point: Vec3) -> Cone {
        let offset = self.centre - point;
        let distance = offset.length();
        if distance <= self.radius {
            return Cone::ALL;
        }
        let sine = self.radius / distance;
        Cone { axis: offset / distance, one_minus_cos: sine * sine / (1.0 + (1.0 - sine * sine).sqrt()) }
    }
}

/// A cone of directions around a unit axis.
#[derive(Clone, Copy, Debug)]
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

/// The unit square onto the unit disk, area-true and without tearing neighbours apart (Shirley & Chiu 1997).
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

/// A direction on the side of the unit `normal`, in proportion to its cosine (Lambert).
pub(super) fn cosine_direction(normal: Vec3, u: [f32; 2]) -> Vec3 {
    let disk = disk(u);
    let (x, y) = frame(normal);
    (x * disk.x + y * disk.y + normal * (1.0 - disk.length_squared()).max(0.0).sqrt()).normalize()
}

/// How bright the light is by direction, between 0 and 1.
#[derive(Clone, Debug)]
pub(super) struct Profile {
    pub axis: Vec3,
    /// 1 - cosine where the fading begins and ends.
    pub inner: f32,
    pub outer: f32,
}

impl Profile {
    /// Smooth in the cosine of the angle; its mean over the fading rim is one half.
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

/// How the photons of one light leave it.
#[derive(Clone, Debug)]
pub struct Emission {
    /// RGB flux [W] of the whole square, if nothing were refused.
    pub flux: Vec3,
    pub(super) source: Source,
}

/// The maps, by what they have in common.
#[derive(Clone, Debug)]
pub(super) enum Source {
    /// From a point into a cone.
    Point { origin: Vec3, cone: Cone },
    /// From a point into a cone, of which a spot light lets only its own pass.
    Spot { origin: Vec3, cone: Cone, profile: Profile },
    /// Nearly parallel, through a disk around the target.
    Parallel { sun: Cone, target: Ball, distance: f32 },
    /// From a surface that shines after Lambert's law, to all its sides.
    Surface { surface: Surface },
    /// From such a surface towards a ball; `widest` is the largest solid angle that any of its points sees of it.
    SurfaceTo { surface: Surface, target: Ball, widest: f32 },
}

/// Surfaces that shine.
#[derive(Clone, Copy, Debug)]
pub(super) enum Surface {
    Rectangle { centre: Vec3, half_x: Vec3, half_y: Vec3, normal: Vec3 },
    Sphere(Ball),
}

impl Surface {
    /// A uniform point and its normal.
    fn point(&self, u: [f32; 2]) -> (Vec3, Vec3) {
        match self {
            Self::Rectangle { centre, half_x, half_y, normal } => {
                (*centre + *half_x * (2.0 * u[0] - 1.0) + *half_y * (2.0 * u[1] - 1.0), *normal)
            }
            Self::Sphere(ball) => {
                let normal = Cone::ALL.direction(u);
                (ball.centre + normal * ball.radius, normal)
            }
        }
    }

    /// Distance from `point` to its nearest point.
    fn distance(&self, point: Vec3) -> f32 {
        match self {
            Self::Rectangle { centre, half_x, half_y, .. } => {
                let offset = point - *centre;
                let clamped = |half: Vec3| {
                    half * (offset.dot(half) / half.length_squared().max(f32::MIN_POSITIVE)).clamp(-1.0, 1.0)
                };
                (offset - clamped(*half_x) - clamped(*half_y)).length()
            }
            Self::Sphere(ball) => (point.distance(ball.centre) - ball.radius).max(0.0),
        }
    }
}

impl Emission {
    /// The emission of a Lambertian surface of total `flux`, towards `target` where that is the smaller part of it.
    pub(super) fn of_surface(surface: Surface, flux: Vec3, target: Option<Ball>) -> Self {
        let widest = target.map_or(TAU, |ball| {
            let nearest = surface.distance(ball.centre);
            if nearest <= ball.radius {
                TAU
            } else {
                ball.cone_from(ball.centre + Vec3::Y * nearest).solid_angle()
            }
        });
        // Radiance is flux / (pi area): a photon towards the ball carries cosine x solid angle / pi of the flux.
        match target {
            Some(target) if widest < PI => {
                // 1e-5: rounding must not make an acceptance exceed 1.
                let widest = widest * 1.000_01;
                Self { flux: flux * (widest / PI), source: Source::SurfaceTo { surface, target, widest } }
            }
            Some(_) | None => Self { flux, source: Source::Surface { surface } },
        }
    }

    /// The ray of a point of the unit square; none if the light sends nothing there (by chance, in proportion).
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
                let cone = target.cone_from(origin);
                let direction = cone.direction(u);
                let share = direction.dot(normal) * cone.solid_angle() / widest;
                (rng.f32() < share).then(|| Ray::new(origin, direction))
            }
        }
    }
}
