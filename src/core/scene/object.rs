//! One object of a loaded scene.

use glam::Vec3;

use super::light::Sphere;
use super::material::Material;

/// One object of a loaded scene: all triangles of one material of one [`MeshDesc`](super::MeshDesc).
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    /// The name in the project; where a file was split by material, "name/material".
    pub name: String,
    /// Index of its description in the scene.
    pub desc: usize,
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
