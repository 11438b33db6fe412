//! The sections of a report: one file measures one thing.

mod flow_error;
pub(super) mod gamma;
mod growth;
mod left_out;
mod machine;
mod matching_cost;
mod render_error;
mod stage;
mod study;
mod time;

use super::chapter::Chapter;
use super::workbench::{Effort, Workbench};
use lightloom_core::project::Project;
use lightloom_core::{Error, Progress, Result};

/// One thing that is measured.
pub(super) struct Section {
    /// A short word, by which it can be asked for.
    pub(super) name: &'static str,
    /// Why a project has nothing for it.
    pub(super) needless: fn(&Project) -> Option<&'static str>,
    /// Measures. It begins a stage of its name and lets inner work report to [`Progress::inner`].
    pub(super) measure: fn(&mut Workbench, &Progress) -> Result<Chapter>,
    /// Seconds it is expected to take, quick and full.
    pub(super) seconds: [f64; 2],
}

/// All sections, in the order of the report.
pub(super) const SECTIONS: [Section; 9] = [
    render_error::SECTION,
    flow_error::SECTION,
    matching_cost::SECTION,
    study::SECTION,
    gamma::SECTION,
    time::SECTION,
    growth::SECTION,
    machine::SECTION,
    left_out::SECTION,
];

impl Section {
    /// Seconds it is expected to take.
    pub(super) fn seconds(&self, effort: Effort) -> f64 {
        self.seconds[usize::from(effort == Effort::Full)]
    }
}

/// The sections of these names, in the order of the report; all of them where none is named.
///
/// # Errors
/// `Value` for a name that is no section.
pub(super) fn choose(only: &[String]) -> Result<Vec<&'static Section>> {
    const ALL: &[Section] = &SECTIONS;
    if let Some(strange) = only.iter().find(|name| !ALL.iter().any(|section| section.name == name.as_str())) {
        let names: Vec<_> = ALL.iter().map(|section| section.name).collect();
        let what =
            format!("'{strange}' is no section of the report; give one or more of {}", names.join(","));
        return Err(Error::value("--only", what));
    }
    let chosen = |section: &&Section| only.is_empty() || only.iter().any(|name| name == section.name);
    Ok(ALL.iter().filter(chosen).collect())
}

/// For sections of the flow: why a project has none.
fn nothing_moves(project: &Project) -> Option<&'static str> {
    (project.keys.len() < 2).then_some("there is one key frame, so nothing moves")
}
