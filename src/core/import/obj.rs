//! What an OBJ file gives: its shape, and materials where its MTL files name glass.

use std::path::Path;

use super::draft::{Bounds, Draft, Object};
use super::paths::{assets_of, file_name};
use crate::files::read_regular_file;
use crate::scene::{Geometry, Material, MeshDesc};
use crate::{Progress, Result};

/// Largest part of a file in which its material files are looked for [bytes].
const HEAD: usize = 1 << 20;

pub(super) fn read(path: &Path, progress: &Progress) -> Result<Draft> {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy().replace('_', " ");
    let mut desc = MeshDesc::new(stem, file_name(path)?);
    let (geometry, _) = Geometry::load(std::slice::from_ref(&desc), &assets_of(path)?, progress)?;
    let meshes = geometry.meshes();
    let bounds = meshes.iter().map(|mesh| Bounds { lower: mesh.lower, upper: mesh.upper });
    let mut notes = Vec::new();
    let is_caster = meshes.iter().any(|mesh| mesh.material.is_specular());
    if !is_caster {
        notes.push(format!("{}: no material of it is glass; taken as glass as a whole", desc.name));
        desc.material = Some(Material::Glass(Default::default()));
    }
    let objects = Bounds::around(bounds).map(|bounds| Object { desc, bounds, flat: None, is_caster: true });
    Ok(Draft {
        objects: objects.into_iter().collect(),
        materials: meshes.len(),
        files: material_files(path)?,
        notes,
        ..Draft::default()
    })
}

/// The material files beside it that its head names.
fn material_files(path: &Path) -> Result<Vec<String>> {
    let bytes = read_regular_file(path, u64::MAX)?;
    let head = String::from_utf8_lossy(&bytes[..bytes.len().min(HEAD)]).into_owned();
    let folder = path.parent().unwrap_or(Path::new(""));
    let named = head.lines().filter_map(|line| line.trim().strip_prefix("mtllib "));
    let beside = named
        .map(|name| name.trim().to_owned())
        .filter(|name| !name.contains(['/', '\\', ':']) && name != ".." && folder.join(name).is_file());
    Ok(beside.collect())
}
