//! `lightloom fit`: the flow without pictures, for other programs.

use lightloom_core::Result;

use super::args::FitArgs;
use super::job;

pub(super) fn run(args: &FitArgs) -> Result<u8> {
    job::run(&args.project, &args.out, |pipeline, project, progress, saved| {
        pipeline.fit(project, &args.out, progress, saved)
    })?;
    Ok(0)
}
