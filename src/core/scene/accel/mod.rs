//! The acceleration structure: a bounding volume hierarchy with eight boxes per node and eight triangles per leaf, tested
//! eight at once (Wald, Benthin, Boulos 2008).

mod blocks;
mod build;
mod collapse;
mod node;
mod triangle;
mod wide;

use glam::Vec3;

use collapse::Hierarchy;
use node::{Child, Node, Stack};
pub(super) use triangle::Triangle;
use wide::{Nearest, Triangles, WideRay};

use super::surface::{Hit, Primitive, Ray, SurfaceId};
use crate::{Progress, Result};

/// The bounding volume hierarchy with the triangles in the order of its leaves.
pub(super) struct Accel {
    /// The root first; empty without triangles.
    nodes: Vec<Node>,
    leaves: Vec<Triangles>,
    surfaces: Vec<ShadingData>,
}

/// The part of a triangle that only a hit needs.
struct ShadingData {
    normals: [Vec3; 3],
    mesh: u16,
}

impl Accel {
    /// Builds the hierarchy over triangles with area.
    ///
    /// # Errors
    /// `Cancelled`.
    pub(super) fn new(triangles: &[Triangle], progress: &Progress) -> Result<Self> {
        if triangles.is_empty() {
            return Ok(Self { nodes: Vec::new(), leaves: Vec::new(), surfaces: Vec::new() });
        }
        let Hierarchy { nodes, leaves, order } = build::build(triangles, progress)?;
        let surface = |i: &u32| {
            let Triangle { normals, mesh, .. } = triangles[*i as usize];
            ShadingData { normals, mesh }
        };
        Ok(Self { nodes, leaves, surfaces: order.iter().map(surface).collect() })
    }

    /// The nearest hit before `limit`; the triangle the ray leaves is skipped.
    pub(super) fn intersect(&self, ray: &Ray, limit: f32) -> Option<Hit> {
        let mut nearest = None;
        self.search(ray, limit, |wide, leaf, limit| {
            if let Some(found) = leaf.nearest(wide, *limit, ray.from.0) {
                *limit = found.t;
                nearest = Some((leaf, found));
            }
            true
        });
        nearest.map(|(leaf, found)| self.hit(leaf, &found))
    }

    fn hit(&self, leaf: &Triangles, found: &Nearest) -> Hit {
        let index = leaf.first + found.lane;
        let (corner, edge1, edge2) = leaf.lane(found.lane);
        let ShadingData { normals: [n0, n1, n2], mesh } = &self.surfaces[index as usize];
        let [u, v] = found.weights;
        let geometric = edge1.cross(edge2).normalize();
        let shading = *n0 * (1.0 - u - v) + *n1 * u + *n2 * v;
        Hit {
            t: found.t,
            point: corner + edge1 * u + edge2 * v,
            geometric_normal: geometric,
            shading_normal: shading.try_normalize().unwrap_or(geometric),
            surface: SurfaceId::Mesh(*mesh),
            primitive: Primitive(index),
        }
    }

    /// Whether any triangle but the one the ray leaves is hit before `distance`.
    pub(super) fn occluded(&self, ray: &Ray, distance: f32) -> bool {
        let mut occluded = false;
        self.search(ray, distance, |wide, leaf, limit| {
            occluded = leaf.intersect(wide, *limit, ray.from.0).mask != 0;
            !occluded
        });
        occluded
    }

    /// Calls `crossed` for every triangle hit, with its mesh and whether the ray leaves the solid there.
    pub(super) fn each_crossing(&self, ray: &Ray, mut crossed: impl FnMut(u16, bool)) {
        self.search(ray, f32::INFINITY, |wide, leaf, limit| {
            let mask = leaf.intersect(wide, *limit, ray.from.0).mask;
            for lane in (0..8).filter(|lane| mask >> lane & 1 != 0) {
                let (_, edge1, edge2) = leaf.lane(lane);
                let mesh = self.surfaces[(leaf.first + lane) as usize].mesh;
                crossed(mesh, edge1.cross(edge2).dot(ray.direction) > 0.0);
            }
            true
        });
    }

    /// Calls `each` for every triangle, with its mesh.
    pub(super) fn each_triangle(&self, each: &mut dyn FnMut(Primitive, u16, &[Vec3; 3])) {
        for leaf in &self.leaves {
            // Unused lanes have no edges.
            for (lane, (corner, edge1, edge2)) in
                (0..8).map(|lane| (lane, leaf.lane(lane))).filter(|(_, t)| t.1 != Vec3::ZERO)
            {
                let index = leaf.first + lane;
                let corners = [corner, corner + edge1, corner + edge2];
                each(Primitive(index), self.surfaces[index as usize].mesh, &corners);
            }
        }
    }

    /// Visits the leaves hit before a limit, near ones first. A visit may lower the limit, and ends the search by
    /// returning false.
    #[inline(always)]
    fn search<'a>(
        &'a self,
        ray: &Ray,
        mut limit: f32,
        mut visit: impl FnMut(&WideRay, &'a Triangles, &mut f32) -> bool,
    ) {
        if self.nodes.is_empty() {
            return;
        }
        let wide = WideRay::new(ray);
        let mut stack = Stack::new();
        let mut current = Child::node(0);
        loop {
            if let Some(node) = current.as_node() {
                if let Some(nearest) = self.nodes[node].enter(&wide, limit, &mut stack) {
                    current = nearest;
                    continue;
                }
            } else if !visit(&wide, &self.leaves[current.as_leaf()], &mut limit) {
                return;
            }
            current = loop {
                match stack.pop() {
                    Some((t, child)) if t <= limit => break child,
                    Some(_) => (),
                    None => return,
                }
            };
        }
    }
}
