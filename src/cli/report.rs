//! `lightloom report`: what the settings do to a project, as plots and tables.

use lightloom_core::Result;
use lightloom_core::report::gamma_response;

use super::args::ReportArgs;
use super::job;

pub(super) fn run(args: &ReportArgs) -> Result<u8> {
    job::run(&args.project, &args.out, |pipeline, project, progress, saved| {
        let response = gamma_response(pipeline, project, progress)?;
        response.write(&args.out)?.iter().for_each(|path| saved(path));
        Ok(response)
    })?;
    Ok(0)
}
