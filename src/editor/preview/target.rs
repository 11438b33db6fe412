//! The worker that reads the picture towards which the light flows, to lay it over the plane.

use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

use egui::{Color32, ColorImage};
use lightloom_core::Result;
use lightloom_core::targets::{Brightness, ImageTarget, Placement};

use super::subject::Subject;
use super::worker::{Share, Turn, Worker};
use crate::editor::access::Access;

/// Cells along the longer side of what is shown.
const SIDE: usize = 512;

/// The picture that was read last.
#[derive(Clone)]
pub struct TargetPicture {
    /// White, as opaque as it attracts photons.
    pub picture: Arc<ColorImage>,
    /// Size of the file in pixels.
    pub size: glam::Vec2,
}

/// Which file, and what of it.
#[derive(Clone, PartialEq)]
struct Request {
    base: PathBuf,
    access: Access,
    /// Wherever it is placed, the picture is the same.
    image: ImageTarget,
}

/// Reads the newest picture.
pub(super) struct Targets {
    worker: Worker<Request>,
    asked: Option<Request>,
    found: Arc<Mutex<Option<TargetPicture>>>,
}

impl Targets {
    /// `wake` is called when a picture is read.
    pub(super) fn new(wake: impl Fn() + Clone + Send + 'static) -> Self {
        let found: Arc<Mutex<Option<TargetPicture>>> = Arc::default();
        let theirs = found.clone();
        let seen = wake.clone();
        let worker = Worker::new("target", Share::One, wake, move || {
            let (found, seen) = (theirs.clone(), seen.clone());
            move |request: Request, _: &Turn| {
                // What is wrong with the file is told by the animation, which reads it too.
                let read = read(&request).ok();
                *found.lock().unwrap_or_else(PoisonError::into_inner) = read;
                seen();
            }
        });
        Self { worker, asked: None, found }
    }

    /// Reads the picture `image` of a subject, unless it is the last one; none where no picture is shown.
    pub(super) fn follow(&mut self, subject: &Subject, image: Option<&ImageTarget>) {
        let request = image.map(|image| Request {
            base: subject.base.clone(),
            access: subject.access.clone(),
            image: ImageTarget { placement: Placement::default(), ..image.clone() },
        });
        if request == self.asked {
            return;
        }
        *self.found.lock().unwrap_or_else(PoisonError::into_inner) = None;
        self.asked = request.clone();
        if let Some(request) = request {
            self.worker.ask(request);
        }
    }

    pub(super) fn found(&self) -> Option<TargetPicture> {
        self.found.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

fn read(Request { base, access, image }: &Request) -> Result<TargetPicture> {
    let path = access.assets(base)?.resolve(&image.file, "target")?;
    let Brightness { size, width, values } = Brightness::load(&path, image, SIDE)?;
    let pixels =
        values.iter().map(|v| Color32::from_white_alpha((v * 255.0).round() as u8)).collect::<Vec<_>>();
    let height = pixels.len() / width.max(1);
    Ok(TargetPicture { picture: Arc::new(ColorImage::new([width, height], pixels)), size })
}
