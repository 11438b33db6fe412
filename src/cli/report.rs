//! `lightloom report`: what the settings do to a project, as plots and tables.

use lightloom_core::Result;
use lightloom_core::report::gamma_response;

use super::args::ReportArgs;
use super::job;
use super::progress::Lines;

pub(super) fn run(args: &ReportArgs) -> Result<u8> {
    let (project, out) = (&args.project, &args.out);
    let response = job::work(project, out, |pipeline, project, progress, saved| {
        let response = gamma_response(pipeline, project, progress)?;
        response.write(out)?.iter().for_each(|path| saved(path));
        Ok(response)
    })?;
    let shown = if project.json { response.to_json() } else { response.to_text() };
    Lines::Out.say(shown.trim_end());
    Ok(0)
}
