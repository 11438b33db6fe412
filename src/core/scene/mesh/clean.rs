//! Clean-up of faces: equal vertices welded, degenerate faces dropped, glass wound outward; notes count what remains.

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use super::normals::{self, cross};
use super::obj::{Face, Group, NONE};
use crate::scene::accel::Triangle;
use crate::scene::material::Material;

/// The triangles of one material.
pub(super) fn triangles(
    group: &Group,
    smooth: bool,
    material: &Material,
    name: &str,
    notes: &mut Vec<String>,
) -> Vec<Triangle> {
    let welded = weld(&group.positions);
    let mut kept: Vec<Face> = group.faces.iter().copied().filter(|face| has_area(group, face)).collect();
    let mut note = |count: usize, what: &str| {
        if count > 0 {
            notes.push(format!("{name}: {count} {what}"));
        }
    };
    note(group.faces.len() - kept.len(), "triangles without area were dropped");
    note(group.crossed, "polygons cross themselves; mend them, or split them into triangles");
    let vertices: Vec<[u32; 3]> = kept.iter().map(|face| face.vertices.map(|v| welded[v as usize])).collect();
    if matches!(material, Material::Glass(_)) {
        let edges = Edges::count(&vertices);
        note(
            edges.open,
            "open edges: this glass has no inside, so refraction through it is a guess; close the mesh",
        );
        note(
            edges.inconsistent,
            "edges whose two faces are wound against each other; recalculate the normals outside",
        );
        if edges.open + edges.inconsistent == 0 && volume(group, &kept) < 0.0 {
            kept.iter_mut().for_each(flip);
            note(kept.len(), "triangles faced inward; the mesh was turned inside out");
        }
    }
    let (triangles, turned) = normals::shade(group, &kept, &welded, smooth);
    note(turned, "corner normals pointed against their face and were turned");
    triangles
}

/// Whether a face has an area that f32 can tell from 0.
fn has_area(group: &Group, face: &Face) -> bool {
    let [a, b, c] = face.vertices.map(|v| group.positions[v as usize]);
    let longest = (b - a).length_squared().max((c - b).length_squared()).max((a - c).length_squared());
    let area = cross([a, b, c]).length();
    // A squared length below the smallest normal number has lost its digits.
    area > 1e-7 * longest && area * area > f32::MIN_POSITIVE
}

fn flip(face: &mut Face) {
    face.vertices.swap(1, 2);
    face.normals.swap(1, 2);
}

/// For every vertex the first vertex at the same position.
fn weld(positions: &[Vec3]) -> Vec<u32> {
    // Adding 0 turns -0 into 0, so that equal positions have equal bits.
    let key = |i: u32| (positions[i as usize] + 0.0).to_array().map(f32::to_bits);
    let mut order: Vec<u32> = (0..positions.len() as u32).collect();
    order.par_sort_unstable_by_key(|i| (key(*i), *i));
    let mut welded = vec![NONE; positions.len()];
    let mut first = 0;
    for (rank, index) in order.iter().enumerate() {
        if rank == 0 || key(*index) != key(first) {
            first = *index;
        }
        welded[*index as usize] = first;
    }
    welded
}

/// Counts of faulty edges.
struct Edges {
    /// Edges with an odd number of faces.
    open: usize,
    /// Edges that both faces traverse in the same direction.
    inconsistent: usize,
}

impl Edges {
    fn count(faces: &[[u32; 3]]) -> Self {
        let mut edges: Vec<(u32, u32, i8)> = faces
            .par_iter()
            .flat_map_iter(|[a, b, c]| [(*a, *b), (*b, *c), (*c, *a)])
            .map(|(from, to)| if from < to { (from, to, 1) } else { (to, from, -1) })
            .collect();
        edges.par_sort_unstable();
        let mut count = Self { open: 0, inconsistent: 0 };
        for sides in edges.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
            let turns: i32 = sides.iter().map(|side| i32::from(side.2)).sum();
            match (turns, sides.len() % 2) {
                (0, _) => (),
                (_, 1) => count.open += 1,
                _ => count.inconsistent += 1,
            }
        }
        count
    }
}

/// Six times the enclosed volume; negative if the faces are wound inward.
fn volume(group: &Group, faces: &[Face]) -> f64 {
    let origin =
        faces.first().map_or(DVec3::ZERO, |face| group.positions[face.vertices[0] as usize].as_dvec3());
    faces
        .iter()
        .map(|face| {
            let [a, b, c] = face.vertices.map(|v| group.positions[v as usize].as_dvec3() - origin);
            a.dot(b.cross(c))
        })
        .sum()
}
