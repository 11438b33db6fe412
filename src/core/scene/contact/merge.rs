//! One triangle for each place where triangles of several solids lie in one another.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use super::super::accel::Triangle;
use super::super::check;
use super::super::material::Material;
use super::super::object::Mesh;
use super::arrangement::{Arrangement, same_corners, same_side};
use super::interface::Contact;
use super::notes::{Touch, near_notes, notes};
use super::touching::{Pairs, touching};
use crate::{Note, Progress, Result};

/// Triangles of which no two lie in one another.
pub(in crate::scene) struct Merged {
    /// Their [`Triangle::mesh`] is a mesh, or from the number of meshes on a contact.
    pub triangles: Vec<Triangle>,
    /// The contacts.
    pub contacts: Vec<Contact>,
    /// What touches, and what that means.
    pub notes: Vec<Note>,
}

/// Merges the triangles that lie in one another. `shells` numbers the connected surfaces, one for each triangle. Without any
/// contact, triangles and their order stay.
///
/// # Errors
/// `Cancelled`; more objects and contacts than can be told apart.
pub(in crate::scene) fn merge(
    triangles: Vec<Triangle>,
    shells: &[u32],
    meshes: &[Mesh],
    progress: &Progress,
) -> Result<Merged> {
    let Pairs { touching: pairs, near } = touching(&triangles, shells, progress)?;
    let notes_on_near = near_notes(meshes, &near_meshes(&triangles, &near));
    if pairs.is_empty() {
        return Ok(Merged { triangles, contacts: Vec::new(), notes: notes_on_near });
    }
    let mut merger = Merger {
        triangles: &triangles,
        shells,
        meshes,
        contacts: Vec::new(),
        numbers: HashMap::new(),
        touches: pairs.iter().map(|pair| touch(&triangles, *pair)).collect(),
    };
    let mut is_in_contact = vec![false; triangles.len()];
    let mut merged = Vec::new();
    for cluster in clusters(&pairs, triangles.len()) {
        progress.check()?;
        cluster.iter().for_each(|index| is_in_contact[*index as usize] = true);
        merger.cluster(&cluster, &mut merged);
        check::count("scene.meshes, with their contacts", meshes.len() + merger.contacts.len())?;
    }
    let Merger { contacts, touches, .. } = merger;
    let mut kept: Vec<Triangle> =
        triangles.iter().zip(&is_in_contact).filter(|(_, is)| !**is).map(|(t, _)| *t).collect();
    kept.extend(merged);
    let mut notes = notes(meshes, &touches);
    notes.extend(notes_on_near);
    Ok(Merged { triangles: kept, contacts, notes })
}

/// The largest distance (m) of the triangles of two meshes that nearly touch.
fn near_meshes(triangles: &[Triangle], near: &[(u32, u32, f64)]) -> BTreeMap<[u16; 2], f64> {
    let mut found = BTreeMap::new();
    for (a, b, distance) in near {
        let [a, b] = [a, b].map(|index| triangles[*index as usize].mesh);
        let largest = found.entry([a.min(b), a.max(b)]).or_insert(0.0);
        *largest = distance.max(*largest);
    }
    found
}

/// How the meshes of two triangles touch.
fn touch(triangles: &[Triangle], (a, b): (u32, u32)) -> Touch {
    let [a, b] = [a, b].map(|index| &triangles[index as usize]);
    let facing = same_side(&a.corners, &b.corners);
    Touch { meshes: [a.mesh.min(b.mesh), a.mesh.max(b.mesh)], same_side: facing, is_guess: false }
}

/// Groups of triangles that touch each other, directly or by way of others, each ascending.
fn clusters(pairs: &[(u32, u32)], count: usize) -> Vec<Vec<u32>> {
    let mut parent: Vec<u32> = (0..count as u32).collect();
    fn root(parent: &mut [u32], mut index: u32) -> u32 {
        while parent[index as usize] != index {
            parent[index as usize] = parent[parent[index as usize] as usize];
            index = parent[index as usize];
        }
        index
    }
    for (a, b) in pairs {
        let (a, b) = (root(&mut parent, *a), root(&mut parent, *b));
        // The lowest index is the root.
        parent[a.max(b) as usize] = a.min(b);
    }
    let mut groups = BTreeMap::<u32, BTreeSet<u32>>::new();
    for index in pairs.iter().flat_map(|(a, b)| [*a, *b]) {
        groups.entry(root(&mut parent, index)).or_default().insert(index);
    }
    groups.into_values().map(|group| group.into_iter().collect()).collect()
}

