//! The plots of the section.

use super::probes::TrackError;
use super::setting::Parameter;
use super::trial::{Measured, Run, Variation};
use crate::pareto::{Candidate, front};
use crate::plot::{Axis, Line, Panel, Plot, Style};

/// Colours of the balanced settings and of the front; the parameters have the colours before.
const BALANCED: usize = 4;
const FRONT: usize = 5;
/// Colour of the ring around the project's own setting.
const OWN: usize = 1;

impl Measured {
    fn front_panel(&self, title: &str, of_all: bool, error: fn(&TrackError) -> f64) -> Panel {
        let of = |why: &dyn Fn(Variation) -> bool| -> Vec<(f64, f64)> {
            let runs = self.runs.iter().filter(|run| why(run.why));
            runs.map(|run| (run.seconds, error(&run.error))).collect()
        };
        let candidate = |run: &Run| Candidate { price: run.seconds, error: error(&run.error) };
        let candidates: Vec<Candidate> = self.runs.iter().map(candidate).collect();
        let best = front(&candidates).into_iter().map(|row| (candidates[row].price, candidates[row].error));
        let mut lines = vec![Line::new("front", Style::Line(FRONT), best.collect())];
        if of_all {
            let ends = [f64::min, f64::max].map(|end| candidates.iter().map(|o| o.price).reduce(end));
            let level = ends.into_iter().flatten().map(|seconds| (seconds, self.reference_error()));
            lines.push(Line::new("reference", Style::Law, level.collect()));
        }
        for (colour, parameter) in Parameter::ALL.into_iter().enumerate() {
            lines.push(Line::new(
                parameter.name(),
                Style::Dots(colour),
                of(&|why| why == Variation::Alone(parameter)),
            ));
        }
        lines.push(Line::new("all in balance", Style::Dots(BALANCED), of(&|why| why == Variation::Balanced)));
        lines.push(Line::new("the project's", Style::Rings(OWN), of(&|why| why == Variation::Own)));
        if !of_all {
            // They have their names in the panel before.
            lines.iter_mut().for_each(|line| line.label.clear());
        }
        Panel { title: title.to_owned(), x: Axis::log("seconds"), y: Axis::log("error (plane)"), lines }
    }

    /// Errors over seconds, of all photons and of the worst.
    pub(super) fn front_plot(&self) -> Plot {
        Plot {
            name: "flow".to_owned(),
            title: format!("{}: error of the tracks over seconds", self.project.name),
            panels: vec![
                self.front_panel("root mean square", true, |error| error.rms),
                self.front_panel("one photon in a thousand", false, |error| error.high),
            ],
        }
    }

    /// The error that each parameter causes, over its values.
    pub(super) fn alone_plot(&self) -> Plot {
        let panel = |(parameter, rows): &(Parameter, Vec<(usize, TrackError)>)| {
            let point =
                |&(row, error): &(usize, TrackError)| (parameter.of(&self.runs[row].setting), error.rms);
            let points: Vec<_> = rows.iter().map(point).collect();
            let own = rows.iter().filter(|(row, _)| *row == 0).map(point).collect();
            let lines = vec![Line::new("", Style::Line(0), points), Line::new("", Style::Rings(OWN), own)];
            let title = parameter.name().to_owned();
            let label =
                if *parameter == Parameter::Grid { "cells along the longer side" } else { parameter.name() };
            Panel { title, x: Axis::log(label), y: Axis::log("error (plane)"), lines }
        };
        Plot {
            name: "flow_alone".to_owned(),
            title: format!(
                "{}: error that each setting causes alone (ring: the project's)",
                self.project.name
            ),
            panels: self.alone.iter().map(panel).collect(),
        }
    }
}
