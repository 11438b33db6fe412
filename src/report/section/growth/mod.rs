//! How the seconds of each stage grow with its size.

mod series;

use super::super::chapter::{Cell, Chapter, Part, Table, Tone};
use super::super::plot::{Axis, Line, Panel, Plot, Style};
use super::super::slope::slope;
use super::super::workbench::Workbench;
use super::{Section, nothing_moves};
use lightloom_core::{Progress, Result};
use series::{SERIES, Series};

pub(crate) const SECTION: Section =
    Section { name: "growth", needless: nothing_moves, measure, seconds: [15.0, 240.0] };

/// What one size took.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Point {
    /// Photons, unknowns, passes, walls or threads.
    size: f64,
    seconds: f64,
    /// Most memory held, MiB, where it is of interest.
    memory: Option<f64>,
}

fn measure(bench: &mut Workbench, progress: &Progress) -> Result<Chapter> {
    progress.begin("growth", SERIES.len() as u64);
    let mut measured = Vec::new();
    for series in &SERIES {
        measured.push((series, (series.run)(bench, progress)?));
        progress.advance(1);
    }
    measured.retain(|(_, points)| !points.is_empty());
    let mut chapter = Chapter::new("growth", "How the seconds grow");
    chapter.say(
        "Each stage alone at rising size, with the photons of the project's first move. The exponent is that of a \
         power law fitted to all sizes; the last one is that between the two largest, where what is spent once no longer \
         counts. A stage that scales well has an exponent of 1; the bound allows for the caches.",
    );
    chapter.parts.push(Part::Plot(plot(&measured)));
    chapter.parts.push(Part::Table(exponents(&measured)));
    chapter.parts.push(Part::Table(points(&measured)));
    Ok(chapter)
}

type Measured = (&'static Series, Vec<Point>);

fn plot(measured: &[Measured]) -> Plot {
    let panel = |(series, points): &Measured| {
        let mut lines =
            vec![Line::new("", Style::Line(0), points.iter().map(|p| (p.size, p.seconds)).collect())];
        if let Some((last, exponent)) = points.last().zip(series.bound) {
            let along = |point: &Point| (point.size, last.seconds * (point.size / last.size).powf(exponent));
            let law = points.iter().map(along).collect();
            lines.insert(0, Line::new(format!("{} ^ {exponent}", series.size), Style::Law, law));
        }
        Panel {
            title: series.name.to_owned(),
            x: Axis { label: series.size.to_owned(), log: series.log },
            y: Axis { label: "seconds".to_owned(), log: series.log },
            lines,
        }
    };
    Plot {
        name: "growth".to_owned(),
        title: "Seconds over size".to_owned(),
        panels: measured.iter().map(panel).collect(),
    }
}

/// The power laws, each against its bound.
fn exponents(measured: &[Measured]) -> Table {
    let columns = ["stage", "over", "exponent", "last exponent", "bound", "verdict"];
    let mut table = Table::new("growth_exponents", "Exponents of the growth.", &columns);
    for (series, points) in measured.iter().filter(|(series, points)| series.log && points.len() > 1) {
        let places: Vec<(f64, f64)> = points.iter().map(|point| (point.size, point.seconds)).collect();
        let (all, last) = (slope(&places), slope(&places[places.len() - 2..]));
        let holds = all.zip(series.bound).map(|(exponent, bound)| exponent <= bound);
        let (tone, verdict) = match holds {
            Some(false) => (Tone::Bad, "missed".into()),
            Some(true) => (Tone::Plain, "held".into()),
            None => (Tone::Plain, Cell::Nothing),
        };
        let numbers = [all.into(), last.into(), series.bound.into()];
        table.push(
            tone,
            [series.name.into(), series.size.into()].into_iter().chain(numbers).chain([verdict]).collect(),
        );
    }
    table
}

fn points(measured: &[Measured]) -> Table {
    let columns = ["stage", "over", "size", "seconds", "peak memory (MiB)"];
    let mut table = Table::new("growth", "Every size that was measured.", &columns);
    for (series, points) in measured {
        for Point { size, seconds, memory } in points {
            let cells = vec![
                series.name.into(),
                series.size.into(),
                (*size).into(),
                (*seconds).into(),
                (*memory).into(),
            ];
            table.push(Tone::Plain, cells);
        }
    }
    table
}
