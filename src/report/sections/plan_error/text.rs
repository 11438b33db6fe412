//! The section and its text.

use super::trial::{Measured, Run, Series};
use crate::content::Section;
use crate::number::short;

impl Measured {
    pub(super) fn section(&self, project: &str) -> Section {
        let mut section = Section::new("plan", "What exactness of the plan costs");
        section.text(
            "The plan says where the whole body of light goes; the field is fitted to it. Its cells, its steps and the sweeps \
             of its scaling (over their usual number) are varied, each alone, the field's own grid stays. Misplaced: share of \
             the light that the first plan leaves at the wrong place. Gap: how far the photons of both keys miss each other \
             where they meet, before that is made up for on the way. Cracks and fullest cell are those of the section on how \
             well the light holds together, from the photons themselves. Seconds are those of all plans of a segment; the \
             table has those of its fits beside them. A setting is worth its seconds where a line still falls.",
        );
        for series in &self.series {
            section.plot(series.plot(project));
            section.text(series.own_text());
        }
        section.table(self.table());
        section
    }
}

impl Series {
    fn own_text(&self) -> String {
        let Run { setting, seconds: [plan, fit], misplaced, gap, figures, .. } = self.own();
        format!(
            "The project's own plan {}: {} cells, {} steps; {} s of plans beside {} s of fits. It misplaces {} of the light, \
             the gap is {}, cracks are {}, the fullest cell has {} times the light of that of the keys.",
            self.name(),
            setting.cells,
            setting.steps,
            short(*plan),
            short(*fit),
            short(*misplaced),
            short(*gap),
            short(figures.cracks),
            short(figures.bunch)
        )
    }
}
