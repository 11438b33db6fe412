//! The error of the plan over its seconds: how fine it must be, free and around walls.

mod parameter;
mod plots;
mod text;
mod trial;

use super::section_def::{SectionDef, nothing_moves};
use crate::content::Section;
use crate::context::Context;
use lightloom_core::matching::MatchingMethod;
use lightloom_core::project::Project;
use lightloom_core::{Progress, Result};
use trial::Trial;

pub(super) const SECTION: SectionDef = SectionDef { name: "plan", skip, measure, seconds: [40.0, 600.0] };

fn skip(project: &Project) -> Option<&'static str> {
    let given = project.matching == MatchingMethod::Given;
    nothing_moves(project).or(given.then_some("rows are paired as given, so no photons meet half way"))
}

fn measure(context: &mut Context, progress: &Progress) -> Result<Section> {
    let photons = context.moving_segment(progress)?;
    let trial = Trial { photons: &photons, flow: &context.project.flow, effort: context.effort, progress };
    Ok(trial.measure()?.section(&context.project.name))
}
