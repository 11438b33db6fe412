//! The triangles from which the hierarchy is built.

use glam::Vec3;

/// One triangle with its shading normals and mesh.
#[derive(Clone, Copy, Debug)]
pub(in crate::scene) struct Triangle {
    pub corners: [Vec3; 3],
    /// Unit shading normals at the corners, on the side of the geometric normal.
    pub normals: [Vec3; 3],
    pub mesh: u16,
}
