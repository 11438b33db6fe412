//! `lightloom render`: project file to numbered frames.

use lightloom_core::pipeline::Pipeline;
use lightloom_core::project::AssetFolder;
use lightloom_core::{Error, Progress, Result};

use super::args::RenderArgs;
use super::progress::{Display, Lines};
use super::{BAD_FRAMES, job};

pub(super) fn run(args: &RenderArgs) -> Result<u8> {
    args.project.set_threads()?;
    let project = args.project.load()?;
    let assets = AssetFolder::new(&args.project.path, args.project.allow_external)?;
    job::prepare_folder(&args.out, &args.project.path, &project)?;
    let progress = Progress::new();
    job::stop_on_interrupt(&progress);

    let display = Display::start(&progress, Lines::beside(args.project.json));
    let saved = |path: &std::path::Path| display.line(&format!("Saved: '{}'", path.display()));
    let summary = Pipeline::new(assets).render(&project, &args.out, &progress, &saved)?;
    drop(display);
    job::conclude(&summary, &args.out, args.project.json)?;
    if summary.passes < summary.passes_planned {
        eprintln!("lightloom: stopped early; every frame is there, at the quality reached so far");
        return Err(Error::Cancelled);
    }
    Ok(if summary.has_bad_frames() { BAD_FRAMES } else { 0 })
}
