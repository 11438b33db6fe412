//! The triangles that lie in the plane of the receiver.

use std::collections::BTreeMap;

use glam::Vec3;

use super::super::geometry::Geometry;
use super::super::material::Material;
use super::super::receiver::Receiver;
use super::super::surface::{Hit, Primitive};
use super::touching::{NEARLY, largest, rounding};
use crate::Note;
use crate::note::About;

/// The triangles in the plane of the receiver, some of them on it or on its floor.
pub(in crate::scene) struct OnReceiver {
    /// By primitive.
    is_on: Vec<bool>,
}

impl OnReceiver {
    /// Those of a scene, none where nothing touches the receiver; with notes on what touches it, or nearly does.
    pub(in crate::scene) fn new(geometry: &Geometry, receiver: &Receiver) -> (Option<Self>, Vec<Note>) {
        let mut is_on = Vec::new();
        // Whether any of its triangles there faces up, as a table top does.
        let mut touching = BTreeMap::<u16, bool>::new();
        let mut near = BTreeMap::<u16, f64>::new();
        geometry.each_triangle(&mut |primitive, surface, corners| {
            let Some((distance, is_touching)) = apart(corners, receiver) else { return };
            for mesh in geometry.meshes_of(surface) {
                if is_touching {
                    let [a, b, c] = *corners;
                    let is_top = (b - a).cross(c - a).dot(receiver.normal()) > 0.0;
                    *touching.entry(mesh).or_default() |= is_top;
                } else {
                    let largest = near.entry(mesh).or_default();
                    *largest = distance.max(*largest);
                }
            }
            if is_touching {
                let index = primitive.0 as usize;
                is_on.resize(is_on.len().max(index + 1), false);
                is_on[index] = true;
            }
        });
        let mut notes: Vec<Note> =
            touching.into_iter().filter_map(|of| note(geometry, receiver, of)).collect();
        notes.extend(near.into_iter().filter_map(|of| near_note(geometry, of)));
        ((!is_on.is_empty()).then_some(Self { is_on }), notes)
    }

    /// Whether a hit is on one of them.
    pub(in crate::scene) fn contains(&self, hit: &Hit) -> bool {
        hit.primitive != Primitive::FLOOR && self.is_on.get(hit.primitive.0 as usize).is_some_and(|is| *is)
    }
}

/// The distance (m) of a triangle that lies in the plane, or nearly, with some of it on the receiver or its floor; and whether
/// it is rounding alone.
fn apart(corners: &[Vec3; 3], receiver: &Receiver) -> Option<(f64, bool)> {
    let tolerance = rounding(largest(corners).max(receiver.largest_coordinate()));
    let distance = corners.iter().map(|corner| receiver.height(*corner).abs()).fold(0.0, f64::max);
    if distance > NEARLY * tolerance {
        return None;
    }
    let plane = corners.map(|corner| receiver.plane_from_world(corner));
    let (lower, upper) = receiver.reach();
    let is_over = plane.iter().any(|p| p.x > lower.x)
        && plane.iter().any(|p| p.y > lower.y)
        && plane.iter().any(|p| p.x < upper.x)
        && plane.iter().any(|p| p.y < upper.y);
    is_over.then_some((distance, distance <= tolerance))
}

fn near_note(geometry: &Geometry, (mesh, distance): (u16, f64)) -> Option<Note> {
    let mesh = &geometry.meshes()[usize::from(mesh)];
    matches!(mesh.material, Material::Glass(_)).then(|| {
        About::Mesh(mesh.desc).note(format!(
            "'{}' nearly touches the receiver, up to {distance:.0e} m apart: where it stands above there is a film of air, \
             where it reaches below there is contact; set it exactly on the receiver, or 1e-4 m above, if that is not meant",
            mesh.name
        ))
    })
}

/// What it means; none for a matt thing that merely stands there.
fn note(geometry: &Geometry, receiver: &Receiver, (mesh, is_top): (u16, bool)) -> Option<Note> {
    let mesh = &geometry.meshes()[usize::from(mesh)];
    let is_flat = [mesh.lower, mesh.upper].iter().all(|corner| {
        receiver.height(*corner).abs()
            <= rounding(corner.abs().max_element().max(receiver.largest_coordinate()))
    });
    let text = match mesh.material {
        Material::Glass(_) => Some(format!(
            "'{}' touches the receiver: light goes from it to the receiver without air between; raise it by 1e-4 m for a gap",
            mesh.name
        )),
        Material::Mirror(_) | Material::Diffuse(_) => (is_top || is_flat).then(|| {
            format!(
                "'{}' lies in the receiver's plane: where both are, it is the receiver that is lit and seen",
                mesh.name
            )
        }),
    };
    text.map(|text| About::Mesh(mesh.desc).note(text))
}
