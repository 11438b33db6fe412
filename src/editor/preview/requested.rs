//! What the views need, and what was requested last, to send each request once.

use std::path::PathBuf;
use std::sync::Arc;

use lightloom_core::engine::{Preview, Shot};
use lightloom_core::project::{CausticDesc, Project};
use lightloom_core::render::{PlaneMaterial, PlateSettings, ViewSettings};
use lightloom_core::scene::{CameraDesc, SceneDesc};

use super::picture_worker::Plane;
use crate::editor::access::Access;

/// The pictures that the views need.
#[derive(Clone, Debug, PartialEq)]
pub struct Wanted {
    /// How the plane is drawn.
    pub plane: Plane,
    /// Size of the shot in pixels; none where it is not visible.
    pub shot: Option<[u32; 2]>,
    /// Camera and size in pixels of the orbit view; none where it is not visible.
    pub look: Option<(CameraDesc, [u32; 2])>,
}

impl Default for Wanted {
    fn default() -> Self {
        Self { plane: Plane::Hidden, shot: None, look: None }
    }
}

/// The last request to each worker.
#[derive(Default)]
pub(super) struct Requests {
    pub(super) painted: Option<PictureKey>,
    pub(super) staged: Option<BackgroundKey>,
    pub(super) looked: Option<(PictureKey, Same<Project>, CameraDesc, [u32; 2])>,
}

/// An object compared by identity. It is kept alive, so that its address is not reused.
pub(super) struct Same<T>(pub(super) Option<Arc<T>>);

impl<T> PartialEq for Same<T> {
    fn eq(&self, other: &Self) -> bool {
        match (&self.0, &other.0) {
            (Some(a), Some(b)) => Arc::ptr_eq(a, b),
            (None, None) => true,
            _ => false,
        }
    }
}

/// The light of a preview at one frame: the same in all that are handed out while the preview grows.
pub(super) struct FrameLight {
    pub(super) preview: Option<Arc<Preview>>,
    pub(super) frame: i32,
}

impl PartialEq for FrameLight {
    fn eq(&self, other: &Self) -> bool {
        self.frame == other.frame
            && match (&self.preview, &other.preview) {
                (Some(a), Some(b)) => a.has_light_of(b, self.frame),
                (a, b) => a.is_none() && b.is_none(),
            }
    }
}

/// The inputs of the pictures at one frame.
#[derive(PartialEq)]
pub(super) struct PictureKey {
    pub(super) lights: [FrameLight; 2],
    pub(super) shot: Same<Shot>,
    pub(super) shown: Vec<bool>,
    pub(super) view: ViewSettings,
    pub(super) paper: PlaneMaterial,
    pub(super) plane: Plane,
    pub(super) false_colour: bool,
}

/// The inputs of the background.
#[derive(Clone, PartialEq)]
pub(super) struct BackgroundKey {
    pub(super) scene: Option<SceneDesc>,
    pub(super) aspect: f32,
    pub(super) size: [u32; 2],
    pub(super) seed: u64,
    pub(super) caustics: Vec<CausticDesc>,
    /// By key frame: what each caustic, and the rest, has of its physical light; none where it shows something else.
    pub(super) physical: Vec<Vec<Option<[f32; 3]>>>,
    pub(super) kept_in_glass: f32,
    pub(super) plate: Option<PlateSettings>,
    /// The project file, and the files that may be read outside of its folder.
    pub(super) files: (PathBuf, Access),
}
