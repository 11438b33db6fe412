//! Triangle meshes from OBJ files: reading, placement, clean-up, smooth normals.

mod clean;
mod mtl;
mod normals;
mod obj;
mod shells;

use std::path::PathBuf;

use glam::{DMat3, DVec3, EulerRot};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::accel::Triangle;
use super::material::{Diffuse, Material};
use crate::setting::schema::Describe;
use crate::setting::{Setting, settings};
use crate::{Error, Progress, Result};

/// One mesh file placed in the scene, as saved.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(transform = Describe(Self::SETTINGS), transform = Describe(Material::KIND))]
pub struct MeshDesc {
    /// Its name.
    pub name: String,
    /// An OBJ file, relative to the project's folder.
    pub file: String,
    /// Material of the whole file; none: one object for each material of the file's MTL.
    #[serde(default)]
    pub material: Option<Material>,
    /// Placement in the scene. Default: as in the file, in metres.
    #[serde(default)]
    pub transform: Transform,
    /// Smooth shading ([`Self::SMOOTH`]).
    #[serde(default = "smooth")]
    pub smooth: bool,
    /// Precedence where solids overlap ([`Self::PRIORITY`]).
    #[serde(default)]
    pub priority: i32,
}

settings! { MeshDesc {
    /// Name of the mesh in the list of caustics; each name once.
    NAME = Setting::text("scene.meshes[].name");
    /// An OBJ file, relative to the project.
    FILE = Setting::part("scene.meshes[].file");
    /// Smooth shading by the file's normals, or else over edges of less than 50 degrees; off for facets, as of a gem.
    SMOOTH = Setting::switch("scene.meshes[].smooth", true);
    /// Where solids of glass overlap, as wine and its glass do, the higher priority fills the place; among equals the
    /// later in the list.
    PRIORITY = Setting::whole("scene.meshes[].priority", [-1000.0, 1000.0], &[0.0]);
} }

fn smooth() -> bool {
    MeshDesc::SMOOTH.is_on()
}

/// Placement: scaled, then turned, then moved.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(transform = Describe(Self::SETTINGS))]
pub struct Transform {
    /// Where the file's origin comes to lie (m).
    pub translate: [f32; 3],
    /// Turn about the X, then Y, then Z axis, degrees.
    pub rotate: [f32; 3],
    /// Factor on the file's units.
    pub scale: f32,
}

settings! { Transform {
    /// Where the file's origin comes to lie, x y z; y is up.
    TRANSLATE = Setting::vector("scene.meshes[].transform.translate", [-1e6, 1e6], &[0.0; 3]).unit("m");
    /// Turn about the x, then y, then z axis.
    ROTATE = Setting::vector("scene.meshes[].transform.rotate", [-36_000.0, 36_000.0], &[0.0; 3]).unit("°");
    /// Factor on the file's units: 0.001 for a file in millimetres.
    SCALE = Setting::real("scene.meshes[].transform.scale", [1e-12, 1e12], &[1.0]);
} }

impl Default for Transform {
    fn default() -> Self {
        Self { translate: Self::TRANSLATE.value(), rotate: Self::ROTATE.value(), scale: Self::SCALE.value() }
    }
}

impl Transform {
    fn check(&self, place: &str) -> Result<()> {
        Self::TRANSLATE.check(self.translate, place)?;
        Self::ROTATE.check(self.rotate, place)?;
        Self::SCALE.check(self.scale, place)
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
        Self::PRIORITY.check(self.priority, place)?;
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
    let welded = clean::weld(&file.positions);
    let mut faces = vec![Vec::new(); materials.len()];
    for face in std::mem::take(&mut file.faces) {
        faces[face.material as usize].push(face);
    }
    let mut parts = Vec::new();
    for ((name, material), faces) in materials.into_iter().zip(faces).filter(|(_, faces)| !faces.is_empty()) {
        progress.check()?;
        let of = (&material, name.as_str());
        let (triangles, shells) = clean::triangles((&file, &welded), faces, desc.smooth, of, notes);
        if !triangles.is_empty() {
            parts.push(Part { name, material, triangles, shells });
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
    let mut used = vec![false; file.materials.len()];
    file.faces.iter().for_each(|face| used[face.material as usize] = true);
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
