//! Asset files: their use in the project, and the edit that puts a picked file there.

use lightloom_core::project::{KeyFrame, Project, Shows};
use lightloom_core::render::{PlateSettings, RenderSettings};
use lightloom_core::targets::{ImageTarget, PointsTarget};

use super::document::Edit;

/// The use of a picked file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum AssetUse {
    /// New meshes, with lamps and camera where there are none.
    Mesh,
    /// Replaces the file of the mesh of this index.
    MeshFile(usize),
    /// A target picture of a key frame.
    Picture(TargetSlot),
    /// Target points of a key frame.
    Points(TargetSlot),
    /// The picture behind the caustics.
    Plate,
}

/// A target: of a key frame, or of one caustic in it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TargetSlot {
    /// Index of the key frame.
    pub key: usize,
    /// Name of the caustic; none for the key frame's own target.
    pub caustic: Option<String>,
}

impl TargetSlot {
    /// The target there.
    pub fn shows<'a>(&self, keys: &'a [KeyFrame]) -> Option<&'a Shows> {
        keys.get(self.key).map(|key| key.shown_by(self.caustic.as_deref()))
    }

    /// Replaces the target there.
    pub fn set(&self, keys: &mut [KeyFrame], shows: Shows) {
        let Some(key) = keys.get_mut(self.key) else { return };
        match &self.caustic {
            None => key.shows = shows,
            Some(name) => key.caustics.entry(name.clone()).or_default().shows = Some(shows),
        }
    }
}

impl AssetUse {
    /// Name and extensions of these files.
    pub fn files(&self) -> (&'static str, &'static [&'static str]) {
        match self {
            Self::Mesh | Self::MeshFile(_) => ("Meshes", &["glb", "gltf", "obj"]),
            Self::Picture(_) | Self::Plate => {
                ("Pictures", &["png", "jpg", "jpeg", "webp", "tif", "tiff", "exr", "hdr"])
            }
            Self::Points(_) => ("Points", &["csv", "npy"]),
        }
    }

    /// The edit that uses `file`, a path relative to the project; none where its use no longer exists.
    pub fn edit(&self, project: &Project, file: String) -> Option<Edit> {
        match self {
            // Read first, and then put in with all that it holds.
            Self::Mesh => None,
            Self::MeshFile(index) => {
                let mut scene = project.scene.clone()?;
                let mesh = scene.meshes.get_mut(*index)?;
                // Another file has other objects.
                (mesh.file, mesh.node) = (file, None);
                Some(Edit::Scene(Some(Box::new(scene))))
            }
            Self::Picture(at) => {
                let image = match at.shows(&project.keys)? {
                    Shows::Image(image) => ImageTarget { file, ..image.clone() },
                    _ => ImageTarget::new(file),
                };
                Some(show(project, at, Shows::Image(image)))
            }
            Self::Points(at) => {
                at.shows(&project.keys)?;
                Some(show(project, at, Shows::Points(PointsTarget { file })))
            }
            Self::Plate => {
                let plate = match &project.render.plate {
                    Some(plate) => PlateSettings { file, ..plate.clone() },
                    None => PlateSettings::new(file),
                };
                Some(Edit::Render(RenderSettings { plate: Some(plate), ..project.render.clone() }))
            }
        }
    }
}

/// The edit after which a target shows something else.
pub fn show(project: &Project, at: &TargetSlot, shows: Shows) -> Edit {
    let mut keys = project.keys.clone();
    at.set(&mut keys, shows);
    Edit::Keys(keys)
}
