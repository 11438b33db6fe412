//! The stability table, as a section of a report, as JSON and as text.

use std::fmt::Write as _;

use serde::Serialize;

use super::case::{Bound, Measured};
use crate::content::{Cell, Section, Table, Tone};
use crate::effort::Effort;
use crate::report::{Report, made_by};

/// The table, run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Stability {
    /// The rows, group by group.
    pub rows: Vec<StabilityRow>,
    /// Wall-clock seconds of all rows.
    pub seconds: f64,
}

/// One row, run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StabilityRow {
    /// Name of its group, such as `gamma and alpha`.
    pub group: &'static str,
    /// Its name within the group.
    pub case: String,
    /// The bound, stated before the run.
    pub bound: Bound,
    /// Its numbers; none where it ended with an error.
    pub measured: Option<Measured>,
    /// Wall-clock seconds.
    pub seconds: f64,
    /// Whether the bound holds.
    pub within: bool,
    /// The limits that it misses, or the message with which it was refused.
    pub note: String,
}

const COLUMNS: [&str; 17] = [
    "group",
    "case",
    "bound",
    "finite",
    "endpoint_error",
    "solver_error",
    "iterations",
    "condition",
    "energy",
    "energy of",
    "crossings",
    "unreachable",
    "misplaced",
    "gap",
    "seconds",
    "verdict",
    "note",
];

impl Stability {
    /// The rows that miss their bounds.
    pub fn missed(&self) -> impl Iterator<Item = &StabilityRow> {
        self.rows.iter().filter(|row| !row.within)
    }

    /// The table as a section.
    pub fn section(&self) -> Section {
        let mut section = Section::new("stability", "The stiff and the extreme");
        let (all, missed) = (self.rows.len(), self.missed().count());
        section.text(format!("{} of {all} rows hold the bound that each states beforehand.", all - missed));
        section.text(
            "Energy is one of three. Misfit: |u - v| over |v| at the photons, what the fitted field leaves of the energy that \
             it minimises. Flux: the relative error of the traced light over all its ends, of the photons' flux over time, and \
             of the texture, whichever is largest. Against 1 m: the relative difference of the flux that lands from that of the \
             same scene in metres. The condition number is that of the preconditioned matrix as conjugate gradients saw it \
             (Lanczos), a bound from below; a solve that starts at its solution sees nothing. Misplaced is the \
             share of the light that a plan leaves at the wrong place, the gap how far the photons of both keys miss each other \
             where they meet (root mean square, plane units).",
        );
        let mut table = Table::new("stability", "Rows in red miss their bound.", &COLUMNS);
        for row in &self.rows {
            table.push(if row.within { Tone::Plain } else { Tone::Bad }, cells(row));
        }
        section.table(table);
        section
    }

    /// The table as a report of one section.
    pub fn report(&self, effort: Effort) -> Report {
        Report {
            title: "Stability".to_owned(),
            made_by: made_by(effort),
            sections: vec![self.section()],
            absent: Vec::new(),
            seconds: self.seconds,
        }
    }

    /// The table as indented JSON.
    pub fn to_json(&self) -> String {
        // Plain numbers and strings: serialisation has nothing to fail on.
        serde_json::to_string_pretty(self).unwrap_or_default() + "\n"
    }

    /// The number of rows that hold, and the rows that do not.
    pub fn to_text(&self) -> String {
        let (all, missed) = (self.rows.len(), self.missed().count());
        let mut text = format!("{} of {all} rows hold their bounds, {:.0} s\n", all - missed, self.seconds);
        for StabilityRow { group, case, note, .. } in self.missed() {
            let _ = writeln!(text, "  missed: {group}, {case}: {note}");
        }
        text
    }
}

fn cells(row: &StabilityRow) -> Vec<Cell> {
    let known = row.measured.clone();
    let measured = known.clone().unwrap_or_default();
    let finite = known.map(|measured| if measured.finite { "yes" } else { "no" });
    vec![
        row.group.into(),
        row.case.as_str().into(),
        row.bound.to_text().into(),
        finite.into(),
        measured.endpoint_error.into(),
        measured.solver_error.into(),
        measured.iterations.into(),
        measured.condition.into(),
        measured.energy.into(),
        measured.energy_of.name().into(),
        measured.crossings.into(),
        measured.unreachable.into(),
        measured.misplaced.into(),
        measured.gap.into(),
        row.seconds.into(),
        if row.within { "within" } else { "missed" }.into(),
        row.note.as_str().into(),
    ]
}
