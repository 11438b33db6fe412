//! What `check` says of a project before any work is done.

use std::fmt::Write as _;

use serde::Serialize;

use super::Prepared;
use super::plan::{LeftOut, Plan};
use crate::project::{Project, Shows};

/// What would be done, what is left out and why, and roughly what it costs.
#[derive(Clone, Debug, Serialize)]
pub struct CheckReport {
    /// The project's name.
    pub project: String,
    /// What each key frame shows.
    pub keys: Vec<String>,
    /// What is done, in numbers.
    #[serde(flatten)]
    pub plan: Plan,
    /// Expected seconds of all stages.
    pub seconds: f64,
    /// What the reader should know of the files.
    pub notes: Vec<String>,
}

impl CheckReport {
    pub(super) fn new(project: &Project, prepared: &Prepared) -> Self {
        let key = |key: &crate::project::KeyFrame| {
            let shows = match &key.shows {
                Shows::PhysicalCaustic => "the physical caustic".to_owned(),
                Shows::Image(image) => format!("the picture {}", image.file),
                Shows::Points(points) => format!("the points of {}", points.file),
            };
            format!("frame {}: {shows}", key.frame)
        };
        Self {
            project: project.name.clone(),
            keys: project.keys.iter().map(key).collect(),
            seconds: prepared.plan.seconds(),
            plan: prepared.plan.clone(),
            notes: prepared.notes.clone(),
        }
    }

    /// As indented JSON.
    pub fn to_json(&self) -> String {
        // Plain numbers, strings and lists: serialisation has nothing to fail on.
        serde_json::to_string_pretty(self).unwrap_or_default() + "\n"
    }

    /// As lines for people.
    pub fn to_text(&self) -> String {
        let Plan { photons, passes, frames, left_out, stages, memory_mib, scratch_mib } = &self.plan;
        let mut text = format!("{}: {frames} frames, {passes} passes of {photons} photons\n", self.project);
        for key in &self.keys {
            let _ = writeln!(text, "  {key}");
        }
        for (stage, seconds) in stages {
            let _ = writeln!(text, "  will {stage}: about {seconds:.1} seconds");
        }
        let _ = writeln!(
            text,
            "  in all about {:.0} seconds on two cores, {memory_mib:.0} MiB of memory, {scratch_mib:.0} MiB of scratch file",
            self.seconds
        );
        for LeftOut { what, why } in left_out {
            let _ = writeln!(text, "  left out: {what} ({why})");
        }
        for note in &self.notes {
            let _ = writeln!(text, "  note: {note}");
        }
        text
    }
}
