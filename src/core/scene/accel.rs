//! Rays against all triangles of the scene: an eight-wide compressed hierarchy (Ylitie et al. 2017, crate obvhs).

use glam::{Vec3, Vec3A};
use obvhs::cwbvh::CwBvh;
use obvhs::ray::{Ray as BvhRay, RayHit};

use super::hierarchy;
use super::{Hit, Primitive, Ray, SurfaceId};

/// One triangle with what a hit needs to know of it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Triangle {
    pub corners: [Vec3; 3],
    /// Unit normals at the corners, on the side of the true normal.
    pub normals: [Vec3; 3],
    pub mesh: u16,
}

/// Triangles in the order of the hierarchy's leaves, split into what the search reads and what only a hit reads.
pub(super) struct Accel {
    bvh: Option<CwBvh>,
    shapes: Vec<Shape>,
    normals: Vec<[Vec3; 3]>,
    meshes: Vec<u16>,
}

/// A triangle for the intersection test of Moeller & Trumbore in the arrangement of Embree: one corner, two edges, and
/// their product. (The test of the same name in obvhs 0.4.0 returns the distance times the determinant.)
#[derive(Clone, Copy)]
struct Shape {
    v0: Vec3A,
    /// v0 - v1
    e1: Vec3A,
    /// v2 - v0
    e2: Vec3A,
    /// e2 x e1: outward for a counter-clockwise triangle, not normalized.
    normal: Vec3A,
}

impl Shape {
    fn new([v0, v1, v2]: [Vec3; 3]) -> Self {
        let (e1, e2) = (Vec3A::from(v0 - v1), Vec3A::from(v2 - v0));
        Self { v0: v0.into(), e1, e2, normal: e2.cross(e1) }
    }

    /// Distance along the ray, or infinity. Bounds are compared before the division, which few triangles reach.
    #[inline(always)]
    fn distance(&self, ray: &BvhRay) -> f32 {
        let to_corner = self.v0 - ray.origin;
        let across = to_corner.cross(ray.direction);
        let det = self.normal.dot(ray.direction);
        let sign = det.to_bits() & 0x8000_0000;
        let flip = |x: f32| f32::from_bits(x.to_bits() ^ sign);
        let scale = det.abs();
        let u = flip(across.dot(self.e2));
        let v = flip(across.dot(self.e1));
        let outside = (u.to_bits() | v.to_bits() | (scale - u - v).to_bits()) & 0x8000_0000 != 0;
        if outside || scale == 0.0 {
            return f32::INFINITY;
        }
        let t = flip(self.normal.dot(to_corner));
        if t > scale * ray.tmin && t <= scale * ray.tmax { t / scale } else { f32::INFINITY }
    }

    /// Weights of the second and third corner where the ray meets the plane.
    fn barycentric(&self, ray: &Ray) -> (f32, f32) {
        let direction = Vec3A::from(ray.direction);
        let across = (self.v0 - Vec3A::from(ray.origin)).cross(direction);
        let inverse = 1.0 / self.normal.dot(direction);
        (across.dot(self.e2) * inverse, across.dot(self.e1) * inverse)
    }
}

impl Accel {
    /// Builds the hierarchy. Degenerate triangles must be gone.
    pub(super) fn new(triangles: &[Triangle]) -> Self {
        if triangles.is_empty() {
            return Self { bvh: None, shapes: Vec::new(), normals: Vec::new(), meshes: Vec::new() };
        }
        let bvh = hierarchy::build(triangles);
        let order = || bvh.primitive_indices.iter().map(|i| &triangles[*i as usize]);
        Self {
            shapes: order().map(|t| Shape::new(t.corners)).collect(),
            normals: order().map(|t| t.normals).collect(),
            meshes: order().map(|t| t.mesh).collect(),
            bvh: Some(bvh),
        }
    }

    /// The nearest triangle before `limit`, other than the one the ray leaves.
    pub(super) fn intersect(&self, ray: &Ray, limit: f32) -> Option<Hit> {
        let bvh = self.bvh.as_ref()?;
        let from = ray.from.0 as usize;
        let mut nearest = RayHit::none();
        let search = BvhRay::new(ray.origin.into(), ray.direction.into(), 0.0, limit);
        let found = bvh.ray_traverse(search, &mut nearest, |ray, i| {
            if i == from { f32::INFINITY } else { self.shapes[i].distance(ray) }
        });
        found.then(|| self.hit(ray, nearest.primitive_id, nearest.t))
    }

    fn hit(&self, ray: &Ray, index: u32, t: f32) -> Hit {
        let i = index as usize;
        let shape = &self.shapes[i];
        let (u, v) = shape.barycentric(ray);
        let [n0, n1, n2] = self.normals[i];
        let geometric = Vec3::from(shape.normal.normalize());
        let shading = n0 * (1.0 - u - v) + n1 * u + n2 * v;
        Hit {
            t,
            point: (shape.v0 - shape.e1 * u + shape.e2 * v).into(),
            geometric_normal: geometric,
            shading_normal: shading.try_normalize().unwrap_or(geometric),
            surface: SurfaceId::Mesh(self.meshes[i]),
            primitive: Primitive(index),
        }
    }

    /// Whether any triangle, other than the one the ray leaves, lies before `distance`.
    pub(super) fn occluded(&self, ray: &Ray, distance: f32) -> bool {
        let Some(bvh) = &self.bvh else { return false };
        let from = ray.from.0 as usize;
        let search = BvhRay::new(ray.origin.into(), ray.direction.into(), 0.0, distance);
        !bvh.ray_traverse_miss(
            search,
            |ray, i| {
                if i == from { f32::INFINITY } else { self.shapes[i].distance(ray) }
            },
        )
    }

    /// Every triangle that the ray crosses: its mesh, and whether the ray leaves the solid there.
    pub(super) fn each_crossing(&self, ray: &Ray, mut crossed: impl FnMut(u16, bool)) {
        let Some(bvh) = &self.bvh else { return };
        let search = BvhRay::new(ray.origin.into(), ray.direction.into(), 0.0, f32::INFINITY);
        bvh.ray_traverse_anyhit(search, |ray, i| {
            if self.shapes[i].distance(ray) < f32::INFINITY {
                crossed(self.meshes[i], self.shapes[i].normal.dot(ray.direction) > 0.0);
            }
        });
    }
}
