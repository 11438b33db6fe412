//! The worker that looks at the scene from anywhere.

use std::sync::{Arc, Mutex, PoisonError};

use egui::ColorImage;
use lightloom_core::Result;
use lightloom_core::pipeline::Exposure;
use lightloom_core::render::{TextureLayout, ViewSettings};
use lightloom_core::scene::CameraDesc;

use super::painter::{Moment, shown};
use super::subject::{Studio, Subject};
use super::worker::{Turn, Worker};

/// Texels of the light along the receiver's longer side.
const TEXELS: usize = 512;

/// From where the scene shall be seen.
#[derive(Clone)]
pub(super) struct Stand {
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
pub(super) struct Seen {
    /// Counts the pictures, so that each is uploaded once.
    pub(super) number: u64,
    pub(super) picture: Option<Arc<ColorImage>>,
}

/// Looks from the newest place.
pub(super) struct Looker {
    worker: Worker<Stand>,
    seen: Arc<Mutex<Seen>>,
}

impl Looker {
    /// `wake` is called when a picture is done.
    pub(super) fn new(wake: impl Fn() + Clone + Send + 'static) -> Self {
        let seen: Arc<Mutex<Seen>> = Arc::default();
        let theirs = seen.clone();
        let tell = wake.clone();
        let worker = Worker::new("free look", wake, move || {
            let (seen, tell) = (theirs.clone(), tell.clone());
            let (mut studio, mut exposure) = (Studio::default(), Exposure::default());
            move |stand: Stand, turn: &Turn| {
                // What is wrong with the scene is told by the animation, which loads it too.
                let Ok(picture) = turn.shielded(|_| look(&mut studio, &mut exposure, &stand, turn)) else { return };
                let mut seen = seen.lock().unwrap_or_else(PoisonError::into_inner);
                *seen = Seen { number: seen.number + 1, picture: Some(Arc::new(picture)) };
                drop(seen);
                tell();
            }
        });
        Self { worker, seen }
    }

    pub(super) fn ask(&self, stand: Stand) {
        self.worker.ask(stand);
    }

    pub(super) fn seen(&self) -> Seen {
        self.seen.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// What a panic of the worker said, once.
    pub(super) fn panicked(&self) -> Option<String> {
        self.worker.panicked()
    }
}

fn look(studio: &mut Studio, exposure: &mut Exposure, stand: &Stand, turn: &Turn) -> Result<ColorImage> {
    let Stand { subject, camera, size, moment, view } = stand;
    let light = moment.as_ref().map(|Moment { sketch, frame, shown }| {
        exposure.expose(sketch, *frame, TextureLayout::new(sketch.extent(), TEXELS, 0.0), shown)
    });
    let image = studio.sketcher(subject)?.look(&subject.project, camera, *size, light, &turn.progress)?;
    Ok(shown(&image, &view.view()))
}
