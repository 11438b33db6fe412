//! What a file gives of a scene, before the rest is made.

use glam::Vec3;

use super::flat::Rectangle;
use crate::scene::{CameraDesc, LightDesc, Material, MeshDesc, SceneDesc};

/// What a file gives.
#[derive(Debug, Default)]
pub(super) struct Draft {
    pub objects: Vec<Object>,
    pub lights: Vec<LightDesc>,
    /// The first camera with the aspect of its picture.
    pub camera: Option<(CameraDesc, Option<f32>)>,
    /// Number of cameras.
    pub cameras: usize,
    /// Places of lamps that the format has lost.
    pub lost_lamps: Vec<Vec3>,
    /// Number of materials that are used.
    pub materials: usize,
    /// Whether its lengths are in metres.
    pub in_metres: bool,
    pub notes: Vec<String>,
    /// Files that belong to it, by their names.
    pub files: Vec<String>,
}

/// A mesh of a file.
#[derive(Debug)]
pub(super) struct Object {
    pub desc: MeshDesc,
    pub bounds: Bounds,
    /// Its rectangle, where it is flat.
    pub flat: Option<Rectangle>,
    /// Whether any of its materials casts caustics.
    pub is_caster: bool,
}

/// A box around something.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    pub lower: Vec3,
    pub upper: Vec3,
}

impl Bounds {
    pub(super) fn around(all: impl Iterator<Item = Self>) -> Option<Self> {
        all.reduce(|a, b| Self { lower: a.lower.min(b.lower), upper: a.upper.max(b.upper) })
    }

    pub(super) fn of_points(points: impl Iterator<Item = Vec3>) -> Option<Self> {
        Self::around(points.map(|point| Self { lower: point, upper: point }))
    }

    pub(super) fn centre(&self) -> Vec3 {
        (self.lower + self.upper) / 2.0
    }

    /// Radius of the sphere around it (m), above 0.
    pub(super) fn radius(&self) -> f32 {
        (self.lower.distance(self.upper) / 2.0).max(1e-6)
    }

    pub(super) fn moved(&self, scale: f32, by: Vec3) -> Self {
        Self { lower: self.lower * scale + by, upper: self.upper * scale + by }
    }
}

impl Draft {
    /// The box around all that casts caustics; where nothing does, around everything.
    pub(super) fn glass(&self) -> Option<Bounds> {
        let casters = self.objects.iter().filter(|object| object.is_caster);
        Bounds::around(casters.map(|object| object.bounds)).or_else(|| self.all())
    }

    /// The box around all meshes.
    pub(super) fn all(&self) -> Option<Bounds> {
        Bounds::around(self.objects.iter().map(|object| object.bounds))
    }

    /// Takes everything that is not flat as glass where nothing casts a caustic.
    pub(super) fn ensure_casters(&mut self) {
        if self.objects.iter().any(|object| object.is_caster) {
            return;
        }
        let mut taken = Vec::new();
        for object in self.objects.iter_mut().filter(|object| object.flat.is_none()) {
            object.desc.material = Some(Material::Glass(Default::default()));
            object.is_caster = true;
            taken.push(object.desc.name.clone());
        }
        self.notes.push(match taken.is_empty() {
            true => "nothing casts a caustic: give a mesh glass or a mirror".into(),
            false => format!(
                "no material is glass or a mirror: taken as glass: {}; change the material where that is wrong",
                shortened(&taken)
            ),
        });
    }
}

/// A list of names, the first few in full.
pub(super) fn shortened(names: &[String]) -> String {
    let shown = names.iter().take(6).cloned().collect::<Vec<_>>().join(", ");
    if names.len() > 6 { format!("{shown} and {} more", names.len() - 6) } else { shown }
}

/// Renames meshes and lamps of `new` that have the name of one in `old`.
pub(super) fn give_new_names(old: &SceneDesc, new: &mut SceneDesc) {
    let unique = |name: &str, taken: &dyn Fn(&str) -> bool| {
        let numbered = (2..).map(|number| format!("{name} {number}"));
        std::iter::once(name.to_owned()).chain(numbered).find(|name| !taken(name)).unwrap_or_default()
    };
    for mesh in &mut new.meshes {
        mesh.name = unique(&mesh.name, &|name| old.meshes.iter().any(|other| other.name == name));
    }
    for light in &mut new.lights {
        let name = unique(light.name(), &|name| old.lights.iter().any(|other| other.name() == name));
        light.rename(name);
    }
}
