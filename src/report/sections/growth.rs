//! How the seconds of each stage grow with its size.

use super::section_def::{SectionDef, nothing_moves};
use crate::content::{Cell, Section, Table, Tone};
use crate::context::{Context, Sample};
use crate::plot::{Axis, Line, Panel, Plot, Style};
use crate::slope::slope;
use crate::stages::{STAGES, Stage};
use lightloom_core::{Progress, Result};

pub(super) const SECTION: SectionDef =
    SectionDef { name: "growth", skip: nothing_moves, measure, seconds: [15.0, 240.0] };

/// A stage with its samples in the order of their sizes.
struct Series {
    stage: &'static Stage,
    samples: Vec<Sample>,
}

fn measure(context: &mut Context, progress: &Progress) -> Result<Section> {
    const ALL: &[Stage] = &STAGES;
    let sizes =
        |stage: &'static Stage| (stage.sizes)(context.effort).into_iter().map(move |size| (stage, size));
    let mut runs: Vec<(&Stage, usize)> = ALL.iter().flat_map(sizes).collect();
    // All stages at one number of photons in a row: the photons are traced and matched once.
    runs.sort_by_key(|(stage, size)| if stage.unit == "photons" { *size } else { usize::MAX });
    progress.begin("growth", runs.len() as u64);
    let mut all: Vec<Series> = ALL.iter().map(|stage| Series { stage, samples: Vec::new() }).collect();
    for (stage, size) in runs {
        let sample = stage.sample(context, size, progress)?;
        let series = all.iter_mut().find(|series| series.stage.name == stage.name);
        series.into_iter().for_each(|series| series.samples.extend(sample));
        progress.advance(1);
    }
    all.retain(|series| !series.samples.is_empty());
    let mut section = Section::new("growth", "How the seconds grow");
    section.text(
        "Each stage alone at rising size, with the photons of the project's first move. The exponent is that of a \
         power law fitted to all sizes; the last one is that between the two largest, where what is spent once no longer \
         counts. A stage that scales well has an exponent of 1; the bound allows for the caches.",
    );
    let panels = all.iter().map(Series::panel).collect();
    section.plot(Plot { name: "growth".to_owned(), title: "Seconds over size".to_owned(), panels });
    section.table(exponents(&all));
    section.table(samples(&all));
    Ok(section)
}

impl Series {
    fn points(&self) -> Vec<(f64, f64)> {
        self.samples.iter().map(|sample| (sample.size, sample.seconds)).collect()
    }

    fn panel(&self) -> Panel {
        let Self { stage: Stage { name, unit, exponent, is_power_law: log, .. }, .. } = self;
        let points = self.points();
        let mut lines = vec![Line::new("", Style::Line(0), points.clone())];
        if let Some(((size, seconds), exponent)) = points.last().zip(*exponent) {
            let law = points.iter().map(|(x, _)| (*x, seconds * (x / size).powf(exponent))).collect();
            lines.insert(0, Line::new(format!("{unit} ^ {exponent}"), Style::Law, law));
        }
        let axis = |label: &str| Axis { label: label.to_owned(), log: *log };
        Panel { title: (*name).to_owned(), x: axis(unit), y: axis("seconds"), lines }
    }
}

/// The power laws, each against its bound.
fn exponents(all: &[Series]) -> Table {
    let columns = ["stage", "over", "exponent", "last exponent", "bound", "verdict"];
    let mut table = Table::new("growth_exponents", "Exponents of the growth.", &columns);
    for series in all.iter().filter(|series| series.stage.is_power_law && series.samples.len() > 1) {
        let (stage, points) = (series.stage, series.points());
        let (all, last) = (slope(&points), slope(&points[points.len() - 2..]));
        let holds = all.zip(stage.exponent).map(|(exponent, bound)| exponent <= bound);
        let (tone, verdict) = match holds {
            Some(false) => (Tone::Bad, "missed".into()),
            Some(true) => (Tone::Plain, "held".into()),
            None => (Tone::Plain, Cell::Nothing),
        };
        let numbers = [all, last, stage.exponent].map(Cell::from);
        let names = [stage.name.into(), stage.unit.into()];
        table.push(tone, names.into_iter().chain(numbers).chain([verdict]).collect());
    }
    table
}

/// All samples.
fn samples(all: &[Series]) -> Table {
    let columns =
        ["stage", "over", "size", "seconds", "exponent", "limit (s)", "limited by", "peak memory (MiB)"];
    let caption = "Every size that was measured, with the exponent since the size before, and the least seconds that this \
                   machine could take.";
    let mut table = Table::new("growth", caption, &columns);
    for Series { stage, samples } in all {
        let mut before: Option<&Sample> = None;
        for sample in samples {
            let since = before.filter(|_| stage.is_power_law);
            let exponent =
                since.and_then(|since| slope(&[since, sample].map(|sample| (sample.size, sample.seconds))));
            let (least, by) = sample.limit.map(|limit| (limit.seconds, limit.by)).unzip();
            let cells = vec![
                stage.name.into(),
                stage.unit.into(),
                sample.size.into(),
                sample.seconds.into(),
                exponent.into(),
                least.into(),
                by.into(),
                sample.memory.into(),
            ];
            table.push(Tone::Plain, cells);
            before = Some(sample);
        }
    }
    table
}
