//! Seconds and peak memory of each stage.

use std::fs;
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use serde::Serialize;

/// The cost of one stage.
#[derive(Clone, Debug, Serialize)]
pub struct StageCost {
    /// The stage's name.
    pub stage: &'static str,
    /// Wall-clock seconds.
    pub seconds: f64,
    /// Seconds of processor time of all threads, where the system tells.
    pub cpu_seconds: Option<f64>,
    /// Most memory the process held during the stage, in MiB, where the system tells.
    pub peak_memory_mib: Option<f64>,
}

/// Measures the stages of one run.
#[derive(Default)]
pub(super) struct Meter {
    costs: Mutex<Vec<StageCost>>,
    /// Whether only time is measured: asking for the peak of memory walks through all of it.
    quick: bool,
}

impl Meter {
    /// Measures wall-clock time only.
    pub(super) fn quick() -> Self {
        Self { costs: Mutex::default(), quick: true }
    }

    /// Runs `work` as `stage`. A stage that runs again adds to its first entry.
    pub(super) fn measure<T>(&self, stage: &'static str, work: impl FnOnce() -> T) -> T {
        let (result, cost) = self.timed(stage, work);
        self.add(cost);
        result
    }

    /// Runs `work` as two stages that take turns. `seconds` has those of the first, by which processor time is shared, too;
    /// both have the peak of all.
    pub(super) fn measure_turns<T>(
        &self,
        [first, second]: [&'static str; 2],
        work: impl FnOnce() -> T,
        seconds: impl FnOnce(&T) -> f64,
    ) -> T {
        let (result, both) = self.timed(second, work);
        let share = (seconds(&result) / both.seconds.max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        for (stage, share) in [(first, share), (second, 1.0 - share)] {
            let cpu_seconds = both.cpu_seconds.map(|cpu| share * cpu);
            self.add(StageCost { stage, seconds: share * both.seconds, cpu_seconds, ..both });
        }
        result
    }

    fn timed<T>(&self, stage: &'static str, work: impl FnOnce() -> T) -> (T, StageCost) {
        if self.quick {
            let start = Instant::now();
            let result = work();
            let seconds = start.elapsed().as_secs_f64();
            return (result, StageCost { stage, seconds, cpu_seconds: None, peak_memory_mib: None });
        }
        reset_peak();
        let (start, cpu) = (Instant::now(), cpu_seconds());
        let result = work();
        let seconds = start.elapsed().as_secs_f64();
        let cpu_seconds = cpu_seconds().zip(cpu).map(|(end, start)| end - start);
        (result, StageCost { stage, seconds, cpu_seconds, peak_memory_mib: peak_mib() })
    }

    fn add(&self, cost: StageCost) {
        let mut costs = self.costs.lock().unwrap_or_else(PoisonError::into_inner);
        match costs.iter_mut().find(|c| c.stage == cost.stage) {
            Some(sum) => {
                sum.seconds += cost.seconds;
                sum.cpu_seconds = sum.cpu_seconds.zip(cost.cpu_seconds).map(|(a, b)| a + b);
                sum.peak_memory_mib = sum.peak_memory_mib.zip(cost.peak_memory_mib).map(|(a, b)| a.max(b));
            }
            None => costs.push(cost),
        }
    }

    /// The stages so far, in the order they first ran.
    pub(super) fn costs(&self) -> Vec<StageCost> {
        self.costs.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

/// Linux forgets the peak so far when 5 is written here; elsewhere the peak is that of the whole run or unknown.
fn reset_peak() {
    let _ = fs::write("/proc/self/clear_refs", "5");
}

/// Peak resident memory in MiB.
fn peak_mib() -> Option<f64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kib: f64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kib / 1024.0)
}

/// User and system time of the process so far. Fields 14 and 15 of proc_pid_stat(5), in ticks of 10 ms.
fn cpu_seconds() -> Option<f64> {
    let stat = fs::read_to_string("/proc/self/stat").ok()?;
    let fields: Vec<&str> = stat.rsplit_once(')')?.1.split_whitespace().collect();
    let ticks = |i: usize| fields.get(i)?.parse::<f64>().ok();
    Some((ticks(11)? + ticks(12)?) / 100.0)
}
