//! The worker that measures how well the light of a preview holds together, while somebody reads its figures.

use std::sync::{Arc, Mutex, PoisonError};

use lightloom_core::engine::{Preview, SegmentContinuity};

use super::worker::{Share, Turn, Worker};

/// The figures of each segment.
pub(super) type Segments = Arc<Vec<SegmentContinuity>>;

/// Measures the newest preview that is finished.
pub(super) struct FigureTaker {
    worker: Worker<Arc<Preview>>,
    asked: Option<Arc<Preview>>,
    found: Arc<Mutex<Option<Segments>>>,
}

impl FigureTaker {
    /// `wake` is called when there are new figures.
    pub(super) fn new(wake: impl Fn() + Clone + Send + 'static) -> Self {
        let found: Arc<Mutex<Option<Segments>>> = Arc::default();
        let theirs = found.clone();
        let seen = wake.clone();
        let worker = Worker::new("figures", Share::Half, wake, move || {
            let (found, seen) = (theirs.clone(), seen.clone());
            move |preview: Arc<Preview>, turn: &Turn| {
                // What is wrong with the flow is told by the animation.
                let Ok(segments) = preview.continuity(&turn.progress) else { return };
                *found.lock().unwrap_or_else(PoisonError::into_inner) = Some(Arc::new(segments));
                seen();
            }
        });
        Self { worker, asked: None, found }
    }

    /// Measures a preview if its figures are `wanted` and it is finished, unless it is the last one.
    pub(super) fn follow(&mut self, preview: Option<&Arc<Preview>>, wanted: bool) {
        let Some(preview) = preview.filter(|preview| wanted && preview.numbers().is_some()) else { return };
        if self.asked.as_ref().is_none_or(|asked| !Arc::ptr_eq(asked, preview)) {
            self.asked = Some(preview.clone());
            self.worker.ask(preview.clone());
        }
    }

    /// Shows nothing until the next are measured: those of another project tell nothing.
    pub(super) fn forget(&mut self) {
        *self.found.lock().unwrap_or_else(PoisonError::into_inner) = None;
    }

    /// The figures that were measured last; none before.
    pub(super) fn found(&self) -> Option<Segments> {
        self.found.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// What a panic said, once.
    pub(super) fn panicked(&self) -> Option<String> {
        self.worker.panicked()
    }
}
