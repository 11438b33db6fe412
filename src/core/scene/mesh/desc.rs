//! A mesh file and its placement, as saved.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::scene::material::Material;
use crate::setting::schema::Describe;
use crate::setting::{Setting, settings};
use crate::{Error, Result};

/// One mesh file placed in the scene, as saved.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(transform = Describe(Self::SETTINGS), transform = Describe(Material::KIND))]
pub struct MeshDesc {
    /// Its name.
    pub name: String,
    /// An OBJ or glTF file, relative to the project's folder.
    pub file: String,
    /// The object of a glTF file that is taken ([`Self::NODE`]).
    #[serde(default)]
    pub node: Option<String>,
    /// Whether it stands in the scene ([`Self::ENABLED`]).
    #[serde(default = "enabled")]
    pub enabled: bool,
    /// Material of the whole mesh; none: one object for each material of the file.
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
    /// An OBJ or glTF file (`.obj`, `.glb`, `.gltf`), relative to the project.
    FILE = Setting::part("scene.meshes[].file");
    /// The object of a glTF file that is taken, by the name of its node; none for all.
    NODE = Setting::part("scene.meshes[].node");
    /// Off leaves the mesh in the list, but not in the scene; its file is not read.
    ENABLED = Setting::switch("scene.meshes[].enabled", true);
    /// Smooth shading by the file's normals, or else over edges of less than 50 degrees; off for facets, as of a gem.
    SMOOTH = Setting::switch("scene.meshes[].smooth", true);
    /// Where solids of glass overlap, as wine and its glass do, the higher priority fills the place; among equals the
    /// later in the list.
    PRIORITY = Setting::whole("scene.meshes[].priority", [-1000.0, 1000.0], &[0.0]);
} }

fn enabled() -> bool {
    MeshDesc::ENABLED.is_on()
}

fn smooth() -> bool {
    MeshDesc::SMOOTH.is_on()
}

/// Placement: scaled, then turned, then moved.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(transform = Describe(Self::SETTINGS))]
pub struct Transform {
    /// Where the file's origin comes to lie (m).
    pub translate: [f64; 3],
    /// Turn about the X, then Y, then Z axis, degrees.
    pub rotate: [f32; 3],
    /// Factor on the file's units.
    pub scale: f32,
}

settings! { Transform {
    /// Where the file's origin comes to lie, x y z; y is up.
    TRANSLATE = Setting::vector("scene.meshes[].transform.translate", [-1e8, 1e8], &[0.0; 3]).unit("m");
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
}

impl MeshDesc {
    /// A mesh with the materials of its file, placed as in the file.
    pub fn new(name: impl Into<String>, file: impl Into<String>) -> Self {
        let (name, file) = (name.into(), file.into());
        let (node, material, transform) = (None, None, Transform::default());
        let (enabled, smooth, priority) = (enabled(), smooth(), Self::PRIORITY.value());
        Self { name, file, node, enabled, material, transform, smooth, priority }
    }

    /// Refuses values out of range, naming `place.field`.
    pub fn check(&self, place: &str) -> Result<()> {
        if self.file.is_empty() {
            return Err(Error::value(format!("{place}.file"), "is empty: name an OBJ or glTF file"));
        }
        Self::PRIORITY.check(self.priority, place)?;
        if let Some(material) = &self.material {
            material.check(&format!("{place}.material"))?;
        }
        self.transform.check(&format!("{place}.transform"))
    }
}
