//! The export queue: exports are rendered one after the other on a thread of their own.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{Sender, channel};
use std::thread::{self, JoinHandle};

use super::job::{ExportJob, ExportSettings};
use super::record::ExportRecord;
use crate::editor::engine::SharedEngine;
use crate::editor::guard::Guard;

/// The exports of this session, oldest first.
pub struct Exports {
    engine: SharedEngine,
    jobs: Vec<Arc<ExportJob>>,
    queue: Option<Sender<Queued>>,
    worker: Option<JoinHandle<()>>,
    /// The folder of the records of exports at work; none where nothing is kept between runs.
    records: Option<PathBuf>,
}

/// An export, and its record for the next start.
type Queued = (Arc<ExportJob>, Option<ExportRecord>);

impl Exports {
    /// An empty queue. `wake` is called from other threads whenever something may have changed.
    pub fn new(engine: SharedEngine, wake: impl Fn() + Send + Sync + 'static) -> Self {
        let (queue, jobs) = channel::<Queued>();
        let guard = Guard::new("exports");
        let work = move || {
            for (job, record) in jobs {
                job.run(&guard, &wake);
                if let Some(record) = record.filter(|_| job.is_settled()) {
                    record.forget();
                }
            }
        };
        let worker = thread::Builder::new().name("exports".into()).spawn(work).ok();
        Self { engine, jobs: Vec::new(), queue: worker.is_some().then_some(queue), worker, records: None }
    }

    /// The same with records of exports at work in a folder: those that an earlier run left are offered ([`interrupted`]).
    ///
    /// [`interrupted`]: super::interrupted
    #[must_use]
    pub fn with_records(mut self, folder: Option<PathBuf>) -> Self {
        self.records = folder;
        self
    }

    /// Appends an export to the queue.
    pub fn add(&mut self, settings: ExportSettings) -> Arc<ExportJob> {
        let job = Arc::new(ExportJob::new(settings, self.engine.clone()));
        // An export that cannot be offered again is better than none.
        let record =
            self.records.as_ref().and_then(|folder| ExportRecord::write(folder, job.settings()).ok());
        if self.queue.as_ref().is_none_or(|queue| queue.send((job.clone(), record)).is_err()) {
            job.fail("the system starts no thread for it");
        }
        self.jobs.push(job.clone());
        job
    }

    /// All exports, oldest first.
    pub fn jobs(&self) -> &[Arc<ExportJob>] {
        &self.jobs
    }

    /// Whether an export is waiting or running.
    pub fn is_busy(&self) -> bool {
        self.jobs.iter().any(|job| job.is_open())
    }

    /// Removes finished exports from the list.
    pub fn clear(&mut self) {
        self.jobs.retain(|job| job.is_open());
    }
}

impl Drop for Exports {
    fn drop(&mut self) {
        self.jobs.iter().filter(|job| job.is_open()).for_each(|job| job.leave());
        // With the queue closed the worker ends after the cancelled export.
        self.queue = None;
        if let Some(worker) = self.worker.take() {
            // It catches panics of its jobs; after any other there is nothing to undo.
            let _ = worker.join();
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use std::path::Path;

    use lightloom_core::engine::Existing;
    use lightloom_core::project::Project;

    use super::*;
    use crate::editor::access::Access;
    use crate::editor::export::{Status, interrupted};
    use crate::editor::guard;

    #[test]
    fn an_export_that_panics_is_told_and_offered_again_and_the_next_one_is_rendered() {
        let folder = tempfile::tempdir().unwrap();
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("projects/letters_free.json");
        let mut project = Project::load(&file).unwrap();
        (project.render.width, project.render.height) = (32, 18);
        (project.render.photons, project.render.passes) = (2000, 1);
        project.keys[1].frame = 3;
        let settings = |name: &str| ExportSettings {
            project: Arc::new(project.clone()),
            file: file.clone(),
            access: Access::default(),
            folder: folder.path().join(name),
            film: None,
            limit: None,
            shown: 1,
            existing: Existing::Refuse,
        };
        let records = folder.path().join("records");
        let start = || Exports::new(SharedEngine::default(), || ()).with_records(Some(records.clone()));
        let mut exports = guard::planted("exports", start);
        let [failed, done] = ["failed", "done"].map(|name| exports.add(settings(name)));
        while exports.is_busy() {
            thread::yield_now();
        }
        assert!(matches!(failed.status(), Status::Failed(why) if why.contains("a planted panic")));
        assert!(matches!(done.status(), Status::Done(outcome) if outcome.frames == 3), "{:?}", done.status());
        drop(exports);
        let offered = interrupted(&records);
        assert_eq!(offered.len(), 1);
        assert_eq!(offered[0].settings.folder, folder.path().join("failed"));
    }
}
