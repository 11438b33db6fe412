//! Triangle meshes from OBJ files: reading, placement, clean-up, smooth normals.

mod clean;
mod companions;
mod desc;
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
pub use self::library::Assets;

use self::library::Owner;
use self::obj::Group;
use self::place::Placed;
use super::accel::Triangle;
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

/// Reads a mesh file and splits it by material; `notes` tell what was changed.
pub(super) fn load(
    desc: &MeshDesc,
    place: &str,
    assets: &dyn Fn(&str, &str) -> Result<PathBuf>,
    notes: &mut Vec<String>,
    progress: &Progress,
) -> Result<Vec<Part>> {
    progress.check()?;
    let path = assets(&desc.file, &format!("{place}.file"))?;
    let file = obj::read(&path, &Placed::new(&desc.transform), progress)?;
    progress.check()?;
    let (bad, first) = file.bad_normals;
    if bad > 0 {
        let what =
            format!("{bad} normals are no finite numbers (first on line {first}); theirs are computed");
        notes.push(format!("{}: {what}", desc.name));
    }
    let far = place::check(&file, desc, &path)?;
    notes.extend(far.iter().map(|far| format!("{}: {far}", desc.name)));
    let objects = match &desc.material {
        Some(material) => {
            let mut all = Group::default();
            file.groups.into_iter().for_each(|(_, group)| all.append(group));
            vec![(desc.name.clone(), material.clone(), all)]
        }
        None => {
            let owner = Owner { name: &desc.name, written: &desc.file, path: &path, place, assets };
            library::objects(file, &owner, notes)
        }
    };
    let mut parts = Vec::new();
    for (name, material, group) in objects {
        progress.check()?;
        let (triangles, shells) = clean::triangles(&group, desc.smooth, (&material, &name), notes);
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
