//! The geometry of a loaded scene: its meshes and their acceleration structure.

use std::path::PathBuf;

use glam::Vec3;

use super::accel::{Accel, Triangle};
use super::check;
use super::contact::{Contact, Merged, merge};
use super::media::Media;
use super::mesh::{self, MeshDesc};
use super::object::Mesh;
use super::surface::{Hit, Primitive, Ray, SurfaceId};
use crate::note::About;
use crate::{Note, Progress, Result};

/// All meshes of a scene with their acceleration structure; independent of lights, camera and receiver.
pub struct Geometry {
    meshes: Vec<Mesh>,
    /// The places where solids lie in one another; their numbers follow those of the meshes.
    contacts: Vec<Contact>,
    accel: Accel,
}

impl Geometry {
    /// Reads, checks and indexes meshes; with notes for the artist. `assets` as in [`Scene::load`](super::Scene::load).
    ///
    /// # Errors
    /// The place of the first value or file that cannot be used; `Cancelled`.
    pub fn load(
        descs: &[MeshDesc],
        assets: &dyn Fn(&str, &str) -> Result<PathBuf>,
        progress: &Progress,
    ) -> Result<(Self, Vec<Note>)> {
        let mut notes = Vec::new();
        match Self::read(descs, assets, &mut notes, progress) {
            Ok(geometry) => Ok((geometry, notes)),
            Err(error) => Err(error.with_notes(&notes)),
        }
    }

    fn read(
        descs: &[MeshDesc],
        assets: &dyn Fn(&str, &str) -> Result<PathBuf>,
        notes: &mut Vec<Note>,
        progress: &Progress,
    ) -> Result<Self> {
        let mut meshes = Vec::new();
        let mut triangles = Vec::new();
        let (mut shells, mut next_shell) = (Vec::new(), 0);
        let mut files = mesh::GltfFiles::default();
        for (index, mesh_desc) in descs.iter().enumerate().filter(|(_, desc)| desc.enabled) {
            let place = format!("scene.meshes[{index}]");
            let mut of_mesh = Vec::new();
            let parts = mesh::load(mesh_desc, &place, assets, &mut files, &mut of_mesh, progress);
            notes.extend(About::Mesh(index).notes(of_mesh));
            for part in parts? {
                let number = meshes.len() as u16;
                shells.extend(part.shells.iter().map(|shell| next_shell + shell));
                next_shell += part.shells.iter().max().map_or(0, |last| last + 1);
                meshes.push(object(&part, index, mesh_desc.priority));
                triangles.extend(part.triangles.into_iter().map(|t| Triangle { mesh: number, ..t }));
                check::count("scene.meshes", meshes.len())?;
            }
        }
        let merged = merge(triangles, &shells, &meshes, progress)?;
        let Merged { triangles, contacts, notes: of_contact } = merged;
        notes.extend(of_contact);
        Ok(Self { accel: Accel::new(&triangles, progress)?, meshes, contacts })
    }

    /// All meshes.
    pub fn meshes(&self) -> &[Mesh] {
        &self.meshes
    }

    /// The nearest hit before `limit`; the triangle the ray leaves is skipped. Its surface is a number, for [`Self::known`],
    /// where there are contacts.
    #[inline]
    pub(super) fn intersect(&self, ray: &Ray, limit: f32) -> Option<Hit> {
        self.accel.intersect(ray, limit)
    }

    /// The hit with its surface, a mesh or a contact.
    pub(super) fn known(&self, hit: Hit) -> Hit {
        Hit { surface: self.surface(hit.surface), ..hit }
    }

    /// Whether any solids lie in one another.
    pub(super) fn has_contacts(&self) -> bool {
        !self.contacts.is_empty()
    }

    /// Whether any triangle but the one the ray leaves is hit before `distance`.
    #[inline]
    pub(super) fn occluded(&self, ray: &Ray, distance: f32) -> bool {
        self.accel.occluded(ray, distance)
    }

    /// Calls `crossed` for every surface of a mesh that is hit, and whether the ray leaves the solid there.
    pub(super) fn each_crossing(&self, ray: &Ray, mut crossed: impl FnMut(u16, bool)) {
        self.accel.each_crossing(ray, |number, leaving| match self.surface(SurfaceId::Mesh(number)) {
            SurfaceId::Contact(contact) => {
                self.contacts[contact as usize].sides.iter().for_each(|(mesh, is_outward)| {
                    crossed(*mesh, leaving == *is_outward);
                });
            }
            _ => crossed(number, leaving),
        });
    }

    /// Calls `each` for every triangle.
    pub(super) fn each_triangle(&self, each: &mut dyn FnMut(Primitive, SurfaceId, &[Vec3; 3])) {
        self.accel.each_triangle(&mut |primitive, number, corners| {
            each(primitive, self.surface(SurfaceId::Mesh(number)), corners);
        });
    }

    /// The surface of a number that is a mesh or, above, a contact.
    #[inline]
    fn surface(&self, number: SurfaceId) -> SurfaceId {
        match number {
            SurfaceId::Mesh(number) if usize::from(number) >= self.meshes.len() => {
                SurfaceId::Contact(number - self.meshes.len() as u16)
            }
            other => other,
        }
    }

    /// The mesh that stands for a surface; none for the receiver and the floor.
    #[inline]
    pub(super) fn mesh_of(&self, surface: SurfaceId) -> Option<u16> {
        match surface {
            SurfaceId::Mesh(mesh) => Some(mesh),
            SurfaceId::Contact(contact) => Some(self.contacts[contact as usize].owner),
            SurfaceId::Receiver | SurfaceId::Floor => None,
        }
    }

    /// All meshes whose surface it is.
    pub(super) fn meshes_of(&self, surface: SurfaceId) -> impl Iterator<Item = u16> + '_ {
        let (single, several): (Option<u16>, &[(u16, bool)]) = match surface {
            SurfaceId::Mesh(mesh) => (Some(mesh), &[]),
            SurfaceId::Contact(contact) => (None, &self.contacts[contact as usize].sides),
            SurfaceId::Receiver | SurfaceId::Floor => (None, &[]),
        };
        single.into_iter().chain(several.iter().map(|side| side.0))
    }

    /// Takes the media before and after a place where several solids of glass lie in one another, both those in which a ray
    /// comes, across it; `inward` tells whether it comes from the outside of the triangle.
    #[cold]
    pub(super) fn cross_contact(
        &self,
        surface: SurfaceId,
        inward: bool,
        (before, after): (&mut Media, &mut Media),
    ) {
        let SurfaceId::Contact(contact) = surface else { return };
        let sides = &self.contacts[contact as usize].sides;
        for (mesh, _) in sides.iter().filter(|side| side.1 != inward) {
            // A ray that leaves what it was not in was in it before.
            if !after.leave(*mesh) {
                before.enter(*mesh);
            }
        }
        sides.iter().filter(|side| side.1 == inward).for_each(|side| after.enter(side.0));
    }
}

/// The object of a part.
fn object(part: &mesh::Part, desc: usize, priority: i32) -> Mesh {
    let corners = || part.triangles.iter().flat_map(|t| t.corners);
    let lower = corners().fold(Vec3::INFINITY, Vec3::min);
    let upper = corners().fold(Vec3::NEG_INFINITY, Vec3::max);
    let middle = (lower + upper) / 2.0;
    Mesh {
        name: part.name.clone(),
        desc,
        material: part.material.clone(),
        lower,
        upper,
        radius: corners().map(|p| p.distance(middle)).fold(0.0, f32::max),
        priority,
        triangles: part.triangles.len(),
    }
}
