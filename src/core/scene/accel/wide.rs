//! Eight boxes or eight triangles against one ray at once.

use glam::Vec3;
use wide::f32x8;

use crate::scene::Ray;

/// A ray broadcast to eight lanes, with inverse directions.
pub(super) struct WideRay {
    origin: [f32x8; 3],
    direction: [f32x8; 3],
    inverse: [f32x8; 3],
    /// Origin times inverse direction, rounded so that boxes are entered no later and left no earlier.
    near: [f32x8; 3],
    far: [f32x8; 3],
    /// Axes along which the direction is negative.
    negative: [bool; 3],
}

impl WideRay {
    #[inline(always)]
    pub(super) fn new(ray: &Ray) -> Self {
        // Along an axis the inverse is huge but finite: 0 times it is 0, not NaN.
        let inverse = |d: f32| if d.abs() < 1e-18 { 1e18_f32.copysign(d) } else { 1.0 / d };
        let splat = |v: Vec3| [f32x8::splat(v.x), f32x8::splat(v.y), f32x8::splat(v.z)];
        let Vec3 { x, y, z } = ray.direction;
        let inverses = Vec3::new(inverse(x), inverse(y), inverse(z));
        let offset = ray.origin * inverses;
        // The product is off by half a unit in the last place, and so is this sum.
        let slack = offset.abs() * (2.0 * f32::EPSILON);
        Self {
            origin: splat(ray.origin),
            direction: splat(ray.direction),
            inverse: splat(inverses),
            near: splat(offset + slack),
            far: splat(offset - slack),
            negative: [x.is_sign_negative(), y.is_sign_negative(), z.is_sign_negative()],
        }
    }
}

/// Eight boxes; an empty one is inverted and never hit.
#[derive(Clone)]
pub(super) struct Boxes {
    /// Lower and upper bounds by axis.
    sides: [[f32x8; 3]; 2],
}

impl Boxes {
    pub(super) fn new(boxes: [(Vec3, Vec3); 8]) -> Self {
        let column = |pick: fn(&(Vec3, Vec3)) -> Vec3, axis: usize| {
            f32x8::from(boxes.each_ref().map(|b| pick(b)[axis]))
        };
        Self { sides: [[0, 1, 2].map(|a| column(|b| b.0, a)), [0, 1, 2].map(|a| column(|b| b.1, a))] }
    }

    /// Bit mask of the boxes hit before `limit`, and the entry distances.
    #[inline(always)]
    pub(super) fn intersect(&self, ray: &WideRay, limit: f32) -> (u32, f32x8) {
        let mut enter = f32x8::splat(0.0);
        let mut leave = f32x8::splat(limit);
        for axis in 0..3 {
            let down = usize::from(ray.negative[axis]);
            let at = |side: usize, offset: f32x8| self.sides[side][axis].mul_sub(ray.inverse[axis], offset);
            enter = enter.fast_max(at(down, ray.near[axis]));
            leave = leave.fast_min(at(1 - down, ray.far[axis]));
        }
        // The roundings of the inverse and of the bounds may swap a flat box's sides: three units in the last place make up
        // for them (Ize 2013).
        let leave = leave * f32x8::splat(1.0 + 4.0 * f32::EPSILON);
        (enter.simd_le(leave).to_bitmask(), enter)
    }
}

/// Up to eight triangles, by one corner and two edges; unused lanes have no area.
#[derive(Clone)]
pub(super) struct Triangles {
    corner: [f32x8; 3],
    edge1: [f32x8; 3],
    edge2: [f32x8; 3],
    /// Index of the first triangle; the others follow.
    pub first: u32,
}

/// The nearest hit among eight triangles.
pub(super) struct Nearest {
    pub t: f32,
    pub lane: u32,
    /// Weights of the second and third corner.
    pub weights: [f32; 2],
}

/// The triangles that a ray hits.
pub(super) struct Crossed {
    /// Bit mask of their lanes.
    pub mask: u32,
    /// Distance and weights of the second and third corner, all times the determinant.
    scaled: [f32x8; 3],
    determinant: f32x8,
}