struct Merger<'a> {
    triangles: &'a [Triangle],
    shells: &'a [u32],
    meshes: &'a [Mesh],
    contacts: Vec<Contact>,
    numbers: HashMap<Contact, u16>,
    touches: BTreeSet<Touch>,
}

impl Merger<'_> {
    /// Replaces a cluster by triangles that do not lie in one another.
    fn cluster(&mut self, cluster: &[u32], merged: &mut Vec<Triangle>) {
        let triangles: Vec<Triangle> = cluster.iter().map(|index| self.triangles[*index as usize]).collect();
        let corners: Vec<_> = triangles.iter().map(|triangle| triangle.corners).collect();
        if corners[1..].iter().all(|other| same_corners(&corners[0], other)) {
            let up = |k: usize| same_side(&corners[0], &corners[k]);
            let all: Vec<usize> = (0..cluster.len()).collect();
            let place = self.place(cluster, &all, &up);
            merged.extend(place.map(|(owner, mesh)| Triangle { mesh, ..triangles[owner] }));
            return;
        }
        let arrangement = Arrangement::new(&corners);
        let pieces = arrangement.as_ref().and_then(|arrangement| arrangement.pieces(&corners));
        let (Some(arrangement), Some(pieces)) = (arrangement, pieces) else {
            self.touches.extend(touches_by_guess(&triangles));
            merged.extend(triangles);
            return;
        };
        for piece in pieces {
            let up = |k: usize| arrangement.faces_up(k);
            let Some((owner, mesh)) = self.place(cluster, &piece.of, &up) else { continue };
            let [a, mut b, mut c] = piece.corners;
            if !arrangement.faces_up(owner) {
                (b, c) = (c, b);
            }
            // Not normalized: as linear over the part as over the whole.
            let normal = |corner| {
                let weights = arrangement.weights(owner, corner);
                (0..3).map(|k| triangles[owner].normals[k] * weights[k]).sum()
            };
            if (b - a).cross(c - a).length_squared() > f32::MIN_POSITIVE {
                merged.push(Triangle { corners: [a, b, c], normals: [a, b, c].map(normal), mesh });
            }
        }
    }

    /// The triangle that stands for those at a place, by index into its cluster, and the number of the surface there; none
    /// where nothing begins or ends.
    fn place(&mut self, cluster: &[u32], of: &[usize], up: &dyn Fn(usize) -> bool) -> Option<(usize, u16)> {
        let mesh = |k: usize| self.triangles[cluster[k] as usize].mesh;
        let rank = |k: &usize| (self.meshes[mesh(*k) as usize].priority, mesh(*k), usize::MAX - *k);
        let is_opaque = |k: &usize| !matches!(self.meshes[mesh(*k) as usize].material, Material::Glass(_));
        if let Some(owner) = of.iter().copied().filter(is_opaque).max_by_key(rank) {
            return Some((owner, mesh(owner)));
        }
        let owner = of.iter().copied().max_by_key(rank)?;
        let mut seen = BTreeSet::new();
        let once = of.iter().filter(|k| seen.insert(self.shells[cluster[**k] as usize]));
        let mut sides: Vec<(u16, bool)> = once.map(|k| (mesh(*k), up(*k) == up(owner))).collect();
        if sides.len() == 1 {
            return Some((owner, mesh(owner)));
        }
        sides.sort_unstable();
        let net = |of: u16| -> i32 {
            sides.iter().filter(|side| side.0 == of).map(|side| if side.1 { 1 } else { -1 }).sum()
        };
        if sides.iter().all(|side| net(side.0) == 0) {
            return None;
        }
        let contact = Contact { owner: mesh(owner), sides };
        let next = (self.meshes.len() + self.contacts.len()) as u16;
        let number = *self.numbers.entry(contact.clone()).or_insert_with(|| {
            self.contacts.push(contact);
            next
        });
        Some((owner, number))
    }
}

/// Those of a cluster that was left as it is.
fn touches_by_guess(triangles: &[Triangle]) -> Vec<Touch> {
    let meshes: BTreeSet<u16> = triangles.iter().map(|triangle| triangle.mesh).collect();
    let [first, last] = [meshes.first(), meshes.last()].map(|mesh| mesh.copied().unwrap_or_default());
    vec![Touch { meshes: [first, last], same_side: true, is_guess: true }]
}
