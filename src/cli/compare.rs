//! `lightloom compare`: one project by all methods on one sheet.

use lightloom_core::{Error, Result};

use super::args::CompareArgs;
use super::exit_code::BAD_FRAMES;
use super::job;

/// Frames that are rendered where none are asked for: those on the sheet.
const FRAMES: usize = 6;

pub(super) fn run(args: &CompareArgs) -> Result<u8> {
    let frames = if args.project.frames.is_some() { None } else { Some(FRAMES) };
    let comparison = job::run(&args.project, &args.out, |engine, project, progress, saved| {
        engine.compare(project, frames, &args.out, progress, saved)
    })?;
    if comparison.stopped {
        eprintln!("lightloom: stopped early; the sheet shows what is there, at the quality reached so far");
        return Err(Error::Cancelled);
    }
    Ok(if comparison.has_bad_frames() { BAD_FRAMES } else { 0 })
}
