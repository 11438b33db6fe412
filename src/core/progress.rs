//! How far is it, and may I go on? Long loops ask here at least every few milliseconds.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering::Relaxed};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use crate::{Error, Result};

/// Shared by the thread that works and the one that watches. Cheap to clone.
#[derive(Clone, Default)]
pub struct Progress {
    control: Arc<Control>,
    work: Arc<Work>,
}

/// What the watcher wants of the work.
#[derive(Default)]
struct Control {
    cancelled: AtomicBool,
    abandoned: AtomicBool,
    /// Whether `pause` holds a begin: asked often, and cheaper than its lock.
    paused: AtomicBool,
    pause: Mutex<Pause>,
    goes_on: Condvar,
}

/// Since when the work rests, and how long it rested before.
#[derive(Default)]
struct Pause {
    since: Option<Instant>,
    before: Duration,
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
    /// How long the work had rested when the stage began.
    rested: Duration,
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
    pub fn set_stages(&self, stages: Vec<(&'static str, f64)>) {
        *self.road() = Road { expected: stages, ..Road::default() };
    }

    /// Work inside a stage that counts for itself: cancelled with the whole, but not shown.
    pub fn inner(&self) -> Self {
        Self { control: self.control.clone(), work: Arc::default() }
    }

    /// Begins a stage of `total` units of work: the next of that name on the road.
    pub fn begin(&self, stage: &'static str, total: u64) {
        self.work.done.store(0, Relaxed);
        self.work.total.store(total.max(1), Relaxed);
        let rested = self.rested();
        let mut road = self.road();
        road.stage = Some((stage, Instant::now()));
        road.rested = rested;
        let from = road.at.map_or(0, |at| at + 1);
        let next = road.expected.iter().skip(from).position(|(name, _)| *name == stage);
        road.at = next.map(|i| from + i).or(road.at);
    }

    /// Counts `units` of the stage as done. Rests here while the work is paused.
    pub fn advance(&self, units: u64) {
        self.work.done.fetch_add(units, Relaxed);
        self.rest();
    }

    /// Asks the work to stop; it does within a fraction of a second, also where it is paused. What is complete is kept.
    pub fn cancel(&self) {
        self.control.cancelled.store(true, Relaxed);
        self.resume();
    }

    /// Whether someone asked to stop.
    pub fn is_cancelled(&self) -> bool {
        self.control.cancelled.load(Relaxed)
    }

    /// As [`Self::cancel`], but what is complete is not wanted either: no more files are written.
    pub fn abandon(&self) {
        self.control.abandoned.store(true, Relaxed);
        self.cancel();
    }

    /// Whether nothing of the work is wanted any more.
    pub fn is_abandoned(&self) -> bool {
        self.control.abandoned.load(Relaxed)
    }

    /// Lets the work rest at the next place where it asks whether it may go on. All its threads wait there, so that they must
    /// be threads that nothing else needs.
    pub fn pause(&self) {
        let mut pause = self.paused();
        if !self.is_cancelled() && pause.since.is_none() {
            pause.since = Some(Instant::now());
            self.control.paused.store(true, Relaxed);
        }
    }

    /// Lets paused work go on.
    pub fn resume(&self) {
        let mut pause = self.paused();
        let rested = pause.since.take().map_or(Duration::ZERO, |since| since.elapsed());
        pause.before += rested;
        self.control.paused.store(false, Relaxed);
        self.control.goes_on.notify_all();
    }

    /// Whether the work rests, or will as soon as it asks.
    pub fn is_paused(&self) -> bool {
        self.control.paused.load(Relaxed)
    }

    /// How long the work rested so far.
    pub fn rested(&self) -> Duration {
        let pause = self.paused();
        pause.before + pause.since.map_or(Duration::ZERO, |since| since.elapsed())
    }

    /// `Err(Cancelled)` once someone asked to stop. Rests here while the work is paused.
    pub fn check(&self) -> Result<()> {
        self.rest();
        if self.is_cancelled() { Err(Error::Cancelled) } else { Ok(()) }
    }

    fn rest(&self) {
        if !self.is_paused() {
            return;
        }
        let resting = |pause: &mut Pause| pause.since.is_some();
        let gone_on = self.control.goes_on.wait_while(self.paused(), resting);
        drop(gone_on.unwrap_or_else(PoisonError::into_inner));
    }

    fn paused(&self) -> MutexGuard<'_, Pause> {
        self.control.pause.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// How far it is now.
    pub fn snapshot(&self) -> Snapshot {
        let rested = self.rested();
        let total = self.work.total.load(Relaxed).max(1) as f64;
        let fraction = (self.work.done.load(Relaxed) as f64 / total).min(1.0);
        let road = self.road();
        let sum = |stages: &[(&str, f64)]| stages.iter().map(|(_, seconds)| seconds).sum::<f64>();
        let (before, now, after) = match road.at {
            Some(i) => (sum(&road.expected[..i]), road.expected[i].1, sum(&road.expected[i + 1..])),
            None => (0.0, 0.0, sum(&road.expected)),
        };
        // The expectation carries until enough of the stage is done to judge by its own pace.
        let elapsed = road.stage.map_or(Duration::ZERO, |(_, since)| since.elapsed());
        let elapsed = elapsed.saturating_sub(rested.saturating_sub(road.rested)).as_secs_f64();
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
        progress.set_stages(vec![("trace", 1.0), ("render", 3.0)]);
        progress.begin("render", 10);
        progress.advance(5);
        let seen = progress.snapshot();
        assert_eq!((seen.stage, seen.fraction), (Some("render"), 0.5));
        assert!((seen.overall - 2.5 / 4.0).abs() < 1e-12);
    }

    #[test]
    fn the_whole_never_goes_back_over_stages_that_come_twice() {
        let progress = Progress::new();
        progress.set_stages(vec![("match", 1.0), ("fit", 1.0), ("match", 1.0), ("fit", 1.0), ("write", 1.0)]);
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

    /// Counts in a thread until the work is cancelled; the count so far.
    fn counting(progress: &Progress) -> (Arc<AtomicU64>, std::thread::JoinHandle<Result<()>>) {
        let count = Arc::new(AtomicU64::new(0));
        let (progress, counter) = (progress.clone(), count.clone());
        let work = move || {
            loop {
                progress.inner().check()?;
                counter.fetch_add(1, Relaxed);
                std::thread::yield_now();
            }
        };
        (count, std::thread::spawn(work))
    }

    fn wait_until(what: impl Fn() -> bool) {
        while !what() {
            std::thread::yield_now();
        }
    }

    #[test]
    fn paused_work_rests_until_it_goes_on() {
        let progress = Progress::new();
        let (count, worker) = counting(&progress);
        wait_until(|| count.load(Relaxed) > 0);
        progress.pause();
        // The count may rise once more: the work asked just before.
        let at = count.load(Relaxed);
        std::thread::sleep(Duration::from_millis(50));
        assert!(count.load(Relaxed) <= at + 1, "{} after {at}", count.load(Relaxed));
        assert!(progress.is_paused() && progress.rested() >= Duration::from_millis(50));
        progress.resume();
        wait_until(|| count.load(Relaxed) > at + 1);
        progress.cancel();
        assert!(matches!(worker.join(), Ok(Err(Error::Cancelled))));
    }

    #[test]
    fn paused_work_can_be_cancelled() {
        let progress = Progress::new();
        progress.pause();
        let (count, worker) = counting(&progress);
        progress.abandon();
        assert!(matches!(worker.join(), Ok(Err(Error::Cancelled))));
        assert_eq!(count.load(Relaxed), 0);
        assert!(progress.is_abandoned() && !progress.is_paused());
        // What is cancelled does not rest any more.
        progress.pause();
        assert!(!progress.is_paused() && progress.check().is_err());
    }

    #[test]
    fn a_rest_does_not_make_the_rest_look_longer() {
        let progress = Progress::new();
        progress.begin("render", 10);
        progress.advance(5);
        progress.pause();
        let before = progress.snapshot().remaining;
        std::thread::sleep(Duration::from_millis(80));
        // Half is done: what remains is what was worked, without the rest of 80 ms.
        assert!(progress.snapshot().remaining < before + 0.04);
    }
}
