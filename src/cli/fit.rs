//! `lightloom fit`: the flow without pictures, for other programs.

use lightloom_core::pipeline::Pipeline;
use lightloom_core::project::AssetFolder;
use lightloom_core::{Progress, Result};

use super::args::FitArgs;
use super::job;
use super::progress::{Display, Lines};

pub(super) fn run(args: &FitArgs) -> Result<u8> {
    args.project.set_threads()?;
    let project = args.project.load()?;
    let assets = AssetFolder::new(&args.project.path, args.project.allow_external)?;
    job::prepare_folder(&args.out, &args.project.path, &project)?;
    let progress = Progress::new();
    job::stop_on_interrupt(&progress);

    let display = Display::start(&progress, Lines::beside(args.project.json));
    let saved = |path: &std::path::Path| display.line(&format!("Saved: '{}'", path.display()));
    let summary = Pipeline::new(assets).fit(&project, &args.out, &progress, &saved)?;
    drop(display);
    job::conclude(&summary, &args.out, args.project.json)?;
    Ok(0)
}
