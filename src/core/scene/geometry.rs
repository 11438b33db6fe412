//! The geometry of a loaded scene: its meshes and their acceleration structure.

use std::path::PathBuf;

use glam::Vec3;

use super::accel::{Accel, Triangle};
use super::check;
use super::light::Sphere;
use super::material::Material;
use super::mesh::{self, MeshDesc};
use crate::{Progress, Result};

/// One object of a loaded scene: all triangles of one material of one [`MeshDesc`].
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    /// The name in the project; where a file was split by material, "name/material".
    pub name: String,
    /// Its resolved material.
    pub material: Material,
    /// Lower corner of its bounds, world (m).
    pub lower: Vec3,
    /// Upper corner of its bounds, world (m).
    pub upper: Vec3,
    /// Radius of the bounding sphere around the middle of its bounds (m).
    pub radius: f32,
    /// Where solids of glass overlap, the mesh of the higher priority fills the space; equal priorities: the later mesh.
    pub priority: i32,
    /// Triangles after clean-up.
    pub triangles: usize,
}

impl Mesh {
    /// Its bounding sphere, slightly enlarged, so that rounding leaves no vertex outside.
    pub fn bounding_sphere(&self) -> Sphere {
        Sphere { centre: (self.lower + self.upper) / 2.0, radius: self.radius * 1.0001 }
    }
}

/// All meshes of a scene with their acceleration structure; independent of lights, camera and receiver.
pub struct Geometry {
    pub(super) meshes: Vec<Mesh>,
    pub(super) accel: Accel,
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
    ) -> Result<(Self, Vec<String>)> {
        let mut notes = Vec::new();
        let mut meshes = Vec::new();
        let mut triangles = Vec::new();
        for (index, mesh_desc) in descs.iter().enumerate() {
            let place = format!("scene.meshes[{index}]");
            for part in mesh::load(mesh_desc, &place, assets, &mut notes, progress)? {
                let corners = || part.triangles.iter().flat_map(|t| t.corners);
                let number = meshes.len() as u16;
                let lower = corners().fold(Vec3::INFINITY, Vec3::min);
                let upper = corners().fold(Vec3::NEG_INFINITY, Vec3::max);
                let middle = (lower + upper) / 2.0;
                meshes.push(Mesh {
                    name: part.name,
                    material: part.material,
                    lower,
                    upper,
                    radius: corners().map(|p| p.distance(middle)).fold(0.0, f32::max),
                    priority: mesh_desc.priority,
                    triangles: part.triangles.len(),
                });
                triangles.extend(part.triangles.into_iter().map(|t| Triangle { mesh: number, ..t }));
                check::count("scene.meshes", meshes.len())?;
            }
        }
        Ok((Self { accel: Accel::new(&triangles, progress)?, meshes }, notes))
    }
}
