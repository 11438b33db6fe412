//! The division of triangles that lie in one another into parts that each belong to the same triangles throughout.

use std::collections::{BTreeSet, HashMap};

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

    /// The parts: a constrained Delaunay triangulation of all edges, cut where they cross. None where the triangulation fails.
    pub(super) fn pieces(&self, cluster: &[[Vec3; 3]]) -> Option<Vec<Piece>> {
        // In steps of one rounding, as whole numbers: equal corners become one, and predicates are exact.
        let step = tolerance(cluster);
        let mut places = Places::default();
        let mut given: Vec<Vec3> = Vec::new();
        let mut edges = BTreeSet::new();
        for (corners, flat) in cluster.iter().zip(&self.flat) {
            let of = flat.map(|point| places.find(point / step));
            for (corner, place) in corners.iter().zip(of) {
                if place == given.len() {
                    given.push(*corner);
                }
            }
            let sides = [(of[0], of[1]), (of[1], of[2]), (of[2], of[0])];
            edges.extend(sides.into_iter().filter(|(a, b)| a != b).map(|(a, b)| [a.min(b), a.max(b)]));
        }
        let edges = cut(&edges.into_iter().collect::<Vec<_>>(), &mut places);
        let points = places.points.iter().map(|p| Point2::new(p.x, p.y)).collect();
        // Edges that rounding has made cross again differ by less than rounding: one of them is enough.
        let plane: ConstrainedDelaunayTriangulation<Point2<f64>> =
            ConstrainedDelaunayTriangulation::try_bulk_load_cdt(points, edges, |_| ()).ok()?;
        let owners = self.owners();
        let pieces = plane.inner_faces().filter_map(|face| {
            let flat = face.positions().map(|Point2 { x, y }| DVec2::new(x, y) * step);
            let of = owners((flat[0] + flat[1] + flat[2]) / 3.0);
            let numbers = face.vertices().map(|vertex| vertex.fix().index());
            let corner = |k: usize| {
                given.get(numbers[k]).copied().unwrap_or_else(|| self.frame.point(flat[k]).as_vec3())
            };
            (!of.is_empty()).then(|| Piece { corners: [corner(0), corner(1), corner(2)], of })
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

/// Places on a plane that are told apart by more than rounding, in steps of it, whole numbers.
#[derive(Default)]
struct Places {
    points: Vec<DVec2>,
    known: HashMap<[i64; 2], usize>,
}

impl Places {
    /// The number of the place at a point; of a new one if there is none.
    fn find(&mut self, at: DVec2) -> usize {
        let cell = at.round().to_array().map(|x| x as i64);
        let around = (-1..=1).flat_map(|dx| (-1..=1).map(move |dy| [cell[0] + dx, cell[1] + dy]));
        if let Some(known) = around.into_iter().find_map(|cell| self.known.get(&cell)) {
            return *known;
        }
        self.known.insert(cell, self.points.len());
        self.points.push(at.round());
        self.points.len() - 1
    }
}

/// The parts of edges between the places where they cross or meet.
fn cut(edges: &[[usize; 2]], places: &mut Places) -> Vec<[usize; 2]> {
    let ends = |edge: usize, places: &Places| edges[edge].map(|place| places.points[place]);
    let item = |edge: usize| {
        let [a, b] = ends(edge, places);
        let (lower, upper) = (a.min(b) - 2.0, a.max(b) + 2.0);
        GeomWithData::new(Rectangle::from_corners(lower.to_array(), upper.to_array()), edge)
    };
    let tree = RTree::bulk_load((0..edges.len()).map(item).collect());
    let mut on: Vec<Vec<usize>> = edges.iter().map(|edge| edge.to_vec()).collect();
    for edge in 0..edges.len() {
        let [a, b] = ends(edge, places);
        let envelope = AABB::from_corners((a.min(b) - 2.0).to_array(), (a.max(b) + 2.0).to_array());
        let mut others: Vec<usize> = tree.locate_in_envelope_intersecting(envelope).map(|i| i.data).collect();
        others.sort_unstable();
        for other in others.into_iter().filter(|other| *other != edge) {
            let [c, d] = ends(other, places);
            // An end of the other that lies on this one.
            for (point, place) in [c, d].into_iter().zip(edges[other]) {
                if distance(point, [a, b]) < 2.0 {
                    on[edge].push(place);
                }
            }
            if other > edge
                && let Some(crossing) = crossing([a, b], [c, d])
            {
                let place = places.find(crossing);
                on[edge].push(place);
                on[other].push(place);
            }
        }
    }
    let mut parts = BTreeSet::new();
    for (edge, mut on) in on.into_iter().enumerate() {
        let [a, b] = ends(edge, places);
        on.sort_by(|p, q| {
            let along = |place: &usize| (places.points[*place] - a).dot(b - a);
            along(p).total_cmp(&along(q)).then(p.cmp(q))
        });
        on.dedup();
        parts.extend(on.windows(2).map(|pair| [pair[0].min(pair[1]), pair[0].max(pair[1])]));
    }
    parts.into_iter().filter(|[a, b]| a != b).collect()
}

/// Distance of a point from a segment.
fn distance(point: DVec2, [a, b]: [DVec2; 2]) -> f64 {
    let along = ((point - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
    point.distance(a.lerp(b, along))
}

/// Where two segments cross within both; none for parallel ones, which meet in their ends.
fn crossing([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> Option<DVec2> {
    let [from, to] = [area2(c, d, a), area2(c, d, b)];
    let [first, last] = [area2(a, b, c), area2(a, b, d)];
    (from * to < 0.0 && first * last < 0.0).then(|| a.lerp(b, from / (from - to)))
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
