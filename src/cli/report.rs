//! `lightloom report`: what a project's settings buy and what they cost, on a page; or the stability table.

use lightloom_core::{Error, Result};
use lightloom_report::{Effort, report, stability};

use super::args::ReportArgs;
use super::job;

/// Exit code where a section failed, or a row of the table misses its bound: a numerical failure.
const FAILED: u8 = 7;

pub(super) fn run(args: &ReportArgs) -> Result<u8> {
    let effort = if args.quick { Effort::Quick } else { Effort::Full };
    if args.stability {
        return run_stability(args, effort);
    }
    let report = job::run(&args.project, &args.out, |engine, project, progress, saved| {
        let report = report(engine, project, effort, &args.only, &args.out, progress)?;
        report.write(&args.out, "report")?.iter().for_each(|path| saved(path));
        Ok(report)
    })?;
    Ok(if report.has_failed() { FAILED } else { 0 })
}

/// The stability table, which needs no project.
fn run_stability(args: &ReportArgs, effort: Effort) -> Result<u8> {
    let out = &args.out;
    args.project.common.set_threads()?;
    // Before minutes of work go there.
    std::fs::create_dir_all(out).map_err(Error::io("create the folder", out))?;
    let table = job::watch(&args.project, out, |progress, saved| {
        let table = stability(effort, progress)?;
        table.report(effort).write(out, "stability")?.iter().for_each(|path| saved(path));
        Ok(table)
    })?;
    Ok(if table.missed().next().is_some() { FAILED } else { 0 })
}
