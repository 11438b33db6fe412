//! `lightloom report`: what a project's settings buy and what they cost, on a page.

use lightloom_core::Result;
use lightloom_core::report::{Effort, report};

use super::args::ReportArgs;
use super::job;

/// Exit code where a section failed: a numerical failure.
const FAILED: u8 = 7;

pub(super) fn run(args: &ReportArgs) -> Result<u8> {
    let effort = if args.quick { Effort::Quick } else { Effort::Full };
    let report = job::run(&args.project, &args.out, |pipeline, project, progress, saved| {
        let report = report(pipeline, project, effort, &args.only, &args.out, progress)?;
        report.write(&args.out, "report")?.iter().for_each(|path| saved(path));
        Ok(report)
    })?;
    Ok(if report.has_failed() { FAILED } else { 0 })
}
