//! The chapter, and what is said in it of the flows that were measured.

use super::{Apart, Knob, Measured};
use crate::chapter::{Chapter, Part, short};
use crate::pareto::{cheapest, is_worth_it};
use crate::slope::slope;

/// An error that is larger by no more than this is the same to an eye.
pub(super) const SAME: f64 = 1.05;

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
            short(self.doubt.rms),
            short(self.reference_error()),
        )
    }

    /// About how far the reference itself is from right. If errors fall like h^p, that of h is 1/(2^p - 1) of what it lies
    /// from 2 h; p is the least of the orders found, from 1 to 2.
    pub(super) fn reference_error(&self) -> f64 {
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
        let kept = if is_worth_it(&offers, 0) { "on the front" } else { "not on the front" };
        let cheaper = match cheapest(&offers, SAME * own.error.rms) {
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

    /// By which power of its value the error of a knob falls, between the two finest values that are coarse beside the
    /// finest of all, from which the error is measured.
    fn order(&self, knob: Knob) -> Option<f64> {
        let (_, rows) = self.alone.iter().find(|(other, _)| *other == knob)?;
        let point = |&(row, apart): &(usize, Apart)| (knob.of(&self.runs[row].setting), apart.rms);
        let points: Vec<(f64, f64)> = rows.iter().map(point).collect();
        let (finest, _) = *points.last()?;
        let coarse = points.iter().filter(|(value, _)| 2.0 * value <= finest).count();
        slope(&points[coarse.checked_sub(2)?..coarse]).map(|slope| -slope)
    }
}
