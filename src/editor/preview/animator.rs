//! The worker that sketches the animation: coarse at once, then better.

use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

use lightloom_core::pipeline::{Detail, Sketch, Sketcher};
use lightloom_core::progress::Snapshot;
use lightloom_core::project::{AssetFolder, Project};
use lightloom_core::{Error, Result};

use super::worker::{Turn, Worker};

/// A project, and where its files are.
#[derive(Clone, Debug)]
pub struct Subject {
    /// The project.
    pub project: Arc<Project>,
    /// The project file, or one that could stand there: its files are found from its folder.
    pub base: PathBuf,
    /// Whether it may read files from anywhere.
    pub external: bool,
}

impl Subject {
    /// Whether nothing differs; projects are compared by pointer.
    pub fn is(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.project, &other.project) && self.base == other.base && self.external == other.external
    }
}

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
    pub(super) fn new(wake: impl Fn() + Clone + Send + 'static) -> Self {
        let found: Arc<Mutex<Found>> = Arc::default();
        let theirs = found.clone();
        let seen = wake.clone();
        let worker = Worker::new("animation", wake, move || {
            let (found, seen) = (theirs.clone(), seen.clone());
            let mut desk = Desk::default();
            move |request: Request, turn: &Turn| desk.answer(&request, turn, &found, &seen)
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
        let found = self.found.lock().unwrap_or_else(PoisonError::into_inner);
        (found.version == self.version).then(|| found.clone())
    }

    /// What was found out last, whichever version it is of.
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

/// What the worker keeps from request to request.
#[derive(Default)]
struct Desk {
    sketcher: Option<(PathBuf, bool, Sketcher)>,
}

impl Desk {
    fn answer(&mut self, request: &Request, turn: &Turn, found: &Mutex<Found>, seen: &impl Fn()) {
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
            let mut ready = |sketch: &Arc<Sketch>| {
                // The old light stays on the screen until there is new one to see.
                if sketch.is_ready(request.first) {
                    tell(&|found| found.sketches[detail as usize] = Some(sketch.clone()));
                }
            };
            match self.sketch(request, detail, turn, &mut ready) {
                Ok(sketch) => tell(&|found| found.sketches[detail as usize] = Some(sketch.clone())),
                Err(Error::Cancelled) => return,
                Err(error) => return tell(&|found| found.problem = Some(error.to_string())),
            }
        }
    }

    fn sketch(
        &mut self,
        request: &Request,
        detail: Detail,
        turn: &Turn,
        ready: &mut dyn FnMut(&Arc<Sketch>),
    ) -> Result<Arc<Sketch>> {
        let Subject { project, base, external } = &request.subject;
        if self.sketcher.as_ref().is_none_or(|(at, outside, _)| at != base || outside != external) {
            let sketcher = Sketcher::new(AssetFolder::new(base, *external)?);
            self.sketcher = Some((base.clone(), *external, sketcher));
        }
        let Some((_, _, sketcher)) = &mut self.sketcher else { return Err(Error::Cancelled) };
        let first = request.first;
        match detail {
            Detail::Draft => turn.shielded(|progress| sketcher.sketch(project, detail, first, progress, ready)),
            Detail::Preview | Detail::Fine => sketcher.sketch(project, detail, first, &turn.progress, ready),
        }
    }
}
