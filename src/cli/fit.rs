//! `lightloom fit`: the flow without pictures, for other programs.

use lightloom_core::Result;

use super::args::FitArgs;
use super::job;

pub(super) fn run(args: &FitArgs) -> Result<u8> {
    job::run(&args.project, &args.out, |engine, project, progress, saved| {
        engine.fit(project, &args.out, progress, saved)
    })?;
    Ok(0)
}
