//! The worker that looks at the scene from anywhere.

use std::sync::{Arc, Mutex, PoisonError};

use egui::ColorImage;
use lightloom_core::Result;
use lightloom_core::engine::{OrbitView, Preview, PreviewExposure};
use lightloom_core::project::Project;
use lightloom_core::render::{PlaneView, ViewSettings};
use lightloom_core::scene::{CameraDesc, Scene};

use super::picture_worker::{Moment, shown};
use super::subject::Subject;
use super::worker::{Share, Turn, Worker};
use crate::editor::engine::SharedEngine;
use crate::editor::look::bounds::Loaded;

/// Texels of the light along the receiver's longer side.
const TEXELS: usize = 512;

/// From where the scene shall be seen.
#[derive(Clone)]
pub(super) struct OrbitRequest {
    pub(super) subject: Subject,
    pub(super) camera: CameraDesc,
    /// Pixels.
    pub(super) size: [u32; 2],
    /// The light on the receiver, where it is known already.
    pub(super) moment: Option<Moment>,
    pub(super) view: ViewSettings,
}

/// What was seen last.
#[derive(Clone, Default)]
pub struct Seen {
    /// Counts the pictures, so that each is uploaded once.
    pub number: u64,
    /// As the screen shows it.
    pub picture: Option<Arc<ColorImage>>,
    /// The light on its receiver.
    pub light: Option<Arc<Preview>>,
    /// The camera it was seen through.
    pub camera: Option<CameraDesc>,
    /// The scene in it, and the project it was loaded from.
    pub scene: Option<(Arc<Scene>, Arc<Project>)>,
    /// Where plane points are in it.
    pub plane: Option<PlaneView>,
}

impl Seen {
    /// The last scene that was loaded.
    pub fn loaded(&self) -> Option<Loaded<'_>> {
        self.scene.as_ref().map(|(scene, project)| Loaded { scene, project })
    }

    /// Whether the picture has the meshes of a project, wherever they stood a moment ago.
    pub fn has_meshes_of(&self, project: &Project) -> bool {
        let meshes = |project: &Project| -> Vec<_> {
            let meshes = project.scene.iter().flat_map(|scene| &scene.meshes);
            meshes.map(|mesh| (mesh.file.clone(), mesh.node.clone(), mesh.enabled)).collect()
        };
        self.scene.as_ref().is_some_and(|(_, of)| meshes(of) == meshes(project))
    }
}

/// Looks from the newest place.
pub(super) struct OrbitWorker {
    worker: Worker<OrbitRequest>,
    seen: Arc<Mutex<Seen>>,
}

impl OrbitWorker {
    /// `wake` is called when a picture is done.
    pub(super) fn new(engine: SharedEngine, wake: impl Fn() + Clone + Send + 'static) -> Self {
        let seen: Arc<Mutex<Seen>> = Arc::default();
        let theirs = seen.clone();
        let tell = wake.clone();
        let worker = Worker::new("orbit view", Share::Whole, wake, move || {
            let (engine, seen, tell) = (engine.clone(), theirs.clone(), tell.clone());
            let mut exposure = PreviewExposure::default();
            move |request: OrbitRequest, turn: &Turn| {
                // What is wrong with the scene is told by the animation, which loads it too.
                let look = turn.shielded(|_| look(&engine, &mut exposure, &request, turn));
                let Ok(look) = look else { return };
                let mut seen = seen.lock().unwrap_or_else(PoisonError::into_inner);
                let number = seen.number + 1;
                let picture = Some(Arc::new(shown(&look.image, &request.view.view())));
                let light = request.moment.map(|moment| moment.preview);
                let scene = Some((look.scene, request.subject.project));
                let (camera, plane) = (Some(request.camera), Some(look.plane));
                *seen = Seen { number, picture, light, camera, scene, plane };
                drop(seen);
                tell();
            }
        });
        Self { worker, seen }
    }

    pub(super) fn ask(&self, request: OrbitRequest) {
        self.worker.ask(request);
    }

    pub(super) fn seen(&self) -> Seen {
        self.seen.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// What a panic of the worker said, once.
    pub(super) fn panicked(&self) -> Option<String> {
        self.worker.panicked()
    }
}

fn look(
    engine: &SharedEngine,
    exposure: &mut PreviewExposure,
    request: &OrbitRequest,
    turn: &Turn,
) -> Result<OrbitView> {
    let OrbitRequest { subject, camera, size, moment, .. } = request;
    let light = moment
        .as_ref()
        .and_then(|Moment { preview, frame, shown }| exposure.expose(preview, *frame, TEXELS, shown));
    subject.engine(engine)?.orbit_view(&subject.project, camera, *size, light, &turn.progress)
}
