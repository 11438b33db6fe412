//! The definition of a section: its name, and how it is measured.

use crate::content::Section;
use crate::context::Context;
use crate::effort::Effort;
use lightloom_core::project::Project;
use lightloom_core::{Progress, Result};

/// A section that can be measured.
pub(crate) struct SectionDef {
    /// A short word that selects it.
    pub(crate) name: &'static str,
    /// The reason why it does not apply to a project; none where it does.
    pub(crate) skip: fn(&Project) -> Option<&'static str>,
    /// Measures it. It begins a stage of its name and lets inner work report to [`Progress::inner`].
    pub(crate) measure: fn(&mut Context, &Progress) -> Result<Section>,
    /// Expected seconds, quick and full.
    pub(crate) seconds: [f64; 2],
}

impl SectionDef {
    /// Expected seconds.
    pub(crate) fn seconds(&self, effort: Effort) -> f64 {
        let [quick, full] = self.seconds;
        effort.pick(quick, full)
    }
}

/// The reason why sections about the flow do not apply to a project; none where they do.
pub(super) fn nothing_moves(project: &Project) -> Option<&'static str> {
    (project.keys.len() < 2).then_some("there is one key frame, so nothing moves")
}
