//! The exports of this run of the program, rendered one after the other on a thread of their own.

use std::sync::Arc;
use std::sync::mpsc::{Sender, channel};
use std::thread::{self, JoinHandle};

use super::job::{ExportJob, ExportSettings};

/// The exports of this run of the program, oldest first.
pub struct Exports {
    jobs: Vec<Arc<ExportJob>>,
    queue: Option<Sender<Arc<ExportJob>>>,
    worker: Option<JoinHandle<()>>,
}

impl Exports {
    /// No export yet. `wake` is called whenever something may have changed, from other threads.
    pub fn new(wake: impl Fn() + Send + Sync + 'static) -> Self {
        let (queue, orders) = channel::<Arc<ExportJob>>();
        let work = move || orders.into_iter().for_each(|job| job.run(&wake));
        let worker = thread::Builder::new().name("exports".into()).spawn(work).ok();
        Self { jobs: Vec::new(), queue: worker.is_some().then_some(queue), worker }
    }

    /// Puts an export at the end of the queue.
    pub fn add(&mut self, order: ExportSettings) -> Arc<ExportJob> {
        let job = Arc::new(ExportJob::new(order));
        if self.queue.as_ref().is_none_or(|queue| queue.send(job.clone()).is_err()) {
            job.fail("the system starts no thread for it");
        }
        self.jobs.push(job.clone());
        job
    }

    /// All exports, oldest first.
    pub fn jobs(&self) -> &[Arc<ExportJob>] {
        &self.jobs
    }

    /// Whether one waits or is being rendered.
    pub fn is_busy(&self) -> bool {
        self.jobs.iter().any(|job| job.is_open())
    }

    /// Takes those from the list that are over.
    pub fn clear(&mut self) {
        self.jobs.retain(|job| job.is_open());
    }
}

impl Drop for Exports {
    fn drop(&mut self) {
        self.jobs.iter().for_each(|job| job.cancel());
        // Without orders to come the worker ends after the one that it was told to break off.
        self.queue = None;
        if let Some(worker) = self.worker.take() {
            // It catches panics of its jobs; if it broke down nonetheless there is nothing to undo.
            let _ = worker.join();
        }
    }
}
