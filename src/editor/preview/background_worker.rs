//! The worker that looks through the shot's camera: coarse at once, then better. It works only when the scene changes.

use std::sync::{Arc, Mutex, PoisonError};

use lightloom_core::engine::Shot;
use lightloom_core::progress::Snapshot;
use lightloom_core::{Error, Result};

use super::subject::Subject;
use super::worker::{Share, Turn, Worker};
use crate::editor::engine::SharedEngine;

/// Paths per pixel of the picture without caustics, one after the other: a first look, and what suffices to draw on.
const SAMPLES: [u32; 3] = [1, 4, 24];

/// Looks through the camera of the newest scene.
pub(super) struct BackgroundWorker {
    worker: Worker<Request>,
    found: Arc<Mutex<Found>>,
    /// Number of requests so far.
    asked: u64,
}

struct Request {
    number: u64,
    subject: Subject,
    size: [u32; 2],
}

/// What was seen.
#[derive(Clone, Default)]
struct Found {
    shot: Option<Arc<Shot>>,
    problem: Option<String>,
    /// The request that was answered last.
    answered: u64,
}

impl BackgroundWorker {
    /// `wake` is called whenever there is a better picture.
    pub(super) fn new(engine: SharedEngine, wake: impl Fn() + Clone + Send + 'static) -> Self {
        let found: Arc<Mutex<Found>> = Arc::default();
        let theirs = found.clone();
        let seen = wake.clone();
        let worker = Worker::new("background", Share::Half, wake, move || {
            let (engine, found, seen) = (engine.clone(), theirs.clone(), seen.clone());
            move |request: Request, turn: &Turn| {
                let tell = |shot: Result<Shot>| {
                    let mut found = found.lock().unwrap_or_else(PoisonError::into_inner);
                    match shot {
                        Ok(shot) => (found.shot, found.problem) = (Some(Arc::new(shot)), None),
                        Err(Error::Cancelled) => return false,
                        Err(error) => found.problem = Some(error.to_string()),
                    }
                    found.answered = request.number;
                    drop(found);
                    seen();
                    true
                };
                for samples in SAMPLES {
                    let (project, size) = (&request.subject.project, request.size);
                    let engine = request.subject.engine(&engine);
                    let shot = engine.and_then(|e| e.shot(project, size, samples, &turn.progress));
                    if !tell(shot) {
                        return;
                    }
                }
            }
        });
        Self { worker, found, asked: 0 }
    }

    pub(super) fn ask(&mut self, subject: Subject, size: [u32; 2]) {
        self.asked += 1;
        self.worker.ask(Request { number: self.asked, subject, size });
    }

    /// Whether the newest request is answered, be it coarsely.
    pub(super) fn is_newest(&self) -> bool {
        self.found.lock().unwrap_or_else(PoisonError::into_inner).answered == self.asked
    }

    /// The newest look.
    pub(super) fn shot(&self) -> Option<Arc<Shot>> {
        self.found.lock().unwrap_or_else(PoisonError::into_inner).shot.clone()
    }

    /// The progress of the work under way; none while it waits.
    pub(super) fn progress(&self) -> Option<Snapshot> {
        self.worker.progress()
    }

    /// What a panic of the worker said, once.
    pub(super) fn panicked(&self) -> Option<String> {
        self.worker.panicked()
    }
}
