//! Objects of glass as OBJ files.

use std::fmt::Write as _;

use glam::{BVec3, Vec3};

/// A closed body of glass.
#[derive(Clone)]
pub(super) struct GlassObject {
    pub(super) shape: Shape,
    pub(super) ior: f32,
    /// Of overlapping objects the one of the highest priority fills the place.
    pub(super) priority: i32,
}

/// A surface; lengths in metres.
#[derive(Clone, Copy)]
pub(super) enum Shape {
    Ball { centre: Vec3, radius: f32 },
    Slab { lower: Vec3, upper: Vec3 },
}

/// Rows of a ball from pole to pole; twice as many columns.
const ROWS: usize = 24;

impl Shape {
    /// The surface as an OBJ file, all lengths times `scale`.
    pub(super) fn obj(self, scale: f32) -> String {
        let (vertices, faces) = match self {
            Self::Ball { centre, radius } => ball(centre, radius),
            Self::Slab { lower, upper } => slab(lower, upper),
        };
        let mut text = String::new();
        for v in vertices {
            let _ = writeln!(text, "v {} {} {}", v.x * scale, v.y * scale, v.z * scale);
        }
        for face in faces {
            let corners: Vec<String> = face.iter().map(|i| (i + 1).to_string()).collect();
            let _ = writeln!(text, "f {}", corners.join(" "));
        }
        text
    }
}

type Surface = (Vec<Vec3>, Vec<Vec<usize>>);

fn ball(centre: Vec3, radius: f32) -> Surface {
    let columns = 2 * ROWS;
    let mut vertices = vec![centre + radius * Vec3::Y];
    for row in 1..ROWS {
        let (sin, cos) = (std::f32::consts::PI * row as f32 / ROWS as f32).sin_cos();
        for column in 0..columns {
            let (z, x) = (std::f32::consts::TAU * column as f32 / columns as f32).sin_cos();
            vertices.push(centre + radius * Vec3::new(sin * x, cos, sin * z));
        }
    }
    vertices.push(centre - radius * Vec3::Y);
    let (top, bottom) = (0, vertices.len() - 1);
    let at = |row: usize, column: usize| 1 + (row - 1) * columns + column % columns;
    let mut faces = Vec::new();
    for column in 0..columns {
        faces.push(vec![top, at(1, column + 1), at(1, column)]);
        faces.push(vec![bottom, at(ROWS - 1, column), at(ROWS - 1, column + 1)]);
        for row in 1..ROWS - 1 {
            faces.push(vec![
                at(row, column),
                at(row, column + 1),
                at(row + 1, column + 1),
                at(row + 1, column),
            ]);
        }
    }
    (vertices, faces)
}

fn slab(lower: Vec3, upper: Vec3) -> Surface {
    let corner = |i: usize| Vec3::select(BVec3::new(i & 1 > 0, i & 2 > 0, i & 4 > 0), upper, lower);
    let faces = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    ((0..8).map(corner).collect(), faces.map(Vec::from).to_vec())
}
