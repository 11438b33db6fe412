//! The commands: arguments in, files and exit codes out. No algorithm lives here.

pub(crate) mod args;
mod check;
mod compare;
mod fit;
mod job;
mod progress;
mod render;
mod report;

use std::path::Path;
use std::process::ExitCode;

use clap::Parser as _;
use lightloom_core::Error;
use lightloom_core::project::Project;

use args::{Cli, Command};

/// Exit code where all frames are there, but some hold values that had to be replaced.
const BAD_FRAMES: u8 = 4;
/// Exit code where there is no screen, or nothing that draws on it.
const NO_WINDOW: u8 = 1;

/// Parses the arguments, runs the command, returns its exit code (listed in the README).
pub fn main() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => {
            // Help and version also come this way, and are no failure. A closed pipe cannot be told anything.
            let _ = error.print();
            return ExitCode::from(if error.use_stderr() { 2 } else { 0 });
        }
    };
    let done = match &cli.command {
        None => edit(cli.project.as_deref()),
        Some(Command::Render(args)) => render::run(args),
        Some(Command::Fit(args)) => fit::run(args),
        Some(Command::Compare(args)) => compare::run(args),
        Some(Command::Check(args)) => check::run(args),
        Some(Command::Report(args)) => report::run(args),
        Some(Command::Schema) => schema(),
    };
    match done {
        Ok(code) => ExitCode::from(code),
        Err(error) => {
            eprintln!("lightloom: {error}");
            ExitCode::from(exit_code(&error))
        }
    }
}

/// Opens the window. A project that is not there is told here, where a mistyped command is seen.
fn edit(project: Option<&Path>) -> Result<u8, Error> {
    if let Some(path) = project.filter(|path| !path.is_file()) {
        let what =
            format!("'{}' is neither a command nor a project file; see lightloom --help", path.display());
        return Err(Error::value("PROJECT", what));
    }
    match crate::editor::run(project) {
        Ok(()) => Ok(0),
        Err(why) => {
            eprintln!("lightloom: cannot open a window: {why}");
            Ok(NO_WINDOW)
        }
    }
}

fn schema() -> Result<u8, Error> {
    progress::Lines::Out.say(&format!("{:#}", Project::json_schema()));
    Ok(0)
}

/// One code per cause, so that a render farm can tell a bad project from a full disk.
fn exit_code(error: &Error) -> u8 {
    match error {
        Error::Value { place, .. } if place.starts_with("--") => 2,
        Error::Format { .. } | Error::Value { .. } => 3,
        Error::Io { action: "read" | "find the folder", .. } => 3,
        Error::Io { .. } => 5,
        Error::Limit { .. } => 6,
        Error::Numeric { .. } => 7,
        Error::Cancelled => 130,
    }
}
