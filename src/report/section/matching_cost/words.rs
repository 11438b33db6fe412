//! The chapter: what is said, drawn and listed of the pairings that were measured.

use super::{Matched, Measured, Way};
use crate::chapter::{Cell, Chapter, Part, Table, Tone, short};
use crate::pareto::{Offer, cheapest, front, is_worth_it};
use crate::plot::{Axis, Line, Panel, Plot, Style};

/// Colour of the ring around the project's own way.
const OWN: usize = 1;

impl Measured {
    pub(super) fn chapter(&self) -> Chapter {
        let mut chapter = Chapter::new("matching", "What a good pairing costs");
        chapter.say(self.how());
        if self.bound > 0.0 {
            chapter.say(self.own_in_words());
            chapter.parts.push(Part::Plot(self.plot()));
        } else {
            chapter.say("No bound above zero was found: the points hardly move, and there is nothing to compare with.");
        }
        chapter.parts.push(Part::Table(self.table()));
        chapter
    }

    fn how(&self) -> String {
        let walls = match self.walls {
            true => {
                " Lengths are those of the ways around the walls, but the bound is that of straight ways: no more than a bound, \
                 which nothing need come near."
            }
            false => "",
        };
        format!(
            "{} photons of the first move are paired with their points at the next key. The cost is the mean squared length \
             of their ways, over the best lower bound of it that the dual of transport gave: 1 is the optimum, and no \
             pairing is below.{walls} Seconds are those of the map, which all passes share, and of one bijection; the map's \
             lattice, its iterations and the sweeps after it are varied one by one. The bijection cuts both sets into equal \
             halves once; the swaps of its sweeps do what merging several such cuts would. The linear method pairs as \
             transport along straight ways does.",
            self.count
        )
    }

    fn own_in_words(&self) -> String {
        let (own, offers) = (&self.rows[0], self.offers());
        let begin = format!(
            "The project's own way ({}) takes {} s for {:.2} % over the bound",
            own.in_words(),
            short(own.seconds()),
            100.0 * self.over(own)
        );
        match cheapest(&offers, offers[0].error) {
            Some(row) if !is_worth_it(&offers, 0) => {
                let other = &self.rows[row];
                format!(
                    "{begin}. It is not on the front: {} takes {} s for {:.2} %.",
                    other.in_words(),
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

    fn offers(&self) -> Vec<Offer> {
        self.rows.iter().map(|row| Offer { price: row.seconds(), error: self.over(row) }).collect()
    }

    fn plot(&self) -> Plot {
        let offers = self.offers();
        let point = |row: usize| (offers[row].price, offers[row].error);
        let of = |is: fn(&Way) -> bool| {
            (0..self.rows.len()).filter(|&row| is(&self.rows[row].way)).map(point).collect::<Vec<_>>()
        };
        let lines = vec![
            Line::new("front", Style::Line(5), front(&offers).into_iter().map(point).collect()),
            Line::new("lattice", Style::Dots(0), of(|way| matches!(way, Way::Lattice(_)))),
            Line::new("iterations", Style::Dots(1), of(|way| matches!(way, Way::Iterations(_)))),
            Line::new("sweeps", Style::Dots(2), of(|way| matches!(way, Way::Sweeps(_)))),
            Line::new("no map, sweeps", Style::Dots(3), of(|way| matches!(way, Way::Halves(_)))),
            Line::new("transport", Style::Dots(5), of(|way| matches!(way, Way::Straight | Way::Around))),
            Line::new("stylized", Style::Dots(4), of(|way| *way == Way::Stylized)),
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
        let caption = "All ways to pair that were measured, the cheapest first.";
        let columns =
            ["way", "value", "map (s)", "bijection (s)", "seconds", "cost over the bound", "on the front"];
        let mut table = Table::new("matching", caption, &columns);
        let best = front(&self.offers());
        let mut rows: Vec<usize> = (0..self.rows.len()).collect();
        rows.sort_by(|&a, &b| self.rows[a].seconds().total_cmp(&self.rows[b].seconds()));
        for row in rows {
            let matched = &self.rows[row];
            let (name, value) = matched.way.describe();
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

    fn in_words(&self) -> String {
        match self.way.describe() {
            (name, Some(value)) => format!("{name} {value}"),
            (name, None) => name.to_owned(),
        }
    }
}
