//! `lightloom fit`: the flow without pictures, for other programs, or baked for renders in parts.

use lightloom_core::Result;

use super::args::FitArgs;
use super::job;

pub(super) fn run(args: &FitArgs) -> Result<u8> {
    if let Some(bake) = &args.bake {
        job::run(&args.project, bake, |engine, project, progress, saved| {
            engine.bake(project, bake, progress, saved)
        })?;
    } else if let Some(out) = &args.out {
        job::run(&args.project, out, |engine, project, progress, saved| {
            engine.fit(project, out, progress, saved)
        })?;
    }
    Ok(0)
}
