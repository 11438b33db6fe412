//! The tables of the section.

use super::setting::{Parameter, Setting};
use super::trial::{Measured, Run, SAME, Variation};
use crate::content::{Cell, Table, Tone};
use crate::pareto::{cheapest, front};

/// Errors for which the cheapest setting is listed, plane units.
const NAMED: [f64; 3] = [1e-2, 1e-3, 1e-4];
const COLUMNS: [&str; 9] = [
    "varied",
    "steps",
    "cells",
    "guides",
    "tolerance",
    "seconds",
    "rms (plane)",
    "99.9 % (plane)",
    "largest (plane)",
];
impl Measured {
    /// The cheapest setting for each of some errors.
    pub(super) fn cheapest_table(&self) -> Table {
        let caption = "The cheapest setting that was measured for an error (root mean square).";
        let columns = ["error (plane)", "setting", "seconds", "rms (plane)"];
        let mut table = Table::new("flow_cheapest", caption, &columns);
        let (own, candidates) = (self.own(), self.candidates());
        let named = NAMED.into_iter().map(|error| (Cell::from(error), error));
        let same = (Cell::from("that of the project, within 5 %"), SAME * own.error.rms);
        for (name, error) in named.chain([same]) {
            let found = cheapest(&candidates, error).map(|row| &self.runs[row]);
            let setting = found.map_or("none measured reaches it".to_owned(), |run| run.setting.describe());
            let numbers = [found.map(|run| run.seconds).into(), found.map(|run| run.error.rms).into()];
            table.push(Tone::Plain, [name, setting.into()].into_iter().chain(numbers).collect());
        }
        table
    }

    /// The error that each parameter causes alone.
    pub(super) fn alone_table(&self) -> Table {
        let caption = "The error that each setting causes alone.";
        let columns = ["setting", "value", "seconds", "rms (plane)", "99.9 % (plane)"];
        let mut table = Table::new("flow_alone", caption, &columns);
        for (parameter, rows) in &self.alone {
            for (row, error) in rows {
                let run = &self.runs[*row];
                let value = match parameter {
                    Parameter::Tolerance => format!("{:e}", run.setting.tolerance).into(),
                    _ => parameter.of(&run.setting).into(),
                };
                let tone = if *row == 0 { Tone::Marked } else { Tone::Plain };
                table.push(
                    tone,
                    vec![
                        parameter.name().into(),
                        value,
                        run.seconds.into(),
                        error.rms.into(),
                        error.high.into(),
                    ],
                );
            }
        }
        table
    }

    /// All settings.
    pub(super) fn table(&self) -> Table {
        let caption = "All settings that were measured, the cheapest first; at the end the reference with the error it is thought to have.";
        let columns: Vec<_> = COLUMNS.into_iter().chain(["on the front"]).collect();
        let mut table = Table::new("flow", caption, &columns);
        let best = front(&self.candidates());
        let mut rows: Vec<usize> = (0..self.runs.len()).collect();
        rows.sort_by(|&a, &b| self.runs[a].seconds.total_cmp(&self.runs[b].seconds));
        for row in rows {
            let Run { setting, why, seconds, error, .. } = &self.runs[row];
            let (name, tone) = match why {
                Variation::Own => ("the project's", Tone::Marked),
                Variation::Alone(parameter) => (parameter.name(), Tone::Plain),
                Variation::Balanced => ("all in balance", Tone::Plain),
            };
            let kept = if best.contains(&row) { "yes" } else { "no" };
            let measured = [*seconds, error.rms, error.high, error.most].map(Cell::from);
            let cells = [name.into()].into_iter().chain(cells(setting)).chain(measured).chain([kept.into()]);
            table.push(tone, cells.collect());
        }
        let mut last: Vec<Cell> = ["reference".into()].into_iter().chain(cells(&self.reference)).collect();
        last.extend([self.reference_seconds, self.reference_error()].map(Cell::from));
        last.resize(table.columns.len(), Cell::Nothing);
        table.push(Tone::Plain, last);
        table
    }
}

/// The cells of a setting.
fn cells(setting: &Setting) -> [Cell; 4] {
    let Setting { steps, cells: [x, y], guides, tolerance } = *setting;
    let [steps, guides] = [steps, guides].map(|count| Cell::from(f64::from(count)));
    [steps, format!("{x} x {y}").into(), guides, format!("{tolerance:e}").into()]
}
