//! Triangle meshes from OBJ and glTF files: reading, placement, clean-up, smooth normals.

mod clean;
mod companions;
mod desc;
mod foreign;
mod gltf;
mod library;
mod mtl;
mod normals;
mod obj;
mod place;
mod shells;
mod text;

use std::path::PathBuf;

pub use self::companions::{MaterialFile, material_files};
pub use self::desc::{MeshDesc, Transform};
pub use self::foreign::advice;
pub(super) use self::gltf::GltfFiles;
pub use self::library::Assets;

use self::library::Owner;
use self::obj::{Group, ObjFile};
use self::place::Placed;
use super::accel::Triangle;
use super::gltf::GltfFile;
use super::material::Material;
use crate::{Error, Progress, Result};

/// All triangles of one material of one file, in world space. [`Triangle::mesh`] is still 0.
pub(super) struct Part {
    pub name: String,
    pub material: Material,
    pub triangles: Vec<Triangle>,
    /// The connected surface of each triangle, numbered from 0.
    pub shells: Vec<u32>,
}

/// Reads a mesh file and splits it by material; `notes` tell what was changed. `files` are those that were read already.
pub(super) fn load(
    desc: &MeshDesc,
    place: &str,
    assets: &dyn Fn(&str, &str) -> Result<PathBuf>,
    files: &mut GltfFiles,
    notes: &mut Vec<String>,
    progress: &Progress,
) -> Result<Vec<Part>> {
    progress.check()?;
    let path = assets(&desc.file, &format!("{place}.file"))?;
    if let Some(advice) = advice(&path) {
        return Err(Error::format(path, "", advice));
    }
    let placed = Placed::new(&desc.transform);
    let (objects, far) = if GltfFile::is_named(&path) {
        let groups = files.groups(desc, &path, &placed, notes, progress)?;
        let far = place::check(groups.iter().map(|(_, group)| group), desc, &path)?;
        (files.objects(desc, &path, groups, notes)?, far)
    } else {
        let file = obj::read(&path, &placed, progress)?;
        let far = place::check(file.groups.iter().map(|(_, group)| group), desc, &path)?;
        (
            of_obj(
                file,
                &Owner { name: &desc.name, written: &desc.file, path: &path, place, assets },
                desc,
                notes,
            ),
            far,
        )
    };
    notes.extend(far.iter().map(|far| format!("{}: {far}", desc.name)));
    let mut parts = Vec::new();
    for (name, material, group) in objects {
        progress.check()?;
        let (triangles, shells) = clean::triangles(&group, desc.smooth, (&material, &name), notes, progress)?;
        if !triangles.is_empty() {
            parts.push(Part { name, material, triangles, shells });
        }
    }
    if parts.is_empty() {
        let far = far.map(|far| format!("; it {far}")).unwrap_or_default();
        return Err(Error::format(path, "", format!("has no triangle of any size: nothing to show{far}")));
    }
    Ok(parts)
}

/// Name, material and faces of the objects of an OBJ file.
fn of_obj(
    file: ObjFile,
    owner: &Owner<'_>,
    desc: &MeshDesc,
    notes: &mut Vec<String>,
) -> Vec<(String, Material, Group)> {
    let (bad, first) = file.bad_normals;
    if bad > 0 {
        let what =
            format!("{bad} normals are no finite numbers (first on line {first}); theirs are computed");
        notes.push(format!("{}: {what}", desc.name));
    }
    match &desc.material {
        Some(material) => {
            let groups = file.groups.into_iter().map(|(_, group)| group);
            vec![(desc.name.clone(), material.clone(), Group::joined(groups))]
        }
        None => library::objects(file, owner, notes),
    }
}
