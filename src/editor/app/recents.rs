//! Recent files, and whether they still exist: checked on a thread, since disks may be slow.

use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

use crate::editor::menu::Recent;
use crate::editor::preview::worker::{Share, Turn, Worker};

/// The recent files with the thread that checks them.
pub(super) struct Recents {
    worker: Worker<Vec<PathBuf>>,
    found: Arc<Mutex<Vec<Recent>>>,
}

impl Recents {
    /// `wake` is called when the files were checked.
    pub(super) fn new(wake: impl Fn() + Clone + Send + 'static) -> Self {
        let found: Arc<Mutex<Vec<Recent>>> = Arc::default();
        let theirs = found.clone();
        let seen = wake.clone();
        let worker = Worker::new("recent files", Share::One, wake, move || {
            let (found, seen) = (theirs.clone(), seen.clone());
            move |paths: Vec<PathBuf>, _: &Turn| {
                let look = |path: PathBuf| Recent { is_there: path.is_file(), path };
                let recent = paths.into_iter().map(look).collect();
                *found.lock().unwrap_or_else(PoisonError::into_inner) = recent;
                seen();
            }
        });
        Self { worker, found }
    }

    /// Checks these files.
    pub(super) fn ask(&self, paths: Vec<PathBuf>) {
        self.worker.ask(paths);
    }

    /// The result of the last check.
    pub(super) fn found(&self) -> Vec<Recent> {
        self.found.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}
