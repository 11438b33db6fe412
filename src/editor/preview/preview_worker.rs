//! The worker that previews the animation: coarse at once, then better.

use std::sync::{Arc, Mutex, PoisonError};

use lightloom_core::engine::{Client, Engine, Preview, Quality};
use lightloom_core::progress::Snapshot;
use lightloom_core::{Error, Progress, Result};

use super::subject::Subject;
use super::worker::{Share, Turn, Worker};
use crate::editor::engine::SharedEngine;

/// What the worker found out about one version of a project.
#[derive(Clone, Default)]
pub(super) struct Found {
    /// Counts the versions; those of older ones are forgotten.
    pub(super) version: u64,
    /// By detail.
    pub(super) previews: [Option<Arc<Preview>>; 3],
    /// What is wrong with the project or its files.
    pub(super) problem: Option<String>,
}

impl Found {
    /// The best light there is at a frame.
    pub(super) fn best(&self, frame: i32) -> Option<&Arc<Preview>> {
        let ready = |preview: &&Arc<Preview>| preview.frames().contains(&frame) && preview.is_ready(frame);
        self.previews.iter().rev().flatten().find(ready)
    }
}

/// Previews of the newest version of a project.
pub(super) struct PreviewWorker {
    worker: Worker<Request>,
    found: Arc<Mutex<Found>>,
    version: u64,
}

struct Request {
    version: u64,
    subject: Subject,
    first: i32,
}

impl PreviewWorker {
    /// A worker that asks the shared engine on behalf of `client`. `wake` is called whenever there is something new to see.
    pub(super) fn new(
        engine: SharedEngine,
        client: Client,
        share: Share,
        wake: impl Fn() + Clone + Send + 'static,
    ) -> Self {
        let found: Arc<Mutex<Found>> = Arc::default();
        let theirs = found.clone();
        let seen = wake.clone();
        let worker = Worker::new("animation", share, wake, move || {
            let (engine, found, seen) = (engine.clone(), theirs.clone(), seen.clone());
            move |request: Request, turn: &Turn| {
                let engine = request.subject.engine(&engine).map(|engine| engine.on_behalf_of(client));
                answer(engine, &request, turn, &found, &seen);
            }
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

/// Makes the previews of all qualities, the coarsest first, and publishes them as they grow.
fn answer(engine: Result<Engine>, request: &Request, turn: &Turn, found: &Mutex<Found>, seen: &impl Fn()) {
    let tell = |change: &dyn Fn(&mut Found)| {
        let mut found = found.lock().unwrap_or_else(PoisonError::into_inner);
        if found.version != request.version {
            *found = Found { version: request.version, ..Found::default() };
        }
        change(&mut found);
        drop(found);
        seen();
    };
    let engine = match engine {
        Ok(engine) => engine,
        Err(error) => return tell(&|found| found.problem = Some(error.to_string())),
    };
    for (level, quality) in Quality::LIVE.into_iter().enumerate() {
        let mut ready = |preview: &Arc<Preview>| {
            // The old light stays on the screen until there is new one to see.
            if preview.is_ready(request.first) {
                tell(&|found| found.previews[level] = Some(preview.clone()));
            }
        };
        let (project, first) = (&request.subject.project, request.first);
        let mut preview = |progress: &Progress| engine.preview(project, quality, first, progress, &mut ready);
        let preview = match quality {
            Quality::Draft => turn.shielded(preview),
            _ => preview(&turn.progress),
        };
        match preview {
            Ok(preview) => tell(&|found| found.previews[level] = Some(preview.clone())),
            Err(Error::Cancelled) => return,
            Err(error) => return tell(&|found| found.problem = Some(error.to_string())),
        }
    }
}
