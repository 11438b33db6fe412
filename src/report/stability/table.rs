//! The table as a chapter, and as lines for people.

use std::fmt::Write as _;

use super::super::chapter::{Cell, Chapter, Part, Table, Tone};
use super::super::{Report, made_by};
use super::{Size, Stability, StabilityRow};
use crate::Effort;

const COLUMNS: [&str; 15] = [
    "group",
    "case",
    "bound",
    "finite",
    "endpoint_error",
    "solver_residual",
    "iterations",
    "condition",
    "energy",
    "energy of",
    "crossings",
    "without a way",
    "seconds",
    "verdict",
    "note",
];

impl Stability {
    /// The rows that miss their bound.
    pub fn missed(&self) -> impl Iterator<Item = &StabilityRow> {
        self.rows.iter().filter(|row| !row.within)
    }

    /// The table with a few words on how to read it.
    pub fn chapter(&self) -> Chapter {
        let mut chapter = Chapter::new("stability", "The stiff and the extreme");
        let (all, missed) = (self.rows.len(), self.missed().count());
        chapter.say(format!("{} of {all} rows hold the bound that each states beforehand.", all - missed));
        chapter.say(
            "Energy is one of three. Misfit: |u - v| over |v| at the photons, what the fitted field leaves of the energy that \
             it minimises. Flux: the relative error of the traced light over all its ends, of the photons' flux over time, and \
             of the texture, whichever is largest. Against 1 m: the relative difference of the flux that lands from that of the \
             same scene in metres. The condition number is that of the preconditioned matrix as conjugate gradients saw it \
             (Lanczos), a bound from below; a solve that starts at its solution sees nothing.",
        );
        let mut table = Table::new("stability", "Rows in red miss their bound.", &COLUMNS);
        for row in &self.rows {
            table.push(if row.within { Tone::Plain } else { Tone::Bad }, cells(row));
        }
        chapter.parts.push(Part::Table(table));
        chapter
    }

    /// The chapter as a report of its own.
    pub fn report(&self, size: Size) -> Report {
        Report {
            title: "Stability".to_owned(),
            made_by: made_by(size.pick(Effort::Quick, Effort::Full)),
            chapters: vec![self.chapter()],
            absent: Vec::new(),
            seconds: self.seconds,
        }
    }

    /// All of it as indented JSON.
    pub fn to_json(&self) -> String {
        // Plain numbers and strings: serialisation has nothing to fail on.
        serde_json::to_string_pretty(self).unwrap_or_default() + "\n"
    }

    /// How many rows hold, and those that do not.
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
        measured.solver_residual.into(),
        measured.iterations.into(),
        measured.condition.into(),
        measured.energy.into(),
        measured.energy_of.name().into(),
        measured.crossings.into(),
        measured.unreachable.into(),
        row.seconds.into(),
        if row.within { "within" } else { "missed" }.into(),
        row.note.as_str().into(),
    ]
}
