//! The log: what the program did, in a file that a user can send.
//!
//! The window writes one into the folder `logs` of the state folder, where the last three are kept; commands write one where
//! `--log` asks for it. Messages of libraries (graphics, windows) are in it, too, from warnings on.

mod choice;
mod folder;
mod report;
mod sink;

use std::fs::File;
use std::panic;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use lightloom_core::files::make_private;
use lightloom_core::{Error, Result};
use tracing::level_filters::LevelFilter;
use tracing_subscriber::Layer as _;
use tracing_subscriber::filter::Targets;
use tracing_subscriber::layer::SubscriberExt as _;
use tracing_subscriber::util::SubscriberInitExt as _;

use crate::editor::store::Folders;
pub(crate) use choice::LogChoice;
pub use report::report;
use sink::{RUN, Sink};

/// Our own packages, as messages name their origin.
const OWN: [&str; 3] = ["lightloom", "lightloom_core", "lightloom_report"];

/// Begins the log of this run, once, and says so in its first line. Where there is no place for it, the last messages are
/// remembered nevertheless.
///
/// # Errors
/// `Io` where the file cannot be made.
pub(crate) fn begin(choice: &LogChoice, folders: Option<&Folders>) -> Result<()> {
    let made = match choice.file() {
        Some(path) => create(path.to_owned()).map(Some),
        None => folders.map(|folders| in_folder(&folders.logs())).transpose(),
    };
    let (made, problem) = match made {
        Ok(made) => (made, Ok(())),
        Err(error) => (None, Err(error)),
    };
    let (file, path) = made.unzip();
    let sink = Arc::new(Sink::new(file, path));
    let level = choice.level();
    let others = if level == LevelFilter::TRACE { LevelFilter::DEBUG } else { LevelFilter::WARN.min(level) };
    let filter = Targets::new().with_default(others).with_targets(OWN.map(|own| (own, level)));
    let lines = tracing_subscriber::fmt::layer().with_ansi(false).with_writer(sink.clone());
    // A second log in one process would be a mistake of ours; the first goes on.
    if tracing_subscriber::registry().with(lines.with_filter(filter)).try_init().is_ok() {
        let _ = RUN.set(sink);
        tracing::info!("{}", report::program());
        tell_panics();
    }
    problem
}

/// A new log in the folder of logs.
fn in_folder(logs: &Path) -> Result<(File, PathBuf)> {
    make_private(logs)?;
    folder::make_room(logs)?;
    create(folder::new_file(logs))
}

fn create(path: PathBuf) -> Result<(File, PathBuf)> {
    let file = File::create(&path).map_err(Error::io("write", &path))?;
    Ok((file, path))
}

/// Panics are in the log, with their place, before they go their way.
fn tell_panics() {
    let usual = panic::take_hook();
    panic::set_hook(Box::new(move |info| {
        tracing::error!("{info}");
        usual(info);
    }));
}
