//! The glass solids that contain a point, and the one that fills it.

use super::material::{Glass, Material};
use super::object::Mesh;

/// Most overlapping solids; further ones are ignored.
const DEPTH: usize = 7;

/// The glass solids that contain a point: a multiset of mesh indices, one entry per enclosing shell.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Media {
    inside: [u16; DEPTH],
    count: u8,
}

impl Media {
    /// Enters a shell of a mesh.
    #[inline]
    pub fn enter(&mut self, mesh: u16) {
        if (self.count as usize) < DEPTH {
            self.inside[self.count as usize] = mesh;
            self.count += 1;
        }
    }

    /// Leaves a shell of a mesh; false if it was in none.
    #[inline]
    pub fn leave(&mut self, mesh: u16) -> bool {
        let inside = &mut self.inside[..self.count as usize];
        let Some(at) = inside.iter().rposition(|m| *m == mesh) else { return false };
        inside[at..].rotate_left(1);
        self.count -= 1;
        // Keeps the unused tail equal, so that equal bags compare equal.
        self.inside[self.count as usize] = 0;
        true
    }

    /// The mesh whose material fills the space: the highest priority, among equals the later in the list; none: air.
    #[inline]
    pub fn filling(&self, meshes: &[Mesh]) -> Option<u16> {
        match self.inside[..self.count as usize] {
            [] => None,
            [only] => Some(only),
            ref several => {
                several.iter().copied().max_by_key(|mesh| (meshes[*mesh as usize].priority, *mesh))
            }
        }
    }

    /// The glass that fills the space; none: air.
    #[inline]
    pub fn glass<'a>(&self, meshes: &'a [Mesh]) -> Option<&'a Glass> {
        match &meshes[self.filling(meshes)? as usize].material {
            Material::Glass(glass) => Some(glass),
            Material::Diffuse(_) | Material::Mirror(_) => None,
        }
    }

    /// Whether it is air.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }
}
