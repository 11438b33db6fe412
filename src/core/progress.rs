//! How far is it, and may I go on? Long loops ask here at least every few milliseconds.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering::Relaxed};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use crate::{Error, Result};

/// Shared by the thread that works and the one that watches. Cheap to clone.
#[derive(Clone, Default)]
pub struct Progress {
    cancelled: Arc<AtomicBool>,
    work: Arc<Work>,
}

#[derive(Default)]
struct Work {
    done: AtomicU64,
    total: AtomicU64,
    road: Mutex<Road>,
}

/// The stages ahead with the seconds each is expected to take, and the one at work.
#[derive(Default)]
struct Road {
    expected: Vec<(&'static str, f64)>,
    stage: Option<(&'static str, Instant)>,
    /// Index of the stage at work in `expected`.
    at: Option<usize>,
}

/// What the watcher sees.
#[derive(Clone, Debug)]
pub struct Snapshot {
    /// The stage at work, such as "trace"; none before the first.
    pub stage: Option<&'static str>,
    /// Done share of the stage, 0..=1.
    pub fraction: f64,
    /// Done share of the whole road, 0..=1, by the seconds each stage was expected to take.
    pub overall: f64,
    /// Seconds still to go, by the pace of this stage so far.
    pub remaining: f64,
}

impl Progress {
    /// Nothing done, not cancelled.
    pub fn new() -> Self {
        Self::default()
    }

    /// Declares the stages ahead, in order, with the seconds each is expected to take.
    pub fn set_road(&self, stages: Vec<(&'static str, f64)>) {
        *self.road() = Road { expected: stages, stage: None, at: None };
    }

    /// Work inside a stage that counts for itself: cancelled with the whole, but not shown.
    pub fn inner(&self) -> Self {
        Self { cancelled: self.cancelled.clone(), work: Arc::default() }
    }

    /// Begins a stage of `total` units of work: the next of that name on the road.
    pub fn begin(&self, stage: &'static str, total: u64) {
        self.work.done.store(0, Relaxed);
        self.work.total.store(total.max(1), Relaxed);
        let mut road = self.road();
        road.stage = Some((stage, Instant::now()));
        let from = road.at.map_or(0, |at| at + 1);
        let next = road.expected.iter().skip(from).position(|(name, _)| *name == stage);
        road.at = next.map(|i| from + i).or(road.at);
    }

    /// Counts `units` of the stage as done.
    pub fn advance(&self, units: u64) {
        self.work.done.fetch_add(units, Relaxed);
    }

    /// Asks the work to stop; it does within a fraction of a second.
    pub fn cancel(&self) {
        self.cancelled.store(true, Relaxed);
    }

    /// Whether someone asked to stop.
    pub fn is_cancelled(&self) -> bool {
        self.cancelled.load(Relaxed)
    }

    /// `Err(Cancelled)` once someone asked to stop.
    pub fn check(&self) -> Result<()> {
        if self.is_cancelled() { Err(Error::Cancelled) } else { Ok(()) }
    }

    /// How far it is now.
    pub fn snapshot(&self) -> Snapshot {
        let total = self.work.total.load(Relaxed).max(1) as f64;
        let fraction = (self.work.done.load(Relaxed) as f64 / total).min(1.0);
        let road = self.road();
        let sum = |stages: &[(&str, f64)]| stages.iter().map(|(_, seconds)| seconds).sum::<f64>();
        let (before, now, after) = match road.at {
            Some(i) => (sum(&road.expected[..i]), road.expected[i].1, sum(&road.expected[i + 1..])),
            None => (0.0, 0.0, sum(&road.expected)),
        };
        // The expectation carries until enough of the stage is done to judge by its own pace.
        let elapsed = road.stage.map_or(0.0, |(_, since)| since.elapsed().as_secs_f64());
        let stage_left =
            if fraction > 0.05 { elapsed / fraction * (1.0 - fraction) } else { now * (1.0 - fraction) };
        Snapshot {
            stage: road.stage.map(|(name, _)| name),
            fraction,
            overall: (before + now * fraction) / (before + now + after).max(1e-9),
            remaining: stage_left + after,
        }
    }

    fn road(&self) -> MutexGuard<'_, Road> {
        self.work.road.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_whole_counts_each_stage_by_its_expected_seconds() {
        let progress = Progress::new();
        progress.set_road(vec![("trace", 1.0), ("render", 3.0)]);
        progress.begin("render", 10);
        progress.advance(5);
        let seen = progress.snapshot();
        assert_eq!((seen.stage, seen.fraction), (Some("render"), 0.5));
        assert!((seen.overall - 2.5 / 4.0).abs() < 1e-12);
    }

    #[test]
    fn the_whole_never_goes_back_over_stages_that_come_twice() {
        let progress = Progress::new();
        progress.set_road(vec![("match", 1.0), ("fit", 1.0), ("match", 1.0), ("fit", 1.0), ("write", 1.0)]);
        let mut last = 0.0;
        for stage in ["match", "fit", "match", "fit", "unheard of", "write"] {
            progress.begin(stage, 2);
            progress.advance(1);
            let overall = progress.snapshot().overall;
            assert!(overall >= last, "{stage}: {overall} after {last}");
            last = overall;
        }
        assert!((last - 0.9).abs() < 1e-12);
    }

    #[test]
    fn inner_work_is_cancelled_with_the_whole_but_not_shown() {
        let progress = Progress::new();
        progress.begin("render", 10);
        let inner = progress.inner();
        inner.begin("trace", 1);
        inner.advance(1);
        assert_eq!(progress.snapshot().fraction, 0.0);
        progress.cancel();
        assert!(inner.check().is_err());
    }
}
