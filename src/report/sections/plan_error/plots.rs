//! The plots and the table of the section.

use super::parameter::{Parameter, Setting};
use super::trial::{Measured, Run, Series};
use crate::content::{Cell, Table, Tone};
use crate::plot::{Axis, Line, Panel, Plot, Style};

/// Colour of the ring around the project's own setting; the parameters have the colours from 0 on, but for this.
const OWN: usize = 1;
const COLOURS: [usize; 3] = [0, 2, 3];
const COLUMNS: [&str; 13] = [
    "walls",
    "varied",
    "cells",
    "steps",
    "sweeps",
    "plan (s)",
    "fit (s)",
    "misplaced (share)",
    "gap (plane)",
    "cracks",
    "torn",
    "bunch",
    "fastest",
];

impl Series {
    pub(super) fn name(&self) -> &'static str {
        if self.walls { "around the walls" } else { "without walls" }
    }

    /// What is left undone, over the seconds of the plans.
    pub(super) fn plot(&self, project: &str) -> Plot {
        let panels = vec![
            self.panel("misplaced light of the first plan", Axis::log("share of the light"), |run| {
                run.misplaced
            }),
            self.panel("gap at the meeting", Axis::log("root mean square (plane)"), |run| run.gap),
            self.panel("cracks", Axis::linear("share of the light"), |run| run.figures.cracks),
            self.panel("fullest cell", Axis::linear("over that of the keys"), |run| run.figures.bunch),
        ];
        let name = if self.walls { "plan_walls" } else { "plan" }.to_owned();
        let title = format!("{project}: what a plan leaves undone, {} (ring: the project's)", self.name());
        Plot { name, title, panels }
    }

    fn panel(&self, title: &str, y: Axis, value: fn(&Run) -> f64) -> Panel {
        let point = |run: &Run| (run.seconds[0], value(run));
        let mut lines: Vec<Line> = Parameter::ALL
            .into_iter()
            .zip(COLOURS)
            .map(|(parameter, colour)| {
                let points = self.along(parameter).into_iter().map(point).collect();
                Line::new(parameter.name(), Style::Line(colour), points)
            })
            .collect();
        lines.push(Line::new("", Style::Rings(OWN), vec![point(self.own())]));
        Panel { title: title.to_owned(), x: Axis::log("seconds of the plans"), y, lines }
    }
}

impl Measured {
    /// All runs.
    pub(super) fn table(&self) -> Table {
        let caption = "All plans that were measured; torn and fastest as in the section on how well the light holds together.";
        let mut table = Table::new("plan", caption, &COLUMNS);
        for series in &self.series {
            table.push(Tone::Marked, row(series, "the project's", series.own()));
            for run in &series.runs {
                if let Some(varied) = run.varied {
                    table.push(Tone::Plain, row(series, varied.name(), run));
                }
            }
        }
        table
    }
}

fn row(series: &Series, varied: &'static str, run: &Run) -> Vec<Cell> {
    let Run {
        setting: Setting { cells, steps, sweeps }, seconds: [plan, fit], misplaced, gap, figures, ..
    } = run;
    vec![
        series.name().into(),
        varied.into(),
        (*cells).into(),
        f64::from(*steps).into(),
        f64::from(*sweeps).into(),
        (*plan).into(),
        (*fit).into(),
        (*misplaced).into(),
        (*gap).into(),
        figures.cracks.into(),
        figures.torn_source.max(figures.torn_target_late).into(),
        figures.bunch.into(),
        figures.fastest_999.into(),
    ]
}
