//! The chapter: what is said, drawn and listed of the flows that were measured.

use super::{Apart, Knob, Measured, Run, Setting, Why};
use crate::report::chapter::{Cell, Chapter, Part, Table, Tone, short};
use crate::report::pareto::{Offer, cheapest, front, is_worth_it};
use crate::report::plot::{Axis, Line, Panel, Plot, Style};
use crate::report::slope::slope;

/// Errors that a setting is named for, in the plane's longer side.
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
/// Colours of the settings in balance and of the front; the knobs have those before.
const BALANCED: usize = 4;
const FRONT: usize = 5;
/// Colour of the ring around the project's own setting.
const OWN: usize = 1;

impl Measured {
    pub(super) fn chapter(&self) -> Chapter {
        let mut chapter = Chapter::new("flow", "What exactness of the flow costs");
        chapter.say(self.how());
        chapter.parts.push(Part::Plot(self.front_plot()));
        chapter.say(self.own_in_words());
        chapter.parts.push(Part::Table(self.cheapest_table()));
        chapter.parts.push(Part::Plot(self.alone_plot()));
        chapter.say(self.alone_in_words());
        chapter.parts.push(Part::Table(self.alone_table()));
        chapter.parts.push(Part::Table(self.table()));
        chapter
    }

    fn how(&self) -> String {
        let turbulence = match &self.project.flow.turbulence {
            Some(turbulence) if turbulence.is_on() => "with the turbulence of the project",
            _ => "without turbulence",
        };
        let walls = if self.walls { ", around its walls" } else { "" };
        format!(
            "{} photons are carried along each flow, {turbulence}{walls}, and looked at when 1 to 9 tenths of the time are \
             over. The error is how far they are from where a reference takes them, in the plane's longer side. The \
             reference ({}) took {} s. One of half its steps and cells is {} from it (root mean square), so that by the \
             orders found below its own error is about {}: smaller ones tell nothing. Seconds are those of the whole fit of \
             one segment. The basis is not varied: cubic B-splines are the only one.",
            self.probes,
            self.reference.describe(),
            short(self.reference_seconds),
            short(self.doubt.rms),
            short(self.reference_error()),
        )
    }

    /// About how far the reference itself is from right. If errors fall like h^p, that of h is 1/(2^p - 1) of what it lies
    /// from 2 h; p is the least of the orders found, from 1 to 2.
    fn reference_error(&self) -> f64 {
        let orders = [Knob::Steps, Knob::Grid].map(|knob| self.order(knob).unwrap_or(1.0).clamp(1.0, 2.0));
        self.doubt.rms / (2_f64.powf(orders[0].min(orders[1])) - 1.0)
    }

    /// Whether the project's setting is worth its price, and what else is.
    fn own_in_words(&self) -> String {
        let (own, offers) = (self.own(), self.offers());
        let begin = format!(
            "The project's own setting ({}) takes {} s for an error of {}",
            own.setting.describe(),
            short(own.seconds),
            short(own.error.rms)
        );
        match cheapest(&offers, own.error.rms) {
            Some(row) if !is_worth_it(&offers, 0) => {
                let run = &self.runs[row];
                format!(
                    "{begin}. It is not on the front: {} takes {} s for {}, {:.0} % of the time.",
                    run.setting.describe(),
                    short(run.seconds),
                    short(run.error.rms),
                    100.0 * run.seconds / own.seconds
                )
            }
            _ => format!(
                "{begin}. It is on the front: nothing that was measured is both faster and more exact."
            ),
        }
    }

    fn front_plot(&self) -> Plot {
        let panel = |title: &str, of_all: bool, error: fn(&Apart) -> f64| {
            let of = |why: &dyn Fn(Why) -> bool| -> Vec<(f64, f64)> {
                let runs = self.runs.iter().filter(|run| why(run.why));
                runs.map(|run| (run.seconds, error(&run.error))).collect()
            };
            let offer = |run: &Run| Offer { price: run.seconds, error: error(&run.error) };
            let offers: Vec<Offer> = self.runs.iter().map(offer).collect();
            let best = front(&offers).into_iter().map(|row| (offers[row].price, offers[row].error));
            let mut lines = vec![Line::new("front", Style::Line(FRONT), best.collect())];
            if of_all {
                let ends = [f64::min, f64::max].map(|end| offers.iter().map(|o| o.price).reduce(end));
                let level = ends.into_iter().flatten().map(|seconds| (seconds, self.reference_error()));
                lines.push(Line::new("reference", Style::Law, level.collect()));
            }
            for (colour, knob) in Knob::ALL.into_iter().enumerate() {
                lines.push(Line::new(knob.name(), Style::Dots(colour), of(&|why| why == Why::Alone(knob))));
            }
            lines.push(Line::new("all in balance", Style::Dots(BALANCED), of(&|why| why == Why::Balanced)));
            lines.push(Line::new("the project's", Style::Rings(OWN), of(&|why| why == Why::Own)));
            Panel { title: title.to_owned(), x: Axis::log("seconds"), y: Axis::log("error (plane)"), lines }
        };
        Plot {
            name: "flow".to_owned(),
            title: format!("{}: error of the tracks over seconds", self.project.name),
            panels: vec![
                panel("root mean square", true, |apart| apart.rms),
                panel("one photon in a thousand", false, |apart| apart.high),
            ],
        }
    }

