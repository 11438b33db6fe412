//! The commands: arguments in, files and exit codes out. No algorithm lives here.

pub(crate) mod args;
mod check;
mod claim;
mod collect;
mod compare;
mod exit_code;
mod farm;
mod figures;
mod fit;
mod frames;
mod import;
mod interrupt;
mod job;
mod photons;
mod progress;
mod render;
mod report;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::process::ExitCode;

use clap::Parser as _;
use lightloom_core::Error;
use lightloom_core::project::Project;

use crate::editor::store::Folders;
use crate::log;
use args::{Cli, Command};
use exit_code::{INTERNAL, NO_WINDOW, exit_code};
use progress::Lines;

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
    ExitCode::from(concluded(|| begin_log(&cli).and_then(|()| run(&cli))))
}

fn run(cli: &Cli) -> Result<u8, Error> {
    match &cli.command {
        None => edit(cli.project.as_deref(), cli.safe_mode),
        Some(Command::Render(args)) => render::run(args),
        Some(Command::Fit(args)) => fit::run(args),
        Some(Command::Photons(args)) => photons::run(args),
        Some(Command::Compare(args)) => compare::run(args),
        Some(Command::Figures(args)) => figures::run(args),
        Some(Command::Check(args)) => check::run(args),
        Some(Command::Import(args)) => import::run(args),
        Some(Command::Collect(args)) => collect::run(args),
        Some(Command::Report(args)) => report::run(args),
        Some(Command::Farm(args)) => farm::run(args),
        Some(Command::Verify(args)) => frames::verify(args),
        Some(Command::Info(args)) => frames::info(args),
        Some(Command::Sheet(args)) => frames::sheet(args),
        Some(Command::Schema) => schema(),
    }
}

/// The exit code of a command; why it failed is told. A panic, on whichever of its threads, is told to be a fault of ours.
fn concluded(command: impl FnOnce() -> Result<u8, Error>) -> u8 {
    let say = |text: String| Lines::Err.say(&format!("lightloom: {text}"));
    match catch_unwind(AssertUnwindSafe(command)) {
        Ok(Ok(code)) => code,
        Ok(Err(error)) => {
            say(error.to_string());
            tracing::error!("{error}");
            match (&error, interrupt::signal()) {
                (Error::Cancelled, Some(signal)) => signal.exit_code(),
                _ => exit_code(&error),
            }
        }
        Err(_) => {
            say("a fault of the program ended it; the line above says where, please report it. Files that were finished are \
                 whole; the same command goes on from there"
                .into());
            INTERNAL
        }
    }
}

/// Begins the log: of a command where it was asked for, of the window in any case, if it can be.
fn begin_log(cli: &Cli) -> Result<(), Error> {
    if cli.log.is_none() && cli.command.is_some() {
        return Ok(());
    }
    let folders = Folders::of_user();
    let choice = cli.log.clone().unwrap_or_default();
    let begun = log::begin(&choice, folders.as_ref());
    if cli.log.is_some() { begun } else { Ok(()) }
}

/// Opens the window. A project that is not there is told here, where a mistyped command is seen.
fn edit(project: Option<&Path>, safe_mode: bool) -> Result<u8, Error> {
    if let Some(path) = project.filter(|path| !path.is_file()) {
        let what =
            format!("'{}' is neither a command nor a project file; see lightloom --help", path.display());
        return Err(Error::value("PROJECT", what));
    }
    match crate::editor::run(project, safe_mode) {
        Ok(()) => Ok(0),
        Err(why) => {
            eprintln!(
                "lightloom: cannot open a window: {why}. Without one, `lightloom render PROJECT --out DIR` renders a project."
            );
            Ok(NO_WINDOW)
        }
    }
}

fn schema() -> Result<u8, Error> {
    Lines::Out.print(&format!("{:#}", Project::json_schema()))?;
    Ok(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_on_any_thread_is_an_internal_error() {
        assert_eq!(concluded(|| Ok(4)), 4);
        assert_eq!(concluded(|| panic!("planted")), INTERNAL);
        assert_eq!(concluded(|| Ok(rayon::join(|| 0, || panic!("planted")).0)), INTERNAL);
        assert_eq!(INTERNAL, 70);
    }
}
