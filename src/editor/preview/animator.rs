//! The worker that sketches the animation: coarse at once, then better.

use std::sync::{Arc, Mutex, PoisonError};

use lightloom_core::engine::{Detail, Sketch};
use lightloom_core::progress::Snapshot;
use lightloom_core::{Error, Progress, Result};

use super::subject::{Studio, Subject};
use super::worker::{Share, Turn, Worker};

/// What the worker found out about one version of a project.
#[derive(Clone, Default)]
pub(super) struct Found {
    /// Counts the versions; those of older ones are forgotten.
    pub(super) version: u64,
    /// By detail.
    pub(super) sketches: [Option<Arc<Sketch>>; 3],
    /// What is wrong with the project or its files.
    pub(super) problem: Option<String>,
}

impl Found {
    /// The best light there is at a frame.
    pub(super) fn best(&self, frame: i32) -> Option<&Arc<Sketch>> {
        let ready = |sketch: &&Arc<Sketch>| sketch.frames().contains(&frame) && sketch.is_ready(frame);
        self.sketches.iter().rev().flatten().find(ready)
    }
}

/// Sketches the newest version of a project.
pub(super) struct Animator {
    worker: Worker<Request>,
    found: Arc<Mutex<Found>>,
    version: u64,
}

struct Request {
    version: u64,
    subject: Subject,
    first: i32,
}

impl Animator {
    /// `wake` is called whenever there is something new to see.
    pub(super) fn new(share: Share, wake: impl Fn() + Clone + Send + 'static) -> Self {
        let found: Arc<Mutex<Found>> = Arc::default();
        let theirs = found.clone();
        let seen = wake.clone();
        let worker = Worker::new("animation", share, wake, move || {
            let (found, seen) = (theirs.clone(), seen.clone());
            let mut studio = Studio::default();
            move |request: Request, turn: &Turn| answer(&mut studio, &request, turn, &found, &seen)
        });
        Self { worker, found, version: 0 }
    }

    /// Works on this from now on; the frame `first` before the others.
    pub(super) fn ask(&mut self, subject: Subject, first: i32) {
        self.version += 1;
        self.worker.ask(Request { version: self.version, subject, first });
    }

    /// What was found out about the newest version; none where it is still that of an older one.
    pub(super) fn found(&self) -> Option<Found> {
        Some(self.last()).filter(|found| found.version == self.version)
    }

    /// What was found out last, of whichever version.
    pub(super) fn last(&self) -> Found {
        self.found.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// What the worker does now: the stage, and how far it is.
    pub(super) fn progress(&self) -> Option<Snapshot> {
        self.worker.progress()
    }

    /// What a panic of the worker said, once.
    pub(super) fn panicked(&self) -> Option<String> {
        self.worker.panicked()
    }
}

/// Sketches at every detail, coarse first, and tells what there is to see.
fn answer(studio: &mut Studio, request: &Request, turn: &Turn, found: &Mutex<Found>, seen: &impl Fn()) {
    let tell = |change: &dyn Fn(&mut Found)| {
        let mut found = found.lock().unwrap_or_else(PoisonError::into_inner);
        if found.version != request.version {
            *found = Found { version: request.version, ..Found::default() };
        }
        change(&mut found);
        drop(found);
        seen();
    };
    for detail in [Detail::Draft, Detail::Preview, Detail::Fine] {
        let ready = |sketch: &Arc<Sketch>| {
            // The old light stays on the screen until there is new one to see.
            if sketch.is_ready(request.first) {
                tell(&|found| found.sketches[detail as usize] = Some(sketch.clone()));
            }
        };
        match sketch(studio, request, detail, turn, ready) {
            Ok(sketch) => tell(&|found| found.sketches[detail as usize] = Some(sketch.clone())),
            Err(Error::Cancelled) => return,
            Err(error) => return tell(&|found| found.problem = Some(error.to_string())),
        }
    }
}

fn sketch(
    studio: &mut Studio,
    request: &Request,
    detail: Detail,
    turn: &Turn,
    mut ready: impl FnMut(&Arc<Sketch>),
) -> Result<Arc<Sketch>> {
    let Request { subject, first, .. } = request;
    let sketcher = studio.sketcher(subject)?;
    let mut sketch =
        |progress: &Progress| sketcher.sketch(&subject.project, detail, *first, progress, &mut ready);
    match detail {
        Detail::Draft => turn.shielded(sketch),
        Detail::Preview | Detail::Fine => sketch(&turn.progress),
    }
}
