//! The sections of a report; each file measures one.

mod continuity;
mod flow_error;
pub(crate) mod gamma;
mod growth;
mod left_out;
mod machine;
mod matching_cost;
mod plan_error;
mod render_error;
mod section_def;
mod study;
mod time;

use lightloom_core::{Error, Result};
use section_def::SectionDef;

/// All sections, in the order of the report.
pub(crate) const SECTIONS: [SectionDef; 11] = [
    render_error::SECTION,
    continuity::SECTION,
    plan_error::SECTION,
    flow_error::SECTION,
    matching_cost::SECTION,
    study::SECTION,
    gamma::SECTION,
    time::SECTION,
    growth::SECTION,
    machine::SECTION,
    left_out::SECTION,
];

/// The sections named in `only`, in the order of the report; all where it is empty.
///
/// # Errors
/// `Value` for a name that is no section.
pub(crate) fn choose(only: &[String]) -> Result<Vec<&'static SectionDef>> {
    const ALL: &[SectionDef] = &SECTIONS;
    if let Some(strange) = only.iter().find(|name| !ALL.iter().any(|section| section.name == name.as_str())) {
        let names: Vec<_> = ALL.iter().map(|section| section.name).collect();
        let what =
            format!("'{strange}' is no section of the report; give one or more of {}", names.join(","));
        return Err(Error::value("--only", what));
    }
    let chosen = |section: &&SectionDef| only.is_empty() || only.iter().any(|name| name == section.name);
    Ok(ALL.iter().filter(chosen).collect())
}
