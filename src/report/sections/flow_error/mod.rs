//! The error of the tracks against a fine reference, over the seconds of the fit.

mod plots;
mod probes;
mod setting;
mod tables;
mod text;
mod trial;

use super::section_def::{SectionDef, nothing_moves};
use crate::content::Section;
use crate::context::Context;
use lightloom_core::project::Project;
use lightloom_core::{Progress, Result};
use probes::Probes;
use setting::Refinement;
use trial::Trial;

pub(super) const SECTION: SectionDef = SectionDef { name: "flow", skip, measure, seconds: [13.0, 180.0] };

fn skip(project: &Project) -> Option<&'static str> {
    let other = (!project.fits()).then_some("the method fits no fields, so its tracks are exact");
    nothing_moves(project).or(other)
}

fn measure(context: &mut Context, progress: &Progress) -> Result<Section> {
    let photons = context.moving_segment(progress)?;
    let (project, again) = (context.project.clone(), context.effort.pick(0.2, 1.0));
    let finer = finer(context, !photons.walls.is_empty());
    let probes = Probes::new(&photons);
    let trial = Trial { photons: &photons, flow: &project.flow, probes, finer, again, progress };
    Ok(trial.measure(&project)?.section())
}

/// The refinement of the reference. Around walls photons cost most, and a fit about three times as much.
fn finer(context: &Context, walls: bool) -> Refinement {
    let free = Refinement { steps: 3, cells: 3, guides: 4, most_guides: usize::MAX };
    match walls {
        false => context.effort.pick(free, Refinement { steps: 4, cells: 4, ..free }),
        true => context.effort.pick(
            Refinement { steps: 2, cells: 2, guides: 1, most_guides: 10_000 },
            Refinement { steps: 2, guides: 2, ..free },
        ),
    }
}
