//! The triangles that lie in the plane of the receiver.

use std::collections::BTreeMap;

use glam::Vec3;

use super::super::geometry::Geometry;
use super::super::material::Material;
use super::super::receiver::Receiver;
use super::super::surface::{Hit, Primitive};
use super::touching::{largest, rounding};

/// The triangles in the plane of the receiver, some of them on it or on its floor.
pub(in crate::scene) struct OnReceiver {
    /// By primitive.
    is_on: Vec<bool>,
    /// What touches, and what that means.
    pub notes: Vec<String>,
}

impl OnReceiver {
    /// None where nothing touches the receiver.
    pub(in crate::scene) fn new(geometry: &Geometry, receiver: &Receiver) -> Option<Self> {
        let mut is_on = Vec::new();
        // Whether any of its triangles there faces up, as a table top does.
        let mut touching = BTreeMap::<u16, bool>::new();
        geometry.each_triangle(&mut |primitive, surface, corners| {
            if !lies_on(corners, receiver) {
                return;
            }
            let index = primitive.0 as usize;
            is_on.resize(is_on.len().max(index + 1), false);
            is_on[index] = true;
            let [a, b, c] = *corners;
            let is_top = (b - a).cross(c - a).dot(receiver.normal()) > 0.0;
            geometry.meshes_of(surface).for_each(|mesh| *touching.entry(mesh).or_default() |= is_top);
        });
        let notes = touching.into_iter().filter_map(|of| note(geometry, receiver, of)).collect();
        (!is_on.is_empty()).then_some(Self { is_on, notes })
    }

    /// Whether a hit is on one of them.
    pub(in crate::scene) fn contains(&self, hit: &Hit) -> bool {
        hit.primitive != Primitive::FLOOR && self.is_on.get(hit.primitive.0 as usize).is_some_and(|is| *is)
    }
}

/// Whether a triangle lies in the plane, within rounding, with some of it on the receiver or its floor.
fn lies_on(corners: &[Vec3; 3], receiver: &Receiver) -> bool {
    let tolerance = rounding(largest(corners).max(receiver.largest_coordinate()));
    if corners.iter().any(|corner| receiver.height(*corner).abs() > tolerance) {
        return false;
    }
    let plane = corners.map(|corner| receiver.plane_from_world(corner));
    let (lower, upper) = receiver.reach();
    plane.iter().any(|p| p.x > lower.x)
        && plane.iter().any(|p| p.y > lower.y)
        && plane.iter().any(|p| p.x < upper.x)
        && plane.iter().any(|p| p.y < upper.y)
}

/// What it means; none for a matt thing that merely stands there.
fn note(geometry: &Geometry, receiver: &Receiver, (mesh, is_top): (u16, bool)) -> Option<String> {
    let mesh = &geometry.meshes()[usize::from(mesh)];
    let is_flat = [mesh.lower, mesh.upper].iter().all(|corner| {
        receiver.height(*corner).abs()
            <= rounding(corner.abs().max_element().max(receiver.largest_coordinate()))
    });
    match mesh.material {
        Material::Glass(_) => Some(format!(
            "'{}' touches the receiver: light goes from it to the receiver without air between; raise it by 1e-6 m for a gap",
            mesh.name
        )),
        Material::Mirror(_) | Material::Diffuse(_) => (is_top || is_flat).then(|| {
            format!(
                "'{}' lies in the receiver's plane: where both are, it is the receiver that is lit and seen",
                mesh.name
            )
        }),
    }
}
