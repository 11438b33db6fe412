//! A report as data, as JSON and as text.

use serde::Serialize;

use crate::content::Section;
use crate::effort::Effort;

/// A report: its sections, and how it was made.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    /// Headline.
    pub title: String,
    /// Program, version, threads and effort.
    pub made_by: String,
    /// The sections, in order.
    #[serde(rename = "chapters")]
    pub sections: Vec<Section>,
    /// Sections that are missing, with the reason.
    pub absent: Vec<Absent>,
    /// Wall-clock seconds of the measurement.
    pub seconds: f64,
}

/// A section that is missing.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Absent {
    /// Its name.
    pub section: &'static str,
    /// The reason.
    pub why: String,
    /// Whether it failed; otherwise it does not apply to the project, or the run was stopped.
    pub failed: bool,
}

/// Program, version, threads and effort.
pub(crate) fn made_by(effort: Effort) -> String {
    let size = match effort {
        Effort::Quick => "quick, at preview size",
        Effort::Full => "full size",
    };
    let threads = rayon::current_num_threads();
    format!("Lightloom {}, {threads} threads, {size}", env!("CARGO_PKG_VERSION"))
}

impl Report {
    /// The report without its pictures, as indented JSON.
    pub fn to_json(&self) -> String {
        // Plain numbers and strings: serialisation has nothing to fail on.
        serde_json::to_string_pretty(self).unwrap_or_default() + "\n"
    }

    /// Whether a section failed.
    pub fn has_failed(&self) -> bool {
        self.absent.iter().any(|absent| absent.failed)
    }

    /// The titles of the sections, and the missing ones, as text.
    pub fn to_text(&self) -> String {
        let mut text = format!("{}: {} sections in {:.0} s\n", self.title, self.sections.len(), self.seconds);
        for section in &self.sections {
            text += &format!("  {:<10} {}\n", section.name, section.title);
        }
        for Absent { section, why, failed } in &self.absent {
            text += &format!("  {section:<10} {}: {why}\n", if *failed { "failed" } else { "left out" });
        }
        text
    }
}
