//! `lightloom import`: a scene of another program becomes a project.

use lightloom_core::{Progress, Result, import};

use super::args::ImportArgs;
use super::progress::Lines;

pub(super) fn run(args: &ImportArgs) -> Result<u8> {
    let (import, project) = import::into_folder(&args.file, &args.into, &Progress::new())?;
    let summary = &import.summary;
    summary.notes.iter().for_each(|note| Lines::Err.say(&format!("note: {note}")));
    Lines::Out.print(&format!("{}\n{}", summary.line(), project.display()))?;
    Ok(0)
}
