//! The division of triangles that lie in one another into parts that each belong to the same triangles throughout.

use std::collections::HashMap;
use std::panic::{AssertUnwindSafe, catch_unwind};

use glam::{DVec2, DVec3, Vec3};
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};
use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation as _};

use super::touching::{Frame, area2, largest, rounding};

/// A part of a cluster.
pub(super) struct Piece {
    /// Counter-clockwise in the frame of the cluster.
    pub corners: [Vec3; 3],
    /// The triangles that it belongs to, by index into the cluster, ascending.
    pub of: Vec<usize>,
}

/// The arrangement of the triangles of one plane.
pub(super) struct Arrangement {
    frame: Frame,
    /// The triangles in the plane (m).
    flat: Vec<[DVec2; 3]>,
}

impl Arrangement {
    /// None if the triangles do not lie in one plane within a few roundings, which a curved surface may do piece by piece.
    pub(super) fn new(cluster: &[[Vec3; 3]]) -> Option<Self> {
        let size = |c: &[Vec3; 3]| (c[1] - c[0]).cross(c[2] - c[0]).length_squared();
        let base = cluster.iter().max_by(|a, b| size(a).total_cmp(&size(b)))?;
        let frame = Frame::of(base);
        let tolerance = tolerance(cluster);
        let corners = || cluster.iter().flatten().map(|corner| corner.as_dvec3());
        if corners().any(|corner| frame.height(corner).abs() > 8.0 * tolerance) {
            return None;
        }
        let flat = cluster.iter().map(|c| c.map(|corner| frame.flat(corner.as_dvec3()))).collect();
        Some(Self { frame, flat })
    }

    /// Whether the winding of a triangle is that of the plane.
    pub(super) fn faces_up(&self, triangle: usize) -> bool {
        let [a, b, c] = self.flat[triangle];
        area2(a, b, c) > 0.0
    }

    /// Weights of the corners of a triangle at a point of its plane.
    pub(super) fn weights(&self, triangle: usize, point: Vec3) -> [f32; 3] {
        let [a, b, c] = self.flat[triangle];
        let point = self.frame.flat(point.as_dvec3());
        let all = area2(a, b, c);
        let [u, v] = [area2(c, a, point) / all, area2(a, b, point) / all].map(|w| w as f32);
        [1.0 - u - v, u, v]
    }

    /// The parts: a constrained Delaunay triangulation of all edges. None where the triangulation fails.
    pub(super) fn pieces(&self, cluster: &[[Vec3; 3]]) -> Option<Vec<Piece>> {
        // Where edges cross in slivers, its rounded crossings contradict each other, which it asserts not to happen.
        catch_unwind(AssertUnwindSafe(|| self.divided(cluster))).ok().flatten()
    }

    fn divided(&self, cluster: &[[Vec3; 3]]) -> Option<Vec<Piece>> {
        // In steps of one rounding, as whole numbers: equal corners become one, and predicates are exact.
        let step = tolerance(cluster);
        let mut plane = ConstrainedDelaunayTriangulation::<Point2<f64>>::new();
        let mut places = Places { step, known: HashMap::new() };
        let mut points: Vec<Vec3> = Vec::new();
        let mut handles = Vec::new();
        for (corners, flat) in cluster.iter().zip(&self.flat) {
            let mut of = [0; 3];
            for k in 0..3 {
                let (at, new) = places.find(flat[k], points.len());
                if let Some([x, y]) = new {
                    handles.push(plane.insert(Point2::new(x, y)).ok()?);
                    points.push(corners[k]);
                }
                of[k] = at;
            }
            for (from, to) in [(of[0], of[1]), (of[1], of[2]), (of[2], of[0])] {
                if from != to && !plane.exists_constraint(handles[from], handles[to]) {
                    plane.add_constraint_and_split(handles[from], handles[to], |crossing| crossing);
                }
            }
        }
        let given: HashMap<_, _> = handles.iter().copied().zip(points).collect();
        let owners = self.owners();
        let pieces = plane.inner_faces().filter_map(|face| {
            let vertices = face.vertices();
            let flat = vertices.map(|vertex| {
                let Point2 { x, y } = vertex.position();
                DVec2::new(x, y) * step
            });
            let of = owners((flat[0] + flat[1] + flat[2]) / 3.0);
            let corners = vertices.map(|vertex| {
                given.get(&vertex.fix()).copied().unwrap_or_else(|| {
                    let Point2 { x, y } = vertex.position();
                    self.frame.point(DVec2::new(x, y) * step).as_vec3()
                })
            });
            (!of.is_empty()).then_some(Piece { corners, of })
        });
        Some(pieces.collect())
    }

    /// The triangles at a point of the plane.
    fn owners(&self) -> impl Fn(DVec2) -> Vec<usize> + '_ {
        let item = |(index, [a, b, c]): (usize, &[DVec2; 3])| {
            let aabb = AABB::from_corners(a.min(*b).min(*c).to_array(), a.max(*b).max(*c).to_array());
            GeomWithData::new(Rectangle::from_aabb(aabb), index)
        };
        let tree = RTree::bulk_load(self.flat.iter().enumerate().map(item).collect());
        move |point| {
            let inside = |[a, b, c]: [DVec2; 3]| {
                let sides = [area2(a, b, point), area2(b, c, point), area2(c, a, point)];
                sides.iter().all(|s| *s >= 0.0) || sides.iter().all(|s| *s <= 0.0)
            };
            let at = tree.locate_in_envelope_intersecting(AABB::from_point(point.to_array()));
            let mut of: Vec<usize> =
                at.map(|item| item.data).filter(|index| inside(self.flat[*index])).collect();
            of.sort_unstable();
            of
        }
    }
}

/// Rounding of the coordinates of a cluster (m).
fn tolerance(cluster: &[[Vec3; 3]]) -> f64 {
    rounding(cluster.iter().map(largest).fold(f32::MIN_POSITIVE, f32::max))
}

/// Places on a plane that are told apart by more than rounding.
struct Places {
    step: f64,
    known: HashMap<[i64; 2], usize>,
}

impl Places {
    /// The number of the place, and where it is new, in steps, for it to be the place `next`.
    fn find(&mut self, at: DVec2, next: usize) -> (usize, Option<[f64; 2]>) {
        let cell = (at / self.step).round().to_array().map(|x| x as i64);
        let around = (-1..=1).flat_map(|dx| (-1..=1).map(move |dy| [cell[0] + dx, cell[1] + dy]));
        if let Some(known) = around.into_iter().find_map(|cell| self.known.get(&cell)) {
            return (*known, None);
        }
        self.known.insert(cell, next);
        (next, Some(cell.map(|x| x as f64)))
    }
}

/// Whether all corners of two triangles are the same within rounding, in any order.
pub(super) fn same_corners(a: &[Vec3; 3], b: &[Vec3; 3]) -> bool {
    let tolerance = rounding(largest(a).max(largest(b)));
    let near = |p: Vec3, q: Vec3| p.as_dvec3().distance(q.as_dvec3()) <= 2.0 * tolerance;
    let covers = |a: &[Vec3; 3], b: &[Vec3; 3]| a.iter().all(|p| b.iter().any(|q| near(*p, *q)));
    covers(a, b) && covers(b, a)
}

/// Whether two triangles of the same corners face the same way.
pub(super) fn same_side(a: &[Vec3; 3], b: &[Vec3; 3]) -> bool {
    let normal = |c: &[Vec3; 3]| -> DVec3 {
        let [a, b, c] = c.map(|corner| corner.as_dvec3());
        (b - a).cross(c - a)
    };
    normal(a).dot(normal(b)) > 0.0
}
