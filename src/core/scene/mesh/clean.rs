//! Clean-up of faces: equal vertices welded, degenerate and doubled faces dropped, glass wound outward; notes count what
//! remains.

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use super::normals::{self, cross};
use super::obj::{Face, Group, NONE};
use super::shells::{Sides, inward};
use crate::scene::accel::Triangle;
use crate::scene::material::Material;
use crate::{Progress, Result};

/// The triangles of one material, and for each its shell, numbered from 0. Checked for a cancel between the steps, each of which takes
/// some tenths of a second of a million triangles.
///
/// # Errors
/// `Cancelled`.
pub(super) fn triangles(
    group: &Group,
    smooth: bool,
    (material, name): (&Material, &str),
    notes: &mut Vec<String>,
    progress: &Progress,
) -> Result<(Vec<Triangle>, Vec<u32>)> {
    let welded = weld(&group.positions);
    progress.check()?;
    let mut kept: Vec<Face> = group.faces.iter().copied().filter(|face| has_area(group, face)).collect();
    let mut note = |count: usize, what: &str| {
        if count > 0 {
            notes.push(format!("{name}: {count} {what}"));
        }
    };
    note(group.faces.len() - kept.len(), "triangles without area were dropped");
    note(group.crossed, "polygons cross themselves or have thousands of corners; split them into triangles");
    let is_glass = matches!(material, Material::Glass(_));
    let vertices = |kept: &[Face]| -> Vec<[u32; 3]> {
        kept.iter().map(|face| face.vertices.map(|v| welded[v as usize])).collect()
    };
    let doubled = Doubled::of(&vertices(&kept));
    progress.check()?;
    note(kept.len() - doubled.once.len(), "faces stand twice; one of each was kept");
    if kept.len() > doubled.once.len() {
        kept = doubled.once.iter().map(|face| kept[*face as usize]).collect();
    }
    if is_glass && doubled.both_sides.contains(&true) {
        let walls = inner_walls(&vertices(&kept), &doubled.both_sides);
        note(walls.iter().filter(|is| **is).count(), "faces between parts of the same glass were dropped");
        let mut is_wall = walls.into_iter();
        kept.retain(|_| !is_wall.next().unwrap_or(false));
    }
    let sides = Sides::new(&vertices(&kept));
    progress.check()?;
    let shells = sides.shells(kept.len(), false);
    progress.check()?;
    if is_glass {
        let corners: Vec<[DVec3; 3]> = kept
            .par_iter()
            .map(|face| face.vertices.map(|v| group.positions[v as usize].as_dvec3()))
            .collect();
        let inward = inward(&sides, &shells, &corners);
        progress.check()?;
        let turned = inward.iter().filter(|is| **is).count();
        kept.iter_mut().zip(inward).filter(|(_, is)| *is).for_each(|(face, _)| flip(face));
        if turned == kept.len() {
            note(turned, "triangles faced inward; the mesh was turned inside out");
        } else {
            let what =
                format!("of {} triangles faced inward, as after mirroring, and were turned", kept.len());
            note(turned, &what);
        }
        let (open, inconsistent) = Sides::new(&vertices(&kept)).faulty();
        note(
            open,
            "open edges: this glass has no inside, so refraction through it is a guess; close the mesh",
        );
        note(
            inconsistent,
            "edges whose two faces are wound against each other; recalculate the normals outside",
        );
    }
    progress.check()?;
    let (triangles, turned) = normals::shade(group, &kept, &compact(vertices(&kept)), smooth);
    note(turned, "corner normals pointed against their face and were turned");
    Ok((triangles, shells))
}

/// Faces of the same three vertices.
struct Doubled {
    /// The first face of each three vertices, ascending.
    once: Vec<u32>,
    /// For each of them, whether there are faces of both windings.
    both_sides: Vec<bool>,
}

impl Doubled {
    fn of(faces: &[[u32; 3]]) -> Self {
        // From the lowest vertex on, then whether the winding is that of ascending vertices.
        let key = |face: u32| {
            let [a, b, c] = faces[face as usize];
            let [a, b, c] = if a < b && a < c {
                [a, b, c]
            } else if b < c {
                [b, c, a]
            } else {
                [c, a, b]
            };
            ([a, b.min(c), b.max(c)], b < c)
        };
        let mut order: Vec<u32> = (0..faces.len() as u32).collect();
        order.par_sort_unstable_by_key(|face| (key(*face).0, *face));
        let groups = order.chunk_by(|a, b| key(*a).0 == key(*b).0);
        let mut once: Vec<(u32, bool)> = groups
            .map(|group| (group[0], group.iter().any(|face| key(*face).1 != key(group[0]).1)))
            .collect();
        once.sort_unstable();
        let (once, both_sides) = once.into_iter().unzip();
        Self { once, both_sides }
    }
}

/// Of faces that stood there with both windings, those between two parts that are closed without them; the others are the two
/// sides of one skin.
fn inner_walls(faces: &[[u32; 3]], both_sides: &[bool]) -> Vec<bool> {
    let sides = Sides::new(faces);
    let shells = sides.shells(faces.len(), true);
    let mut are_walls = sides.closed(&shells, |face| !both_sides[face as usize]);
    let mut has_skin = vec![false; are_walls.len()];
    shells.iter().zip(both_sides).for_each(|(shell, both)| has_skin[*shell as usize] |= !both);
    are_walls.iter_mut().zip(has_skin).for_each(|(are, skin)| *are &= skin);
    shells.iter().zip(both_sides).map(|(shell, both)| *both && are_walls[*shell as usize]).collect()
}

/// The same vertices, numbered without gaps.
fn compact(mut faces: Vec<[u32; 3]>) -> Vec<[u32; 3]> {
    let mut used: Vec<u32> = faces.iter().flatten().copied().collect();
    used.par_sort_unstable();
    used.dedup();
    let number = |v: u32| used.binary_search(&v).map_or(0, |at| at as u32);
    faces.par_iter_mut().for_each(|face| *face = face.map(number));
    faces
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
