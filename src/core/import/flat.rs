//! Flat meshes as rectangles: what can be the table.

use glam::{DVec3, Vec3};

use crate::scene::gltf::Shape;

/// A plane deviates by no more than this share of its size.
const FLAT: f64 = 1e-3;
/// Triangles whose edges are tried as sides of the rectangle.
const TRIED: usize = 64;

/// A rectangle in space: `v` is `normal` x `u`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rectangle {
    pub centre: Vec3,
    pub normal: Vec3,
    pub u: Vec3,
    pub v: Vec3,
    /// Along u and v (m).
    pub size: [f32; 2],
    /// Share of the rectangle that the mesh covers.
    pub filled: f32,
}

impl Rectangle {
    /// A horizontal one that faces up, without size.
    pub(super) fn horizontal(centre: Vec3) -> Self {
        Self { centre, normal: Vec3::Y, u: Vec3::X, v: Vec3::NEG_Z, size: [0.0; 2], filled: 1.0 }
    }

    /// With its lit side towards a point, its width as near to x as can be.
    pub(super) fn facing(self, point: Vec3) -> Self {
        let normal = if (point - self.centre).dot(self.normal) < 0.0 { -self.normal } else { self.normal };
        let across = self.v.x.abs() > self.u.x.abs();
        let (u, size) = if across { (self.v, [self.size[1], self.size[0]]) } else { (self.u, self.size) };
        let u = if u.x < 0.0 { -u } else { u };
        Self { normal, u, v: normal.cross(u), size, ..self }
    }

    /// Coordinates of a point along u and v, from the centre (m).
    pub(super) fn along(&self, point: Vec3) -> [f32; 2] {
        [(point - self.centre).dot(self.u), (point - self.centre).dot(self.v)]
    }

    /// Height of a point above it (m).
    pub(super) fn height(&self, point: Vec3) -> f32 {
        (point - self.centre).dot(self.normal)
    }
}

/// The rectangle around a flat mesh; none where it is not flat.
pub(super) fn rectangle(shapes: &[Shape]) -> Option<Rectangle> {
    let faces = || {
        shapes.iter().flat_map(|shape| {
            shape.faces.iter().map(|face| face.map(|vertex| shape.positions[vertex as usize]))
        })
    };
    let cross = |[a, b, c]: [DVec3; 3]| (b - a).cross(c - a);
    let largest = faces().max_by(|a, b| cross(*a).length().total_cmp(&cross(*b).length()))?;
    let normal = cross(largest).try_normalize()?;
    let origin = largest[0];
    let flat = |face: [DVec3; 3]| cross(face).dot(normal).abs() >= 0.9999 * cross(face).length();
    if !faces().all(flat) {
        return None;
    }
    let points = || shapes.iter().flat_map(|shape| shape.positions.iter().map(|point| *point - origin));
    let extent = |axis: DVec3| {
        points()
            .map(|point| point.dot(axis))
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], at| [low.min(at), high.max(at)])
    };
    let edges = faces().take(TRIED).flat_map(|[a, b, c]| [b - a, c - b, a - c]);
    let sides = edges.filter_map(|edge| (edge - normal * edge.dot(normal)).try_normalize());
    let mut best: Option<(f64, DVec3, [f64; 2], [f64; 2])> = None;
    for u in sides {
        let ([left, right], [low, high]) = (extent(u), extent(normal.cross(u)));
        let area = (right - left) * (high - low);
        if best.is_none_or(|(smallest, ..)| area < smallest * (1.0 - 1e-9)) {
            best = Some((area, u, [left, right], [low, high]));
        }
    }
    let (area, u, [left, right], [low, high]) = best?;
    let v = normal.cross(u);
    let [down, up] = extent(normal);
    if area <= 0.0 || up - down > FLAT * (right - left).max(high - low) {
        return None;
    }
    let covered: f64 = faces().map(|face| cross(face).length() / 2.0).sum();
    let centre =
        origin + u * ((left + right) / 2.0) + v * ((low + high) / 2.0) + normal * ((down + up) / 2.0);
    Some(Rectangle {
        centre: centre.as_vec3(),
        normal: normal.as_vec3(),
        u: u.as_vec3(),
        v: v.as_vec3(),
        size: [(right - left) as f32, (high - low) as f32],
        filled: (covered / area) as f32,
    })
}
