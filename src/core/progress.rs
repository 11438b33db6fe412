//! Progress, pause and cancellation of long work. Long loops check at least every few milliseconds.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering::Relaxed};
use std::sync::{Condvar, Mutex, MutexGuard, OnceLock, PoisonError};
use std::time::{Duration, Instant};

use crate::{Error, Result};

/// The progress of some work, shared by its threads and their observers. Cheap to clone.
#[derive(Clone, Default)]
pub struct Progress {
    control: Arc<Control>,
    work: Arc<Work>,
}

/// The requests of the observer.
#[derive(Default)]
struct Control {
    cancelled: AtomicBool,
    abandoned: AtomicBool,
    /// When the work must end, where it was told.
    deadline: OnceLock<Instant>,
    /// Whether `pause` is active: read often, and cheaper than its lock.
    paused: AtomicBool,
    pause: Mutex<Pause>,
    resumed: Condvar,
    #[cfg(test)]
    faults: Mutex<Faults>,
}

/// What a test plants.
#[cfg(test)]
#[derive(Default)]
struct Faults {
    /// The stages of all looks so far, where they are noted.
    looks: Option<Vec<&'static str>>,
    /// The stage in which there is a panic, after so many looks.
    panic: Option<(&'static str, usize)>,
}

/// The begin of the current pause, and the duration of earlier ones.
#[derive(Default)]
struct Pause {
    since: Option<Instant>,
    before: Duration,
}

#[derive(Default)]
struct Work {
    done: AtomicU64,
    total: AtomicU64,
    schedule: Mutex<Schedule>,
}

/// The stages with their expected seconds, and the current one.
#[derive(Default)]
struct Schedule {
    expected: Vec<(&'static str, f64)>,
    stage: Option<(&'static str, Instant)>,
    /// Total pause when the stage began.
    rested: Duration,
    /// Index of the current stage in `expected`.
    at: Option<usize>,
}

/// The progress at one moment.
#[derive(Clone, Debug)]
pub struct Snapshot {
    /// The current stage, such as "trace"; none before the first.
    pub stage: Option<&'static str>,
    /// Done share of the stage, 0..=1.
    pub fraction: f64,
    /// Done share of all stages, 0..=1, weighted by their expected seconds.
    pub overall: f64,
    /// Estimated seconds left, by the pace of this stage so far.
    pub remaining: f64,
}

impl Progress {
    /// Progress of work that has not begun.
    pub fn new() -> Self {
        Self::default()
    }

    /// Declares the stages, in order, with their expected seconds.
    pub fn set_stages(&self, stages: Vec<(&'static str, f64)>) {
        *self.schedule() = Schedule { expected: stages, ..Schedule::default() };
    }

    /// Progress of work inside a stage: paused and cancelled with the whole, but not shown.
    pub fn inner(&self) -> Self {
        Self { control: self.control.clone(), work: Arc::default() }
    }

    /// Begins a stage of `total` units of work: the next of that name among those declared.
    pub fn begin(&self, stage: &'static str, total: u64) {
        self.work.done.store(0, Relaxed);
        self.work.total.store(total.max(1), Relaxed);
        let rested = self.rested();
        let mut schedule = self.schedule();
        schedule.stage = Some((stage, Instant::now()));
        schedule.rested = rested;
        let from = schedule.at.map_or(0, |at| at + 1);
        let next = schedule.expected.iter().skip(from).position(|(name, _)| *name == stage);
        schedule.at = next.map(|i| from + i).or(schedule.at);
    }

    /// Counts `units` of the stage as done. Blocks while paused.
    pub fn advance(&self, units: u64) {
        self.work.done.fetch_add(units, Relaxed);
        self.wait_while_paused();
    }

    /// Requests the work to stop, which it does within a fraction of a second, also when paused. Complete results are kept.
    pub fn cancel(&self) {
        self.control.cancelled.store(true, Relaxed);
        self.resume();
    }

    /// Whether a stop was requested.
    pub fn is_cancelled(&self) -> bool {
        self.control.cancelled.load(Relaxed)
    }

    /// As [`Self::cancel`]; what keeps results ends within `time`, and leaves out what takes longer.
    pub fn cancel_within(&self, time: Duration) {
        // The first counts.
        let _ = self.control.deadline.set(Instant::now() + time);
        self.cancel();
    }

    /// Whether there is a time by which the work must end.
    pub fn ends_soon(&self) -> bool {
        self.control.deadline.get().is_some()
    }

    /// Whether the time is over by which the work must end.
    pub fn is_late(&self) -> bool {
        self.control.deadline.get().is_some_and(|deadline| Instant::now() >= *deadline)
    }

    /// As [`Self::cancel`], but complete results are dropped too: no more files are written.
    pub fn abandon(&self) {
        self.control.abandoned.store(true, Relaxed);
        self.cancel();
    }

    /// Whether all results are to be dropped.
    pub fn is_abandoned(&self) -> bool {
        self.control.abandoned.load(Relaxed)
    }

    /// Pauses the work at its next check. Its threads block there, so they must serve nothing else.
    pub fn pause(&self) {
        let mut pause = self.lock_pause();
        if !self.is_cancelled() && pause.since.is_none() {
            pause.since = Some(Instant::now());
            self.control.paused.store(true, Relaxed);
        }
    }

    /// Resumes paused work.
    pub fn resume(&self) {
        let mut pause = self.lock_pause();
        let rested = pause.since.take().map_or(Duration::ZERO, |since| since.elapsed());
        pause.before += rested;
        self.control.paused.store(false, Relaxed);
        self.control.resumed.notify_all();
    }

    /// Whether the work is paused, or will be at its next check.
    pub fn is_paused(&self) -> bool {
        self.control.paused.load(Relaxed)
    }

    /// Total duration of pauses.
    pub fn rested(&self) -> Duration {
        let pause = self.lock_pause();
        pause.before + pause.since.map_or(Duration::ZERO, |since| since.elapsed())
    }

    /// `Err(Cancelled)` once a stop is requested. Blocks while paused.
    pub fn check(&self) -> Result<()> {
        self.wait_while_paused();
        if self.is_cancelled() { Err(Error::Cancelled) } else { Ok(()) }
    }

    fn wait_while_paused(&self) {
        #[cfg(test)]
        self.meet_faults();
        if !self.is_paused() {
            return;
        }
        let paused = |pause: &mut Pause| pause.since.is_some();
        let resumed = self.control.resumed.wait_while(self.lock_pause(), paused);
        drop(resumed.unwrap_or_else(PoisonError::into_inner));
    }

    #[cfg(test)]
    fn meet_faults(&self) {
        let stage = self.schedule().stage.map_or("", |(stage, _)| stage);
        let mut faults = self.control.faults.lock().unwrap_or_else(PoisonError::into_inner);
        faults.looks.iter_mut().for_each(|looks| looks.push(stage));
        let Some((_, left)) = faults.panic.as_mut().filter(|(planted, _)| *planted == stage) else { return };
        *left = left.saturating_sub(1);
        if *left == 0 {
            faults.panic = None;
            panic!("a planted panic");
        }
    }

    /// Progress that notes the stage of each look for a pause or a cancellation, in whichever thread.
    #[cfg(test)]
    pub(crate) fn noting_looks() -> Self {
        let progress = Self::new();
        progress.control.faults.lock().unwrap_or_else(PoisonError::into_inner).looks = Some(Vec::new());
        progress
    }

    /// The stages of all looks so far.
    #[cfg(test)]
    pub(crate) fn looks(&self) -> Vec<&'static str> {
        let faults = self.control.faults.lock().unwrap_or_else(PoisonError::into_inner);
        faults.looks.clone().unwrap_or_default()
    }

    /// Progress whose look number `look` (from 1) in a stage is a panic, in whichever thread.
    #[cfg(test)]
    pub(crate) fn with_panic(stage: &'static str, look: usize) -> Self {
        let progress = Self::new();
        progress.control.faults.lock().unwrap_or_else(PoisonError::into_inner).panic = Some((stage, look));
        progress
    }

    fn lock_pause(&self) -> MutexGuard<'_, Pause> {
        self.control.pause.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The progress now.
    pub fn snapshot(&self) -> Snapshot {
        let rested = self.rested();
        let total = self.work.total.load(Relaxed).max(1) as f64;
        let fraction = (self.work.done.load(Relaxed) as f64 / total).min(1.0);
        let schedule = self.schedule();
        let sum = |stages: &[(&str, f64)]| stages.iter().map(|(_, seconds)| seconds).sum::<f64>();
        let (before, now, after) = match schedule.at {
            Some(i) => {
                (sum(&schedule.expected[..i]), schedule.expected[i].1, sum(&schedule.expected[i + 1..]))
            }
            None => (0.0, 0.0, sum(&schedule.expected)),
        };
        // The expected seconds count until enough of the stage is done to extrapolate its pace.
        let elapsed = schedule.stage.map_or(Duration::ZERO, |(_, since)| since.elapsed());
        let elapsed = elapsed.saturating_sub(rested.saturating_sub(schedule.rested)).as_secs_f64();
        let stage_left =
            if fraction > 0.05 { elapsed / fraction * (1.0 - fraction) } else { now * (1.0 - fraction) };
        Snapshot {
            stage: schedule.stage.map(|(name, _)| name),
            fraction,
            overall: (before + now * fraction) / (before + now + after).max(1e-9),
            remaining: stage_left + after,
        }
    }

    fn schedule(&self) -> MutexGuard<'_, Schedule> {
        self.work.schedule.lock().unwrap_or_else(PoisonError::into_inner)
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