impl Triangles {
    pub(super) fn new(triangles: &[[Vec3; 3]], first: u32) -> Self {
        let column = |pick: &dyn Fn(&[Vec3; 3]) -> Vec3, axis: usize| {
            let lane = |k: usize| triangles.get(k).map_or(0.0, |t| pick(t)[axis]);
            f32x8::from([0, 1, 2, 3, 4, 5, 6, 7].map(lane))
        };
        let columns = |pick: &dyn Fn(&[Vec3; 3]) -> Vec3| [0, 1, 2].map(|axis| column(pick, axis));
        Self {
            corner: columns(&|t| t[0]),
            edge1: columns(&|t| t[1] - t[0]),
            edge2: columns(&|t| t[2] - t[0]),
            first,
        }
    }

    /// The triangles hit between 0 and `limit` (Moeller & Trumbore 1997). Triangle `skip` is never hit. Most leaves are
    /// missed: nothing is divided before a hit is sure.
    #[inline(always)]
    pub(super) fn intersect(&self, ray: &WideRay, limit: f32, skip: u32) -> Crossed {
        let offset =
            [ray.origin[0] - self.corner[0], ray.origin[1] - self.corner[1], ray.origin[2] - self.corner[2]];
        let p = cross(&ray.direction, &self.edge2);
        let q = cross(&offset, &self.edge1);
        let signed = dot(&self.edge1, &p);
        let determinant = signed.abs();
        let sign = signed ^ determinant;
        let [t, u, v] = [dot(&self.edge2, &q), dot(&offset, &p), dot(&ray.direction, &q)].map(|x| x ^ sign);
        let zero = f32x8::splat(0.0);
        let inside = u.simd_ge(zero) & v.simd_ge(zero) & (u + v).simd_le(determinant);
        // Without area the determinant is 0, and no distance lies above 0 and below.
        let before = t.simd_gt(zero) & t.simd_le(f32x8::splat(limit) * determinant);
        let mask = (inside & before).to_bitmask();
        let lane = skip.wrapping_sub(self.first);
        let mask = if lane < 8 { mask & !(1 << lane) } else { mask };
        Crossed { mask, scaled: [t, u, v], determinant }
    }

    /// The nearest hit.
    #[inline(always)]
    pub(super) fn nearest(&self, ray: &WideRay, limit: f32, skip: u32) -> Option<Nearest> {
        let Crossed { mut mask, scaled, determinant } = self.intersect(ray, limit, skip);
        if mask == 0 {
            return None;
        }
        let inverse = f32x8::splat(1.0) / determinant;
        let [t, u, v] = scaled.map(|x| (x * inverse).to_array());
        let mut best = mask.trailing_zeros() as usize;
        mask &= mask - 1;
        while mask != 0 {
            let lane = mask.trailing_zeros() as usize;
            mask &= mask - 1;
            best = if t[lane] < t[best] { lane } else { best };
        }
        Some(Nearest { t: t[best], lane: best as u32, weights: [u[best], v[best]] })
    }

    /// First corner and the two edges from it of one triangle.
    #[inline(always)]
    pub(super) fn lane(&self, lane: u32) -> (Vec3, Vec3, Vec3) {
        let vector = |columns: &[f32x8; 3]| {
            let component = |axis: usize| columns[axis].as_array()[lane as usize];
            Vec3::new(component(0), component(1), component(2))
        };
        (vector(&self.corner), vector(&self.edge1), vector(&self.edge2))
    }
}

#[inline(always)]
fn cross(a: &[f32x8; 3], b: &[f32x8; 3]) -> [f32x8; 3] {
    [a[1].mul_sub(b[2], a[2] * b[1]), a[2].mul_sub(b[0], a[0] * b[2]), a[0].mul_sub(b[1], a[1] * b[0])]
}

#[inline(always)]
fn dot(a: &[f32x8; 3], b: &[f32x8; 3]) -> f32x8 {
    a[0].mul_add(b[0], a[1].mul_add(b[1], a[2] * b[2]))
}
