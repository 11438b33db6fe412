//! How far is it, and may I go on? Long loops ask here at least every few milliseconds.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering::Relaxed};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use crate::{Error, Result};

/// Shared by the thread that works and the one that watches. Cheap to clone.
#[derive(Clone, Default)]
pub struct Progress(Arc<Inner>);

#[derive(Default)]
struct Inner {
    cancelled: AtomicBool,
    done: AtomicU64,
    total: AtomicU64,
    stage: Mutex<Option<(&'static str, Instant)>>,
}

/// What the watcher sees.
#[derive(Clone, Debug)]
pub struct Snapshot {
    /// The stage at work, such as "trace"; none before the first.
    pub stage: Option<&'static str>,
    /// Done share of the stage, 0..=1.
    pub fraction: f64,
    /// Seconds since the stage began.
    pub elapsed: f64,
}

impl Progress {
    /// Nothing done, not cancelled.
    pub fn new() -> Self {
        Self::default()
    }

    /// Begins a stage of `total` units of work.
    pub fn begin(&self, stage: &'static str, total: u64) {
        self.0.done.store(0, Relaxed);
        self.0.total.store(total.max(1), Relaxed);
        *self.0.stage.lock().unwrap_or_else(PoisonError::into_inner) = Some((stage, Instant::now()));
    }

    /// Counts `units` of the stage as done.
    pub fn advance(&self, units: u64) {
        self.0.done.fetch_add(units, Relaxed);
    }

    /// Asks the work to stop; it does within a fraction of a second.
    pub fn cancel(&self) {
        self.0.cancelled.store(true, Relaxed);
    }

    /// Whether someone asked to stop.
    pub fn is_cancelled(&self) -> bool {
        self.0.cancelled.load(Relaxed)
    }

    /// `Err(Cancelled)` once someone asked to stop.
    pub fn check(&self) -> Result<()> {
        if self.is_cancelled() { Err(Error::Cancelled) } else { Ok(()) }
    }

    /// How far it is now.
    pub fn snapshot(&self) -> Snapshot {
        let stage = *self.0.stage.lock().unwrap_or_else(PoisonError::into_inner);
        let total = self.0.total.load(Relaxed).max(1) as f64;
        Snapshot {
            stage: stage.map(|(name, _)| name),
            fraction: (self.0.done.load(Relaxed) as f64 / total).min(1.0),
            elapsed: stage.map_or(0.0, |(_, since)| since.elapsed().as_secs_f64()),
        }
    }
}
