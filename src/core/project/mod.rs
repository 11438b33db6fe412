//! The project: the artist's settings. Everything else is derived from them and never saved.
//!
//! The smallest project that does something needs no scene at all:
//!
//! ```json
//! { "lightloom": 1,
//!   "keys": [ { "frame": 1,  "shows": { "image": { "file": "letter_c.png" } } },
//!             { "frame": 60, "shows": { "image": { "file": "letter_s.png" } } } ] }
//! ```

mod asset_path;
mod caustic;
mod check;
mod collect;
mod field;
mod file;
pub mod frames;
mod keyframe;
mod load;
mod output;
mod relative_path;
mod schema_docs;
mod settings;
mod shows;

use std::io::Write as _;
use std::path::Path;

use glam::Vec2;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use asset_path::{Admitted, AssetFolder};
pub(crate) use caustic::unknown_name;
pub use caustic::{CausticDesc, CausticKey};
pub use collect::{Collect, Collection, Missing, collect_into};
pub use file::ProjectFile;
pub use keyframe::{Ease, KeyFrame, SegmentTime, segment_time};
pub use output::OutputSettings;
pub use relative_path::{moved, relative};
pub use settings::settings;
pub use shows::Shows;

use crate::constraint::Constraint;
use crate::flow::{FlowSettings, MotionMethod};
use crate::matching::MatchingMethod;
use crate::render::RenderSettings;
use crate::scene::SceneDesc;
use crate::setting::schema::Describe;
use crate::setting::{Setting, settings};
use crate::{Error, Result};

/// The version of the format that this program writes.
pub const VERSION: u32 = 1;

/// A Lightloom project.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(transform = Describe(Self::SETTINGS), transform = Describe(MatchingMethod::MATCHING), transform = Describe(MotionMethod::METHOD))]
pub struct Project {
    /// Where the JSON schema of this format stands, for editors that complete and check while one types.
    #[serde(rename = "$schema", default, skip_serializing_if = "Option::is_none")]
    pub schema: Option<String>,
    /// Version of the format: 1.
    pub lightloom: u32,
    /// The oldest version of the format whose programs read this file right, although they do not know all of it. Default: its
    /// own version.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub minimum_reader: Option<u32>,
    /// The project's name.
    #[serde(default)]
    pub name: String,
    /// Seed of all random numbers.
    #[serde(default = "default_seed")]
    pub seed: u64,
    /// Glass, lights, camera and receiver. Without it the plane is seen straight on.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scene: Option<SceneDesc>,
    /// The plane of a project without scene.
    #[serde(default)]
    pub plane: PlaneSettings,
    /// The caustics that the key frames tell apart, at most 1000. Default none: all light moves as one. Light of no named
    /// caustic forms the rest.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub caustics: Vec<CausticDesc>,
    /// The key frames, in rising order.
    pub keys: Vec<KeyFrame>,
    /// How source and target points are paired.
    #[serde(default)]
    pub matching: MatchingMethod,
    /// How the photons get from key to key.
    #[serde(default)]
    pub method: MotionMethod,
    /// What the artist drew: directed lines and walls. Only the flow heeds them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub constraints: Vec<Constraint>,
    /// The vector field and the way along it.
    #[serde(default)]
    pub flow: FlowSettings,
    /// Photons, passes and picture size.
    #[serde(default)]
    pub render: RenderSettings,
    /// What is written.
    #[serde(default)]
    pub output: OutputSettings,
}

/// The light of a project that shows no physical caustic, and the plane of one without scene: points are given in plane
/// units, the longer side being 1.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(transform = Describe(Self::SETTINGS))]
pub struct PlaneSettings {
    /// Width over height. A scene has its receiver instead.
    pub aspect: f32,
    /// Power of all the light on it (W); a plane unit counts as one metre.
    pub watts: f32,
}

settings! { Project {
    /// Name of the project.
    NAME = Setting::text("name");
    /// Seed of all random numbers: the same seed gives the same bytes, another one other noise.
    SEED = Setting::whole("seed", [0.0, 9_007_199_254_740_991.0], &[1.0]);
} }

settings! { PlaneSettings {
    /// Width of the plane over its height. A scene has its receiver instead.
    ASPECT = Setting::real("plane.aspect", [0.01, 100.0], &[1.0]);
    /// Power of all the light on the plane; a plane unit counts as one metre.
    WATTS = Setting::real("plane.watts", [1e-9, 1e9], &[1.0]).unit("W");
} }

impl Default for PlaneSettings {
    fn default() -> Self {
        Self { aspect: Self::ASPECT.value(), watts: Self::WATTS.value() }
    }
}

impl PlaneSettings {
    /// Extent in plane units: the longer side is 1.
    pub fn extent(&self) -> Vec2 {
        Vec2::new(self.aspect.min(1.0), self.aspect.recip().min(1.0))
    }

