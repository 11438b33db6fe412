//! What touches, in words.

use std::collections::{BTreeMap, BTreeSet};

use super::super::material::Material;
use super::super::object::Mesh;
use crate::Note;
use crate::note::About;

/// Most pairs that are named.
const MOST: usize = 12;

/// Two meshes whose surfaces lie in one another.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Touch {
    /// Ascending.
    pub meshes: [u16; 2],
    /// Whether their outsides are on the same side.
    pub same_side: bool,
    /// Whether they could not be merged.
    pub is_guess: bool,
}

/// One note for each pair, with what it means.
pub(super) fn notes(meshes: &[Mesh], touches: &BTreeSet<Touch>) -> Vec<Note> {
    // Matt parts of one mesh that lie in one another are seen as one.
    let is_odd =
        |touch: &&Touch| touch.meshes[0] != touch.meshes[1] || is_glass(&meshes[touch.meshes[0] as usize]);
    let count = touches.iter().filter(is_odd).count();
    let mut notes: Vec<Note> =
        touches.iter().filter(is_odd).take(MOST).map(|touch| note(meshes, touch)).collect();
    if count > MOST {
        notes.push(About::Project.note(format!("{} more pairs of objects touch", count - MOST)));
    }
    notes
}

/// One note for each two meshes of which one is glass, and which nearly touch.
pub(super) fn near_notes(meshes: &[Mesh], near: &BTreeMap<[u16; 2], f64>) -> Vec<Note> {
    let glass = |mesh: &u16| is_glass(&meshes[usize::from(*mesh)]);
    let pairs = near.iter().filter(|([a, b], _)| a != b && (glass(a) || glass(b)));
    let note = |([a, b], distance): (&[u16; 2], &f64)| {
        let [a, b] = [a, b].map(|mesh| &meshes[usize::from(*mesh)]);
        About::Mesh(a.desc).note(format!(
            "'{}' and '{}' nearly touch, {distance:.0e} m apart: a gap is a film of air, an overlap is contact; let them \
             meet exactly, or overlap by more, if that is not meant",
            a.name, b.name
        ))
    };
    pairs.take(MOST).map(note).collect()
}

fn is_glass(mesh: &Mesh) -> bool {
    matches!(mesh.material, Material::Glass(_))
}

fn note(meshes: &[Mesh], touch: &Touch) -> Note {
    About::Mesh(meshes[touch.meshes[0] as usize].desc).note(words(meshes, touch))
}

fn words(meshes: &[Mesh], touch: &Touch) -> String {
    let [a, b] = touch.meshes.map(|mesh| &meshes[mesh as usize]);
    let names = format!("'{}' and '{}'", a.name, b.name);
    if touch.is_guess {
        return format!(
            "{names} lie in one another along a surface that is not flat, with different triangles, so light there is a \
             guess; give both the same triangles there, or let them overlap by a hair"
        );
    }
    if touch.meshes[0] == touch.meshes[1] {
        return format!("'{}' has parts that touch; they are one solid there", a.name);
    }
    // In the list, b comes later.
    let wins = if a.priority > b.priority { a } else { b };
    match (is_glass(a), is_glass(b)) {
        (true, true) if !touch.same_side => {
            format!("{names} touch: light goes from one to the other without air between")
        }
        (true, true) => {
            format!("{names} lie in one another: one glass, that of '{}', fills what they share", wins.name)
        }
        (false, false) => format!("{names} lie in one another: '{}' is seen", wins.name),
        (glass, _) => {
            let (glass, other) = if glass { (a, b) } else { (b, a) };
            format!("'{}' touches '{}': light goes to it without air between", glass.name, other.name)
        }
    }
}
