//! How well the light holds together, by each method.

use super::section_def::{SectionDef, nothing_moves};
use crate::content::{Cell, Section, Table, Tone};
use crate::context::Context;
use lightloom_core::continuity::{Continuity, FIGURES};
use lightloom_core::flow::MotionMethod;
use lightloom_core::project::Project;
use lightloom_core::{Progress, Result};

pub(super) const SECTION: SectionDef =
    SectionDef { name: "continuity", skip: nothing_moves, measure, seconds: [6.0, 30.0] };

fn measure(context: &mut Context, progress: &Progress) -> Result<Section> {
    let own = context.project.method;
    let able = context.project.able_methods().collect::<Vec<_>>();
    progress.begin("continuity", able.len() as u64);
    let mut table = table();
    for method in able {
        let project = Project { method, ..context.project.clone() };
        for segment in context.engine.continuity(&project, &progress.inner())? {
            for (name, figures) in segment.named_figures() {
                let tone = if method == own { Tone::Marked } else { Tone::Plain };
                table.push(tone, row(method, name, figures));
            }
        }
        progress.advance(1);
    }
    let mut section = Section::new("continuity", "How well the light holds together");
    section.text(
        "Taken from 20 000 photons on their way, by each method. Cracks: share of the light that dark seams lack, at the \
         worst moment and as a mean over time, beyond that of the keys. Torn: share of the photons that are away from their \
         neighbours in the source at t = 0.5, and from those in the target at t = 0.5 and 0.75 (late). Bunch: the fullest spot \
         over that of the fuller key. Fastest: over the mean straight speed, beside the longest straight way. The method of \
         the project is marked.",
    );
    section.table(table);
    Ok(section)
}

fn table() -> Table {
    let columns: Vec<&str> = ["method", "light"].into_iter().chain(FIGURES.iter().map(|f| f.name)).collect();
    Table::new("continuity", "Figures of each segment, and of caustics that flow by themselves.", &columns)
}

fn row(method: MotionMethod, light: String, figures: &Continuity) -> Vec<Cell> {
    let numbers = FIGURES.iter().map(|figure| figure.value(figures).map_or(Cell::Nothing, Cell::from));
    [method.name().into(), light.into()].into_iter().chain(numbers).collect()
}
