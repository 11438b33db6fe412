//! Shows how far it is: a bar on a terminal, otherwise one plain line per percent for logs and render farms.

use std::io::{IsTerminal as _, Write as _};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use clap::ValueEnum;
use indicatif::{HumanDuration, ProgressBar, ProgressStyle};
use lightloom_core::progress::Snapshot;
use lightloom_core::{Error, Progress};
use serde_json::json;

/// Farms call a job stuck when its log is silent for a minute.
const HEARTBEAT: Duration = Duration::from_secs(20);

/// How progress is told.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(super) enum Manner {
    /// A bar on a terminal, otherwise plain lines.
    #[default]
    Auto,
    /// Lines `Progress: 12%` and `Saved: 'FILE'`.
    Plain,
    /// A JSON object in each line.
    Json,
    /// As OpenJD reads it: `openjd_progress: 12.0`, `openjd_status: render`.
    Openjd,
}

impl Manner {
    /// The line that tells how far it is.
    fn progress(self, seen: &Snapshot) -> String {
        let percent = (seen.overall * 100.0).floor();
        let stage = seen.stage.unwrap_or("");
        match self {
            Self::Auto | Self::Plain => format!("Progress: {percent}%"),
            Self::Json => {
                json!({ "progress": percent, "stage": stage, "seconds_left": seen.remaining.round() })
                    .to_string()
            }
            Self::Openjd => format!("openjd_progress: {percent:.1}\nopenjd_status: {stage}"),
        }
    }

    /// The line that tells of a finished file.
    pub(super) fn saved(self, path: &Path) -> String {
        match self {
            Self::Json => json!({ "saved": path }).to_string(),
            Self::Auto | Self::Plain | Self::Openjd => format!("Saved: '{}'", path.display()),
        }
    }

    /// The line that tells of a failure, where farms read it.
    pub(super) fn failed(self, error: &Error) -> Option<String> {
        match self {
            Self::Auto | Self::Plain => None,
            Self::Json => Some(json!({ "error": error.to_string() }).to_string()),
            Self::Openjd => Some(format!("openjd_fail: {}", error.to_string().replace('\n', " "))),
        }
    }
}

/// Where plain lines go.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Lines {
    /// The standard output.
    Out,
    /// The standard error, where the output is kept for JSON.
    Err,
}

impl Lines {
    /// Where the lines go beside a summary that is JSON or not.
    pub(super) fn beside(json: bool) -> Self {
        if json { Self::Err } else { Self::Out }
    }

    /// Prints what was asked for. A reader that has read enough is no failure.
    ///
    /// # Errors
    /// `Io` where it cannot be written, as into a full disk.
    pub(super) fn print(self, text: &str) -> Result<(), Error> {
        let (written, name) = match self {
            Self::Out => {
                let mut out = std::io::stdout().lock();
                (writeln!(out, "{text}").and_then(|()| out.flush()), "the standard output")
            }
            Self::Err => (writeln!(std::io::stderr(), "{text}"), "the standard error"),
        };
        match written {
            Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
                Err(Error::io("write", name)(error))
            }
            _ => Ok(()),
        }
    }

    /// Prints a line. Nobody may be listening any more, which is no reason to stop the work.
    pub(super) fn say(self, line: &str) {
        let _ = self.print(line);
    }
}

/// Shows a [`Progress`] until dropped.
pub(super) struct Display {
    stop: Arc<AtomicBool>,
    bar: ProgressBar,
    lines: Lines,
    thread: Option<JoinHandle<()>>,
}

impl Display {
    /// Begins to show `progress`: by itself as a bar where the standard error is a terminal, otherwise as plain lines.
    pub(super) fn start(progress: &Progress, lines: Lines, manner: Manner) -> Self {
        let stop = Arc::new(AtomicBool::new(false));
        let on_terminal = manner == Manner::Auto && std::io::stderr().is_terminal();
        let bar = if on_terminal { terminal_bar() } else { ProgressBar::hidden() };
        let thread = thread::spawn({
            let (stop, bar, progress) = (stop.clone(), bar.clone(), progress.clone());
            move || watch(&stop, &progress, on_terminal.then_some(&bar), (lines, manner))
        });
        Self { stop, bar, lines, thread: Some(thread) }
    }

    /// Prints a line that stays, without tearing the bar.
    pub(super) fn line(&self, text: &str) {
        self.bar.suspend(|| self.lines.say(text));
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

fn watch(
    stop: &AtomicBool,
    progress: &Progress,
    bar: Option<&ProgressBar>,
    (lines, manner): (Lines, Manner),
) {
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
                lines.say(&manner.progress(&seen));
                last = (percent, Instant::now());
            }
        }
        thread::park_timeout(Duration::from_millis(100));
    }
}
