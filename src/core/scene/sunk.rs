//! Glass and mirrors that stand in the receiver, which cuts them off.

use glam::Vec3;

use super::geometry::Geometry;
use super::object::Mesh;
use super::receiver::Receiver;
use crate::Note;
use crate::note::About;
use crate::setting::format::number;

/// Share of its height by which an object may reach below the plane without a note: contact by a hair is meant.
const MEANT: f64 = 0.01;

/// Heights over the plane (m).
#[derive(Clone, Copy, Default)]
struct Heights {
    /// Of all of an object and the plane itself.
    lowest: f64,
    highest: f64,
    /// Of what is under the receiver or its floor; 0 where nothing is.
    deepest: f64,
}

/// A note for each object of glass or mirror of which the receiver or its floor cuts off a part.
pub(super) fn sunk_notes(geometry: &Geometry, receiver: &Receiver) -> Vec<Note> {
    let may_be_sunk = |mesh: &Mesh| mesh.material.is_specular() && box_reaches_below(mesh, receiver);
    let mut heights: Vec<Option<Heights>> =
        geometry.meshes().iter().map(|mesh| may_be_sunk(mesh).then(Heights::default)).collect();
    if heights.iter().all(Option::is_none) {
        return Vec::new();
    }
    geometry.each_triangle(&mut |_, surface, corners| {
        for mesh in geometry.meshes_of(surface) {
            if let Some(of_mesh) = &mut heights[usize::from(mesh)] {
                corners.iter().for_each(|corner| of_mesh.include(*corner, receiver));
            }
        }
    });
    let noted = geometry.meshes().iter().zip(heights).filter_map(|(mesh, heights)| Some((mesh, heights?)));
    let sunk = noted.filter(|(_, heights)| heights.is_sunk());
    sunk.map(|(mesh, heights)| About::Mesh(mesh.desc).note(words(mesh, &heights))).collect()
}

fn box_reaches_below(mesh: &Mesh, receiver: &Receiver) -> bool {
    let half = (mesh.upper - mesh.lower) / 2.0;
    receiver.height(mesh.lower + half) < f64::from(half.dot(receiver.normal().abs()))
}

impl Heights {
    fn include(&mut self, corner: Vec3, receiver: &Receiver) {
        let height = receiver.height(corner);
        self.lowest = self.lowest.min(height);
        self.highest = self.highest.max(height);
        if height < self.deepest && receiver.reaches(receiver.plane_from_world(corner)) {
            self.deepest = height;
        }
    }

    fn is_sunk(&self) -> bool {
        -self.deepest > MEANT * (self.highest - self.lowest)
    }
}

fn words(mesh: &Mesh, heights: &Heights) -> String {
    let (name, depth) = (&mesh.name, number(-heights.deepest, false));
    let place = format!("scene.meshes[{}].transform.translate", mesh.desc);
    if heights.highest <= 0.0 {
        return format!(
            "'{name}' lies behind the receiver, where no light comes; move it to the lit side ({place})"
        );
    }
    format!(
        "'{name}' stands {depth} m deep in the receiver, which cuts it off there; move it out by that ({place})"
    )
}