    fn alone_plot(&self) -> Plot {
        let panel = |(knob, rows): &(Knob, Vec<(usize, Apart)>)| {
            let point = |&(row, apart): &(usize, Apart)| (knob.of(&self.runs[row].setting), apart.rms);
            let points: Vec<_> = rows.iter().map(point).collect();
            let own = rows.iter().filter(|(row, _)| *row == 0).map(point).collect();
            let lines = vec![Line::new("", Style::Line(0), points), Line::new("", Style::Rings(OWN), own)];
            let title = knob.name().to_owned();
            let label = if *knob == Knob::Grid { "cells along the longer side" } else { knob.name() };
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

    /// Which knob causes most of the error, and whether that explains the whole.
    fn alone_in_words(&self) -> String {
        let own =
            |rows: &[(usize, Apart)]| rows.iter().find(|(row, _)| *row == 0).map_or(0.0, |(_, a)| a.rms);
        let mut causes: Vec<(Knob, f64)> = self.alone.iter().map(|(knob, rows)| (*knob, own(rows))).collect();
        causes.sort_by(|a, b| b.1.total_cmp(&a.1));
        let list: Vec<_> =
            causes.iter().map(|(knob, rms)| format!("{} {}", knob.name(), short(*rms))).collect();
        let together = causes.iter().map(|(_, rms)| rms * rms).sum::<f64>().sqrt();
        format!(
            "Here one setting is turned and all others stay the project's; the error is the distance from the same with that \
             setting as the reference has it. At the project's own values: {}; as independent errors {} in all, measured {}. \
             {}",
            list.join(", "),
            short(together),
            short(self.own().error.rms),
            self.orders_in_words()
        )
    }

    fn orders_in_words(&self) -> String {
        let order = |(knob, name)| self.order(knob).map(|order| format!("{order:.1} in {name}"));
        let orders: Vec<_> =
            [(Knob::Steps, "steps"), (Knob::Grid, "cells")].into_iter().filter_map(order).collect();
        match orders.is_empty() {
            true => String::new(),
            false => format!("Orders of convergence: {}.", orders.join(", ")),
        }
    }

    /// By which power of its value the error of a knob falls.
    fn order(&self, knob: Knob) -> Option<f64> {
        let (_, rows) = self.alone.iter().find(|(other, _)| *other == knob)?;
        // The finest is what they are compared with, and the one before is already near it.
        let kept = &rows[..rows.len().saturating_sub(2)];
        let points = kept.iter().map(|&(row, apart)| (knob.of(&self.runs[row].setting), apart.rms));
        slope(&points.collect::<Vec<_>>()).map(|slope| -slope)
    }

    fn cheapest_table(&self) -> Table {
        let caption = "The cheapest setting that was measured for an error (root mean square).";
        let columns = ["error (plane)", "setting", "seconds", "rms (plane)"];
        let mut table = Table::new("flow_cheapest", caption, &columns);
        let (own, offers) = (self.own(), self.offers());
        let named = NAMED.into_iter().map(|error| (Cell::from(error), error));
        for (name, error) in named.chain([("that of the project".into(), own.error.rms)]) {
            let found = cheapest(&offers, error).map(|row| &self.runs[row]);
            let setting = found.map_or("none measured reaches it".to_owned(), |run| run.setting.describe());
            let numbers = [found.map(|run| run.seconds).into(), found.map(|run| run.error.rms).into()];
            table.push(Tone::Plain, [name, setting.into()].into_iter().chain(numbers).collect());
        }
        table
    }

    fn alone_table(&self) -> Table {
        let caption = "The error that each setting causes alone.";
        let columns = ["setting", "value", "seconds", "rms (plane)", "99.9 % (plane)"];
        let mut table = Table::new("flow_alone", caption, &columns);
        for (knob, rows) in &self.alone {
            for (row, apart) in rows {
                let run = &self.runs[*row];
                let value = match knob {
                    Knob::Tolerance => format!("{:e}", run.setting.tolerance).into(),
                    _ => knob.of(&run.setting).into(),
                };
                let tone = if *row == 0 { Tone::Marked } else { Tone::Plain };
                table.push(
                    tone,
                    vec![knob.name().into(), value, run.seconds.into(), apart.rms.into(), apart.high.into()],
                );
            }
        }
        table
    }

    fn table(&self) -> Table {
        let caption = "All settings that were measured, the cheapest first.";
        let columns: Vec<_> = COLUMNS.into_iter().chain(["on the front"]).collect();
        let mut table = Table::new("flow", caption, &columns);
        let best = front(&self.offers());
        let mut rows: Vec<usize> = (0..self.runs.len()).collect();
        rows.sort_by(|&a, &b| self.runs[a].seconds.total_cmp(&self.runs[b].seconds));
        for row in rows {
            let Run { setting, why, seconds, error, .. } = &self.runs[row];
            let Setting { steps, cells: [x, y], guides, tolerance } = *setting;
            let (name, tone) = match why {
                Why::Own => ("the project's", Tone::Marked),
                Why::Alone(knob) => (knob.name(), Tone::Plain),
                Why::Balanced => ("all in balance", Tone::Plain),
            };
            let [steps, guides] = [steps, guides].map(|count| Cell::from(f64::from(count)));
            let kept = if best.contains(&row) { "yes" } else { "no" };
            let mut cells = vec![name.into(), steps, format!("{x} x {y}").into(), guides];
            cells.push(format!("{tolerance:e}").into());
            cells.extend([*seconds, error.rms, error.high, error.most].map(Cell::from));
            cells.push(kept.into());
            table.push(tone, cells);
        }
        table
    }
}
