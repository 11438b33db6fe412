//! `lightloom check`: what would be done, what is left out and why, what is wrong, what it would cost.

use lightloom_core::Result;
use lightloom_core::engine::Engine;

use super::args::CheckArgs;
use super::progress::Lines;

pub(super) fn run(args: &CheckArgs) -> Result<u8> {
    args.project.common.set_threads()?;
    let project = args.project.load()?;
    let assets = args.project.common.assets(args.project.path()?)?;
    let report = Engine::new(assets).check(&project)?;
    tracing::info!("{}", report.to_text().trim_end());
    let shown = if args.project.common.json { report.to_json() } else { report.to_text() };
    Lines::Out.print(shown.trim_end())?;
    Ok(0)
}
