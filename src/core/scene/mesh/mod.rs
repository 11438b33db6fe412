//! Triangle meshes from OBJ files: reading, placement, clean-up, smooth normals.

mod clean;
mod mtl;
mod normals;
mod obj;

use std::path::PathBuf;

use glam::{DMat3, DVec3, EulerRot, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub(super) use super::accel::Triangle;
use super::check;
use super::material::{Diffuse, Material};
use crate::{Error, Progress, Result};

/// One mesh file placed in the scene, as saved.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MeshDesc {
    /// Shown in the list of caustics.
    pub name: String,
    /// An OBJ file, relative to the project's folder.
    pub file: String,
    /// Material of the whole file. Default none: as the file's MTL says, one object per material.
    #[serde(default)]
    pub material: Option<Material>,
    /// Where it stands. Default: as in the file, in metres.
    #[serde(default)]
    pub transform: Transform,
    /// Smooth shading by the file's normals, or else by averages over edges of less than 50 degrees; false: every
    /// triangle flat. Default true.
    #[serde(default = "yes")]
    pub smooth: bool,
    /// Where solids of glass overlap, the mesh of higher priority fills the place; equal: the later in the list.
    /// -1000 to 1000. Default 0.
    #[serde(default)]
    pub priority: i32,
}

fn yes() -> bool {
    true
}

/// Placement: scaled, then turned, then moved.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Transform {
    /// Moves the file's origin here [m]. Default 0.
    pub translate: [f32; 3],
    /// Turn about the X, then Y, then Z axis in degrees. Default 0.
    pub rotate: [f32; 3],
    /// Factor on the file's units, 1e-12 to 1e12: 0.001 for a file in millimetres. Default 1.
    pub scale: f32,
}

impl Default for Transform {
    fn default() -> Self {
        Self { translate: [0.0; 3], rotate: [0.0; 3], scale: 1.0 }
    }
}

impl Transform {
    fn check(&self, place: &str) -> Result<()> {
        check::within(place, "translate", &self.translate, -1e6, 1e6)?;
        check::within(place, "rotate", &self.rotate, -36_000.0, 36_000.0)?;
        check::within(place, "scale", &[self.scale], 1e-12, 1e12)
    }

    fn turn(&self) -> DMat3 {
        let [x, y, z] = self.rotate.map(|degrees| f64::from(degrees).to_radians());
        DMat3::from_euler(EulerRot::ZYX, z, y, x)
    }
}

impl MeshDesc {
    /// Refuses values out of range, naming `place.field`.
    pub fn check(&self, place: &str) -> Result<()> {
        if self.file.is_empty() {
            return Err(Error::value(format!("{place}.file"), "is empty: name an OBJ file"));
        }
        if !(-1000..=1000).contains(&self.priority) {
            return Err(Error::value(format!("{place}.priority"), "must be between -1000 and 1000"));
        }
        if let Some(material) = &self.material {
            material.check(&format!("{place}.material"))?;
        }
        self.transform.check(&format!("{place}.transform"))
    }
}

/// All triangles of one material of one file, in world space. [`Triangle::mesh`] is still 0.
pub(super) struct Part {
    pub name: String,
    pub material: Material,
    pub triangles: Vec<Triangle>,
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
    let mut file = obj::read(&path, progress)?;
    progress.check()?;
    transform(&mut file, &desc.transform, &path)?;
    let materials = match &desc.material {
        Some(material) => {
            file.faces.iter_mut().for_each(|face| face.material = 0);
            vec![(desc.name.clone(), material.clone())]
        }
        None => materials(&file, desc, place, assets, notes),
    };
    let mut parts = Vec::new();
    for (index, (name, material)) in materials.into_iter().enumerate() {
        let faces: Vec<_> = file.faces.iter().filter(|face| face.material as usize == index).collect();
        if faces.is_empty() {
            continue;
        }
        progress.check()?;
        let triangles = clean::triangles(&file, &faces, desc.smooth, &material, &name, notes);
        if !triangles.is_empty() {
            parts.push(Part { name, material, triangles });
        }
    }
    if parts.is_empty() {
        return Err(Error::format(path, "", "has no triangle of any size: nothing to show"));
    }
    Ok(parts)
}

fn transform(file: &mut obj::ObjFile, transform: &Transform, path: &std::path::Path) -> Result<()> {
    let turn = transform.turn();
    let scaled = turn * f64::from(transform.scale);
    let offset = DVec3::from(transform.translate.map(f64::from));
    for position in &mut file.positions {
        *position = (scaled * position.as_dvec3() + offset).as_vec3();
    }
    for normal in &mut file.normals {
        *normal = (turn * normal.as_dvec3()).as_vec3();
    }
    // Squares of lengths must stay within f32.
    let far = file.positions.iter().fold(0.0_f32, |far, p| far.max(p.abs().max_element()));
    if far.is_nan() || far > 1e9 {
        let what = format!("reaches {far:e} m from the origin; the limit is 1e9: lower its scale");
        return Err(Error::format(path, "", what));
    }
    Ok(())
}

/// Name and material of each `usemtl`, by index.
fn materials(
    file: &obj::ObjFile,
    desc: &MeshDesc,
    place: &str,
    assets: &dyn Fn(&str, &str) -> Result<PathBuf>,
    notes: &mut Vec<String>,
) -> Vec<(String, Material)> {
    let mut library = Vec::new();
    for name in &file.libraries {
        // As written, beside the OBJ file; whether it may be read is for `assets` to say.
        let folder = desc.file.rfind(['/', '\\']).map_or("", |end| &desc.file[..=end]);
        let read = assets(&format!("{folder}{name}"), &format!("{place}.file, mtllib"))
            .and_then(|path| mtl::read(&path));
        match read {
            Ok(materials) => library.extend(materials),
            Err(error) => notes.push(format!("{}: its material file was not used: {error}", desc.name)),
        }
    }
    let used: Vec<bool> = (0..file.materials.len())
        .map(|index| file.faces.iter().any(|face| face.material as usize == index))
        .collect();
    let single = used.iter().filter(|used| **used).count() == 1;
    file.materials
        .iter()
        .zip(used)
        .map(|(name, used)| {
            let label = if single { desc.name.clone() } else { format!("{}/{name}", desc.name) };
            let found = library.iter().find(|material| material.name == *name);
            let material = match found {
                Some(found) => found.material(&label, used, notes),
                None => {
                    if used {
                        notes.push(format!("{label}: has no material; taken as matt grey"));
                    }
                    Material::Diffuse(Diffuse::default())
                }
            };
            (label, material)
        })
        .collect()
}

/// The normal of a counter-clockwise triangle, not normalized; its length is twice the area.
fn cross([a, b, c]: [Vec3; 3]) -> Vec3 {
    (b - a).cross(c - a)
}