    fn check(&self, place: &str) -> Result<()> {
        Self::ASPECT.check(self.aspect, place)?;
        Self::WATTS.check(self.watts, place)
    }
}

fn default_seed() -> u64 {
    Project::SEED.value()
}

impl Project {
    /// Everything shown, by the keys and by single caustics.
    fn shown(&self) -> impl Iterator<Item = &Shows> {
        self.keys.iter().flat_map(|key| {
            std::iter::once(&key.shows).chain(key.caustics.values().filter_map(|c| c.shows.as_ref()))
        })
    }

    /// Extent of the plane in plane units: the longer side is 1.
    pub fn extent(&self) -> Vec2 {
        self.scene.as_ref().map_or_else(|| self.plane.extent(), |scene| scene.receiver.extent())
    }

    /// Whether photons are traced: a key shows the physical caustic, or caustics have names.
    pub fn traces(&self) -> bool {
        !self.caustics.is_empty() || self.shown().any(|shows| *shows == Shows::PhysicalCaustic)
    }

    /// Whether fields are fitted: several keys, and the method is the flow.
    pub fn fits(&self) -> bool {
        self.keys.len() > 1 && self.method.fits()
    }

    /// The methods by which its light can move: that of 2016 finds its own pairs, so not where rows are given.
    pub fn able_methods(&self) -> impl Iterator<Item = MotionMethod> + use<> {
        let given = self.matching == MatchingMethod::Given;
        // Pairs that are given cannot be made at a meeting: such photons are guided, whichever of the two is named.
        let unable = [MotionMethod::Guided, MotionMethod::Stylized];
        MotionMethod::ALL.into_iter().filter(move |method| !given || !unable.contains(method))
    }

    /// The version of a file that a newer program wrote, and this one reads: what it does not know of it is not used.
    pub fn newer(&self) -> Option<u32> {
        Some(self.lightloom).filter(|version| *version > VERSION)
    }

    /// The paths of all files of the project, as written.
    pub fn files(&self) -> Vec<&str> {
        let meshes = self.scene.iter().flat_map(|scene| scene.meshes.iter().map(|mesh| mesh.file.as_str()));
        let shown = self.shown().filter_map(|shows| match shows {
            Shows::PhysicalCaustic => None,
            Shows::Image(image) => Some(image.file.as_str()),
            Shows::Points(points) => Some(points.file.as_str()),
        });
        let plate = self.render.plate.iter().map(|plate| plate.file.as_str());
        meshes.chain(shown).chain(plate).collect()
    }

    /// Replaces the paths of all files by `rename`.
    pub fn rename_files(&mut self, rename: impl Fn(&str) -> String) {
        let meshes = self.scene.iter_mut().flat_map(|scene| &mut scene.meshes).map(|mesh| &mut mesh.file);
        let keys = self.keys.iter_mut().flat_map(|key| {
            let own = key.caustics.values_mut().filter_map(|caustic| caustic.shows.as_mut());
            std::iter::once(&mut key.shows).chain(own)
        });
        let shown = keys.filter_map(|shows| match shows {
            Shows::PhysicalCaustic => None,
            Shows::Image(image) => Some(&mut image.file),
            Shows::Points(points) => Some(&mut points.file),
        });
        let plate = self.render.plate.iter_mut().map(|plate| &mut plate.file);
        meshes.chain(shown).chain(plate).for_each(|file| *file = rename(file));
    }

    /// The frames to render: the list in `output.frames`, or all from the first key to the last.
    ///
    /// # Errors
    /// A malformed list, or more than [`frames::MAX_FRAMES`] frames.
    pub fn frames(&self) -> Result<Vec<i32>> {
        if let Some(list) = &self.output.frames {
            return frames::parse(list, "output.frames");
        }
        match (self.keys.first(), self.keys.last()) {
            (Some(first), Some(last)) => frames::parse(&format!("{}-{}", first.frame, last.frame), "keys"),
            _ => Ok(Vec::new()),
        }
    }

    /// The project as JSON text, fields in fixed order, indented by two spaces.
    ///
    /// # Errors
    /// A project that would not load again, such as one with a value that is not finite.
    pub fn to_json(&self) -> Result<String> {
        self.check()?;
        let text = serde_json::to_string_pretty(self)
            .map_err(|e| Error::value("project", format!("cannot be written as JSON: {e}")))?;
        Ok(text + "\n")
    }

    /// Saves the project atomically.
    ///
    /// # Errors
    /// The file and the system's reason; the old file is then unchanged.
    pub fn save(&self, path: &Path) -> Result<()> {
        let text = self.to_json()?;
        crate::files::write_atomic(path, |file| file.write_all(text.as_bytes()))
    }

    /// The JSON schema of the format (draft 2020-12).
    pub fn json_schema() -> serde_json::Value {
        schemars::schema_for!(Self).into()
    }
}
