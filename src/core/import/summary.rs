//! What an import took, in words.

use crate::scene::{LightDesc, SceneDesc};

/// What was taken of a file, and the notes on it.
#[derive(Clone, Debug, Default)]
pub struct Summary {
    /// Triangles of all meshes.
    pub triangles: u64,
    /// Materials that are used.
    pub materials: usize,
    /// Objects that cast caustics.
    pub casters: usize,
    /// Whether the file has lamps of its own.
    pub has_lamps: bool,
    /// Name and strength of each lamp.
    pub lamps: Vec<String>,
    /// Cameras of the file.
    pub cameras: usize,
    /// The receiver in words.
    pub receiver: String,
    /// What was guessed, changed or left out.
    pub notes: Vec<String>,
}

impl Summary {
    pub(super) fn new(
        scene: &SceneDesc,
        has_lamps: bool,
        receiver: Option<String>,
        notes: Vec<String>,
    ) -> Self {
        let [width, height] = scene.receiver.size;
        let receiver =
            receiver.map_or_else(|| "a table that was made".to_owned(), |name| format!("'{name}'"));
        Self {
            has_lamps,
            lamps: scene.lights.iter().map(strength).collect(),
            receiver: format!("{receiver}, {width:.3} x {height:.3} m"),
            notes,
            ..Self::default()
        }
    }

    pub(super) fn counting(self, triangles: u64, materials: usize, casters: usize, cameras: usize) -> Self {
        Self { triangles, materials, casters, cameras, ..self }
    }

    /// One line.
    pub fn line(&self) -> String {
        let camera = match self.cameras {
            0 => "a camera that was made".to_owned(),
            1 => "1 camera".to_owned(),
            more => format!("{more} cameras"),
        };
        format!(
            "{} triangles, {}, {}; lamps: {}; {camera}; the light falls on {}",
            self.triangles,
            counted(self.materials, "material", "materials"),
            counted(self.casters, "object casts caustics", "objects cast caustics"),
            self.lamps.join(", "),
            self.receiver
        )
    }
}

/// "1 material", "2 materials"
fn counted(count: usize, one: &str, more: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { more })
}

/// "key 2.54 W", "sun 3 W/m²"
fn strength(light: &LightDesc) -> String {
    let watts = match light {
        LightDesc::Point(light) => light.watts,
        LightDesc::Spot(light) => light.watts,
        LightDesc::Rectangle(light) => light.watts,
        LightDesc::Sphere(light) => light.watts,
        LightDesc::Directional(sun) => return format!("{} {:.4} W/m²", sun.name, sun.irradiance),
    };
    format!("{} {watts:.4} W", light.name())
}
