//! `lightloom render`: project file to numbered frames.

use lightloom_core::pipeline::Pipeline;
use lightloom_core::project::AssetFolder;
use lightloom_core::{Error, Progress, Result};

use super::args::RenderArgs;
use super::progress::Display;
use super::{BAD_FRAMES, job};

pub(super) fn run(args: &RenderArgs) -> Result<u8> {
    args.project.set_threads()?;
    let project = args.project.load()?;
    let assets = AssetFolder::new(&args.project.path, args.project.allow_external)?;
    refuse_overwriting_project(args)?;
    job::prepare_folder(&args.out)?;
    let progress = Progress::new();
    job::stop_on_interrupt(&progress);

    let display = Display::start(&progress);
    let saved = |path: &std::path::Path| display.line(&format!("Saved: '{}'", path.display()));
    let summary = Pipeline::new(assets).render(&project, &args.out, &progress, &saved)?;
    drop(display);
    job::conclude(&summary, &args.out, args.project.json)?;
    if progress.is_cancelled() {
        eprintln!("lightloom: stopped early; every frame is there, at the quality reached so far");
        return Err(Error::Cancelled);
    }
    Ok(if summary.has_bad_frames() { BAD_FRAMES } else { 0 })
}

/// A folder of the project's own name would otherwise be made over the project file.
fn refuse_overwriting_project(args: &RenderArgs) -> Result<()> {
    if args.out.is_file() {
        let what = format!("'{}' is a file; name a folder", args.out.display());
        return Err(Error::value("--out", what));
    }
    Ok(())
}
