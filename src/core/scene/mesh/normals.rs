//! Corner normals: those of the file, or averages weighted by angle (Thuermer & Wuethrich 1998) over faces that meet
//! smoothly.

use glam::Vec3;
use rayon::prelude::*;

use super::obj::{Face, Group, NONE};
use crate::scene::accel::Triangle;

/// Crease angle: cosine of the angle between faces above which an edge is sharp, 50 degrees.
const CREASE: f32 = 0.642_787_6;
/// Faces at a vertex above which all share one average, which keeps the work linear.
const MANY: usize = 64;

/// Triangles with their corner normals, and how many of the file's normals were turned to the side of their face.
/// `vertices` are the welded vertices of the faces, numbered without gaps.
pub(super) fn shade(
    group: &Group,
    faces: &[Face],
    vertices: &[[u32; 3]],
    smooth: bool,
) -> (Vec<Triangle>, usize) {
    let corners: Vec<[Vec3; 3]> =
        faces.par_iter().map(|face| face.vertices.map(|v| group.positions[v as usize])).collect();
    // That of the file, where it has a length.
    let own = |normal: u32| {
        let given = if smooth && normal != NONE { group.normals[normal as usize] } else { Vec3::ZERO };
        given.try_normalize()
    };
    let averages = (smooth && faces.par_iter().any(|face| face.normals.iter().any(|n| own(*n).is_none())))
        .then(|| Averages::new(vertices, &corners));
    let (triangles, turned): (Vec<Triangle>, Vec<usize>) = (0..faces.len())
        .into_par_iter()
        .map(|i| {
            let flat = cross(corners[i]).normalize();
            let mut turned = 0;
            let normals = [0, 1, 2].map(|corner| match (own(faces[i].normals[corner]), &averages) {
                (Some(normal), _) if normal.dot(flat) < 0.0 => {
                    turned += 1;
                    -normal
                }
                (Some(normal), _) => normal,
                (None, Some(averages)) => averages.at(i, corner, flat),
                (None, None) => flat,
            });
            (Triangle { corners: corners[i], normals, mesh: 0 }, turned)
        })
        .unzip();
    (triangles, turned.iter().sum())
}

/// The corners around each vertex.
struct Averages<'a> {
    /// Vertices of each face.
    vertices: &'a [[u32; 3]],
    /// Unit normal of each face.
    flat: Vec<Vec3>,
    /// Angle of each corner of each face.
    angles: Vec<[f32; 3]>,
    /// Corners (3 x face + corner) sorted by vertex; those of vertex v from `start[v]` to `start[v + 1]`.
    corners: Vec<u32>,
    start: Vec<u32>,
    /// The average of all faces, at vertices of many faces; sorted by vertex.
    shared: Vec<(u32, Vec3)>,
}

impl<'a> Averages<'a> {
    fn new(vertices: &'a [[u32; 3]], corners: &[[Vec3; 3]]) -> Self {
        let all = || vertices.iter().flatten().map(|v| *v as usize);
        let count = all().max().map_or(0, |last| last + 1);
        let mut start = vec![0_u32; count + 1];
        all().for_each(|v| start[v + 1] += 1);
        for v in 0..count {
            start[v + 1] += start[v];
        }
        let mut next = start.clone();
        let mut sorted = vec![0_u32; vertices.len() * 3];
        for (corner, v) in all().enumerate() {
            sorted[next[v] as usize] = corner as u32;
            next[v] += 1;
        }
        let mut averages = Self {
            vertices,
            flat: corners.par_iter().map(|c| cross(*c).normalize()).collect(),
            angles: corners.par_iter().map(angles).collect(),
            corners: sorted,
            start,
            shared: Vec::new(),
        };
        averages.shared = (0..count)
            .filter(|v| averages.around(*v).len() > MANY)
            .map(|v| (v as u32, averages.sum(averages.around(v), |_| true)))
            .collect();
        averages
    }

    /// The corners at a vertex.
    fn around(&self, vertex: usize) -> &[u32] {
        &self.corners[self.start[vertex] as usize..self.start[vertex + 1] as usize]
    }

    /// Sum of the normals of the `wanted` faces, weighted by corner angle.
    fn sum(&self, corners: &[u32], wanted: impl Fn(Vec3) -> bool) -> Vec3 {
        corners
            .iter()
            .map(|c| (self.flat[*c as usize / 3], self.angles[*c as usize / 3][*c as usize % 3]))
            .filter(|(normal, _)| wanted(*normal))
            .map(|(normal, angle)| normal * angle)
            .sum()
    }

    fn at(&self, face: usize, corner: usize, flat: Vec3) -> Vec3 {
        let vertex = self.vertices[face][corner] as usize;
        let around = self.around(vertex);
        let shared = self.shared.binary_search_by_key(&(vertex as u32), |(v, _)| *v);
        let sum = match shared {
            Ok(at) => self.shared[at].1,
            Err(_) => self.sum(around, |normal| normal.dot(flat) >= CREASE),
        };
        let normal = sum.normalize_or(flat);
        if normal.dot(flat) >= CREASE { normal } else { flat }
    }
}

/// The angle at each corner.
fn angles(corners: &[Vec3; 3]) -> [f32; 3] {
    let [a, b, c] = *corners;
    [(b - a).angle_between(c - a), (c - b).angle_between(a - b), (a - c).angle_between(b - c)]
}

/// The normal of a counter-clockwise triangle, not normalized; its length is twice the area.
pub(super) fn cross([a, b, c]: [Vec3; 3]) -> Vec3 {
    (b - a).cross(c - a)
}
