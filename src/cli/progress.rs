//! Shows how far it is: a bar on a terminal, otherwise one plain line per percent for logs and render farms.

use std::io::IsTerminal as _;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use indicatif::{HumanDuration, ProgressBar, ProgressStyle};
use lightloom_core::Progress;

/// Farms call a job stuck when its log is silent for a minute.
const HEARTBEAT: Duration = Duration::from_secs(20);

/// Shows a [`Progress`] until dropped.
pub(super) struct Display {
    stop: Arc<AtomicBool>,
    bar: ProgressBar,
    thread: Option<JoinHandle<()>>,
}

impl Display {
    /// Begins to show `progress` on the standard error (bar) or output (plain lines).
    pub(super) fn start(progress: &Progress) -> Self {
        let stop = Arc::new(AtomicBool::new(false));
        let on_terminal = std::io::stderr().is_terminal();
        let bar = if on_terminal { terminal_bar() } else { ProgressBar::hidden() };
        let thread = thread::spawn({
            let (stop, bar, progress) = (stop.clone(), bar.clone(), progress.clone());
            move || watch(&stop, &progress, on_terminal.then_some(&bar))
        });
        Self { stop, bar, thread: Some(thread) }
    }

    /// Prints a line that stays, without tearing the bar.
    pub(super) fn line(&self, text: &str) {
        self.bar.suspend(|| println!("{text}"));
    }
}

impl Drop for Display {
    fn drop(&mut self) {
        self.stop.store(true, Relaxed);
        if let Some(thread) = self.thread.take() {
            thread.thread().unpark();
            // The watcher only prints; if it failed there is nothing to undo.
            let _ = thread.join();
        }
        self.bar.finish_and_clear();
    }
}

fn terminal_bar() -> ProgressBar {
    let style = ProgressStyle::with_template("{prefix:>12} {wide_bar} {percent:>3} %  {msg}");
    ProgressBar::new(1000).with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
}

fn watch(stop: &AtomicBool, progress: &Progress, bar: Option<&ProgressBar>) {
    let mut last = (u64::MAX, Instant::now());
    while !stop.load(Relaxed) {
        let seen = progress.snapshot();
        if let Some(bar) = bar {
            bar.set_prefix(seen.stage.unwrap_or(""));
            bar.set_position((seen.overall * 1000.0) as u64);
            bar.set_message(format!("{} left", HumanDuration(Duration::from_secs_f64(seen.remaining))));
        } else {
            let percent = (seen.overall * 100.0) as u64;
            if percent != last.0 || last.1.elapsed() > HEARTBEAT {
                println!("Progress: {percent}%");
                last = (percent, Instant::now());
            }
        }
        thread::park_timeout(Duration::from_millis(100));
    }
}
