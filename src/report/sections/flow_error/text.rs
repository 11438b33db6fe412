//! The section and its text.

use super::probes::TrackError;
use super::setting::Parameter;
use super::trial::{Measured, SAME};
use crate::content::Section;
use crate::number::short;
use crate::pareto::{cheapest, is_on_front};

impl Measured {
    pub(super) fn section(&self) -> Section {
        let mut section = Section::new("flow", "What exactness of the flow costs");
        section.text(self.method());
        section.plot(self.front_plot());
        section.text(self.own_text());
        section.table(self.cheapest_table());
        section.plot(self.alone_plot());
        section.text(self.alone_text());
        section.table(self.alone_table());
        section.table(self.table());
        section
    }

    fn method(&self) -> String {
        let turbulence = match &self.project.flow.turbulence {
            Some(turbulence) if turbulence.is_on() => "with the turbulence of the project",
            _ => "without turbulence",
        };
        let (own, wished) = (self.own().setting.guides, self.project.flow.guides);
        let fewer = match own < wished {
            true => format!(" Of the {wished} guide photons of the project {own} are taken."),
            false => String::new(),
        };
        let walls = if self.walls { ", around its walls" } else { "" };
        format!(
            "{} photons are carried along each flow, {turbulence}{walls}, and looked at when 1 to 9 tenths of the time are \
             over. The error is how far they are from where a reference takes them, in the plane's longer side. The \
             reference ({}) took {} s. One of half its steps and cells is {} from it (root mean square), so that by the \
             orders found below its own error is about {}: smaller ones tell nothing. Seconds are those of the whole fit of \
             one segment.{fewer} The basis is not varied: cubic B-splines are the only one.",
            self.probes,
            self.reference.describe(),
            short(self.reference_seconds),
            short(self.uncertainty.rms),
            short(self.reference_error()),
        )
    }

    /// The project's setting against the Pareto front.
    fn own_text(&self) -> String {
        let (own, candidates) = (self.own(), self.candidates());
        let begin = format!(
            "The project's own setting ({}) takes {} s for an error of {}",
            own.setting.describe(),
            short(own.seconds),
            short(own.error.rms)
        );
        let kept = if is_on_front(&candidates, 0) { "on the front" } else { "not on the front" };
        let cheaper = match cheapest(&candidates, SAME * own.error.rms) {
            None | Some(0) => "nothing that was measured is as exact for less".to_owned(),
            Some(row) => {
                let run = &self.runs[row];
                format!(
                    "{} takes {:.0} % of the time for {}",
                    run.setting.describe(),
                    100.0 * run.seconds / own.seconds,
                    short(run.error.rms)
                )
            }
        };
        format!("{begin}. It is {kept}; {cheaper}.")
    }

    /// The error that each parameter causes, and their sum against the whole error.
    fn alone_text(&self) -> String {
        let own =
            |rows: &[(usize, TrackError)]| rows.iter().find(|(row, _)| *row == 0).map_or(0.0, |(_, a)| a.rms);
        let mut causes: Vec<(Parameter, f64)> =
            self.alone.iter().map(|(parameter, rows)| (*parameter, own(rows))).collect();
        causes.sort_by(|a, b| b.1.total_cmp(&a.1));
        let list: Vec<_> =
            causes.iter().map(|(parameter, rms)| format!("{} {}", parameter.name(), short(*rms))).collect();
        let together = causes.iter().map(|(_, rms)| rms * rms).sum::<f64>().sqrt();
        format!(
            "Here one setting is turned and all others stay the project's; the error is the distance from the same with that \
             setting as the reference has it. At the project's own values: {}; as independent errors {} in all, measured {}. \
             {}",
            list.join(", "),
            short(together),
            short(self.own().error.rms),
            self.orders_text()
        )
    }

    fn orders_text(&self) -> String {
        let order = |(parameter, name)| self.order(parameter).map(|order| format!("{order:.1} in {name}"));
        let orders: Vec<_> =
            [(Parameter::Steps, "steps"), (Parameter::Grid, "cells")].into_iter().filter_map(order).collect();
        match orders.is_empty() {
            true => String::new(),
            false => format!("Orders of convergence: {}.", orders.join(", ")),
        }
    }
}
