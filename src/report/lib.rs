//! Reports: what the settings of a project buy and what they cost, measured, on a page with tables, plots and pictures;
//! and the stability table of stiff and extreme inputs.
//!
//! A report is a list of sections (`sections`); each file there measures one thing and returns a [`Section`], which `page`
//! lays out. The stages that are timed by themselves are one list (`stages`).

mod clock;
mod content;
mod context;
mod crop;
mod effort;
mod machine;
mod meeting_film;
mod number;
mod page;
mod pareto;
mod plot;
mod report;
mod sections;
mod slope;
mod ssim;
mod stability;
mod stages;
mod write;

use std::path::Path;
use std::time::Instant;

pub use content::{Cell, Part, Picture, Pictures, Row, Section, Table, Tone};
pub use effort::Effort;
pub use plot::{Axis, Line, Panel, Plot, Style};
pub use report::{Absent, Report};
pub use sections::gamma::{GammaResponse, Response, gamma_response};
pub use stability::{Bound, EnergyOf, Limits, Measured, Stability, StabilityRow, stability};

use context::Context;
use lightloom_core::engine::Engine;
use lightloom_core::project::Project;
use lightloom_core::{Error, Progress, Result};
use report::made_by;
use sections::SECTIONS;

/// Measures a project: the sections named in `only`, all when it is empty, except those that do not apply to the project.
///
/// A section that fails is listed as absent and the others go on. A run that is cancelled after its first section returns
/// the sections that are complete. `scratch` is a folder with room for the frames of a render, such as that of the report.
///
/// # Errors
/// A name in `only` that is no section; anything wrong with the project or its files; cancelled before the first section
/// was complete.
pub fn report(
    engine: &Engine,
    project: &Project,
    effort: Effort,
    only: &[String],
    scratch: &Path,
    progress: &Progress,
) -> Result<Report> {
    let start = Instant::now();
    let chosen = sections::choose(only)?;
    progress.set_stages(chosen.iter().map(|section| (section.name, section.seconds(effort))).collect());
    let mut context = Context::new(engine, project, effort, scratch, progress)?;
    let (mut sections, mut absent) = (Vec::new(), Vec::new());
    for section in chosen {
        let mut leave_out = |why: String, failed| absent.push(Absent { section: section.name, why, failed });
        if let Some(why) = (section.skip)(project) {
            leave_out(why.to_owned(), false);
            continue;
        }
        match progress.check().and_then(|()| (section.measure)(&mut context, progress)) {
            Ok(section) => sections.push(section),
            Err(Error::Cancelled) if sections.is_empty() => return Err(Error::Cancelled),
            Err(Error::Cancelled) => leave_out("the run was stopped".to_owned(), false),
            Err(error) => leave_out(error.to_string(), true),
        }
    }
    let (title, seconds) = (project.name.clone(), start.elapsed().as_secs_f64());
    Ok(Report { title, made_by: made_by(effort), sections, absent, seconds })
}

/// Names of all sections, in order.
pub fn sections() -> impl Iterator<Item = &'static str> {
    SECTIONS.iter().map(|section| section.name)
}
