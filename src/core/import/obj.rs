//! What an OBJ file gives: its shape, and materials where its MTL files name glass.

use std::path::Path;

use super::draft::{Bounds, Draft, Object};
use super::paths::{assets_of, file_name};
use crate::scene::mesh::{Assets, material_files};
use crate::scene::{Geometry, Material, MeshDesc};
use crate::{Progress, Result};

pub(super) fn read(path: &Path, progress: &Progress) -> Result<Draft> {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy().replace('_', " ");
    let mut desc = MeshDesc::new(stem, file_name(path)?);
    let assets = assets_of(path)?;
    let (geometry, _) = Geometry::load(std::slice::from_ref(&desc), &assets, progress)?;
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
        files: files_of(path, &assets, progress)?,
        notes,
        ..Draft::default()
    })
}

/// The material files in its folder that it names, as the mesh finds them.
fn files_of(path: &Path, assets: Assets<'_>, progress: &Progress) -> Result<Vec<String>> {
    let (files, _) = material_files((&file_name(path)?, path), assets, progress)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    Ok(files.into_iter().map(|file| file.written).filter(|name| folder.join(name).is_file()).collect())
}
