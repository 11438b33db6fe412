//! The section: its text, plot and table.

use super::variants::{Matched, Variant};
use crate::content::{Cell, Section, Table, Tone};
use crate::number::short;
use crate::pareto::{Candidate, cheapest, front, is_on_front};
use crate::plot::{Axis, Line, Panel, Plot, Style};

/// Colour of the ring around the project's own pairing.
const OWN: usize = 1;

/// The measurements of the section.
pub(super) struct Measured {
    pub(super) project: String,
    /// Number of points.
    pub(super) count: usize,
    /// The project's own pairing first.
    pub(super) rows: Vec<Matched>,
    /// A lower bound of the mean squared distance along straight lines.
    pub(super) bound: f64,
    pub(super) walls: bool,
}

impl Measured {
    pub(super) fn section(&self) -> Section {
        let mut section = Section::new("matching", "What a good pairing costs");
        section.text(self.method());
        if self.bound > 0.0 {
            section.text(self.own_text());
            section.plot(self.plot());
        } else {
            section.text("No bound above zero was found: the points hardly move, and there is nothing to compare with.");
        }
        section.table(self.table());
        section
    }

    fn method(&self) -> String {
        let walls = match self.walls {
            true => {
                " Lengths are those of the paths around the walls, but the bound is that of straight paths: no more than a bound, \
                 which nothing need come near."
            }
            false => "",
        };
        format!(
            "{} photons of the first move are paired with their points at the next key. The cost is the mean squared length \
             of their paths, over the best lower bound of it that the dual of transport gave: 1 is the optimum, and no \
             pairing is below.{walls} Seconds are those of the map, which all passes share, and of one bijection; the map's \
             lattice, its iterations and the sweeps after it are varied one by one. The bijection cuts both sets into equal \
             halves once; the swaps of its sweeps do what merging several such cuts would. The linear method pairs as \
             transport along straight paths does.",
            self.count
        )
    }

    fn own_text(&self) -> String {
        let (own, candidates) = (&self.rows[0], self.candidates());
        let begin = format!(
            "The project's own pairing ({}) takes {} s for {:.2} % over the bound",
            own.describe(),
            short(own.seconds()),
            100.0 * self.over(own)
        );
        match cheapest(&candidates, candidates[0].error) {
            Some(row) if !is_on_front(&candidates, 0) => {
                let other = &self.rows[row];
                format!(
                    "{begin}. It is not on the front: {} takes {} s for {:.2} %.",
                    other.describe(),
                    short(other.seconds()),
                    100.0 * self.over(other)
                )
            }
            _ => format!("{begin}. It is on the front: nothing that was measured is both faster and nearer."),
        }
    }

    /// The cost over the bound, less 1.
    fn over(&self, row: &Matched) -> f64 {
        row.cost / self.bound - 1.0
    }

    fn candidates(&self) -> Vec<Candidate> {
        self.rows.iter().map(|row| Candidate { price: row.seconds(), error: self.over(row) }).collect()
    }

    fn plot(&self) -> Plot {
        let candidates = self.candidates();
        let point = |row: usize| (candidates[row].price, candidates[row].error);
        let of = |is: fn(&Variant) -> bool| {
            (0..self.rows.len()).filter(|&row| is(&self.rows[row].variant)).map(point).collect::<Vec<_>>()
        };
        let lines = vec![
            Line::new("front", Style::Line(5), front(&candidates).into_iter().map(point).collect()),
            Line::new("lattice", Style::Dots(0), of(|variant| matches!(variant, Variant::Lattice(_)))),
            Line::new("iterations", Style::Dots(1), of(|variant| matches!(variant, Variant::Iterations(_)))),
            Line::new("sweeps", Style::Dots(2), of(|variant| matches!(variant, Variant::Sweeps(_)))),
            Line::new("no map, sweeps", Style::Dots(3), of(|variant| matches!(variant, Variant::Halves(_)))),
            Line::new(
                "transport",
                Style::Dots(5),
                of(|variant| matches!(variant, Variant::Straight | Variant::Around)),
            ),
            Line::new("stylized", Style::Dots(4), of(|variant| *variant == Variant::Stylized)),
            Line::new("the project's", Style::Rings(OWN), vec![point(0)]),
        ];
        let (x, y) = (Axis::log("seconds"), Axis::log("cost over the bound, less 1"));
        Plot {
            name: "matching".to_owned(),
            title: format!("{}: transport cost over seconds", self.project),
            panels: vec![Panel { title: format!("{} points", self.count), x, y, lines }],
        }
    }

    fn table(&self) -> Table {
        let caption = "All pairings that were measured, the cheapest first.";
        let columns = [
            "pairing",
            "value",
            "map (s)",
            "bijection (s)",
            "seconds",
            "cost over the bound",
            "on the front",
        ];
        let mut table = Table::new("matching", caption, &columns);
        let best = front(&self.candidates());
        let mut rows: Vec<usize> = (0..self.rows.len()).collect();
        rows.sort_by(|&a, &b| self.rows[a].seconds().total_cmp(&self.rows[b].seconds()));
        for row in rows {
            let matched = &self.rows[row];
            let (name, value) = matched.variant.describe();
            let ratio = (self.bound > 0.0).then(|| matched.cost / self.bound);
            let tone = if row == 0 { Tone::Marked } else { Tone::Plain };
            let numbers = [matched.map_seconds, matched.pair_seconds, matched.seconds()].map(Cell::from);
            let mut cells = vec![name.into(), value.into()];
            cells.extend(numbers);
            cells.extend([ratio.into(), if best.contains(&row) { "yes" } else { "no" }.into()]);
            table.push(tone, cells);
        }
        table
    }
}

impl Matched {
    fn seconds(&self) -> f64 {
        self.map_seconds + self.pair_seconds
    }

    fn describe(&self) -> String {
        match self.variant.describe() {
            (name, Some(value)) => format!("{name} {value}"),
            (name, None) => name.to_owned(),
        }
    }
}
