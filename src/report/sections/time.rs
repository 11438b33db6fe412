//! The seconds of each stage in a render of the project.

use super::section_def::SectionDef;
use crate::content::{Cell, Section, Table, Tone};
use crate::context::Context;
use lightloom_core::engine::StageCost;
use lightloom_core::project::Project;
use lightloom_core::{Progress, Result};

pub(super) const SECTION: SectionDef =
    SectionDef { name: "time", skip: |_: &Project| None, measure, seconds: [15.0, 240.0] };

fn measure(context: &mut Context, progress: &Progress) -> Result<Section> {
    progress.begin("time", 1);
    let summary = context.render(&context.project, progress)?;
    progress.advance(1);
    let mut section = Section::new("time", "Where the time goes");
    section.text(format!(
        "{} frames of {} x {}, {} passes of {} photons. Steps: 1 traces photons, 2 blends them (matching and fit), 3 \
         renders the frames. The stage \"render\" traces, matches and carries the photons of all passes, too.",
        summary.frames, context.project.render.width, context.project.render.height, summary.passes, summary.photons
    ));
    section.table(table(&summary.stages));
    Ok(section)
}

fn table(stages: &[StageCost]) -> Table {
    let columns =
        ["stage", "step", "seconds", "share (%)", "processor seconds", "cores busy", "peak memory (MiB)"];
    let caption =
        "Wall-clock seconds, processor seconds of all threads, and the most memory held, per stage.";
    let mut table = Table::new("time", caption, &columns);
    let whole: f64 = stages.iter().map(|stage| stage.seconds).sum();
    for stage in stages {
        table.push(Tone::Plain, row(stage.stage.into(), step(stage.stage).into(), stage, whole));
    }
    let all = StageCost {
        stage: "all",
        seconds: whole,
        cpu_seconds: stages.iter().map(|stage| stage.cpu_seconds).sum(),
        peak_memory_mib: stages.iter().filter_map(|stage| stage.peak_memory_mib).reduce(f64::max),
    };
    table.push(Tone::Marked, row(all.stage.into(), Cell::Nothing, &all, whole));
    table
}

fn row(name: Cell, step: Cell, cost: &StageCost, whole: f64) -> Vec<Cell> {
    let busy = cost.cpu_seconds.map(|cpu| cpu / cost.seconds.max(1e-9));
    let share = 100.0 * cost.seconds / whole.max(1e-9);
    vec![
        name,
        step,
        cost.seconds.into(),
        share.into(),
        cost.cpu_seconds.into(),
        busy.into(),
        cost.peak_memory_mib.into(),
    ]
}

/// Which step of the method a stage belongs to.
fn step(stage: &str) -> Option<&'static str> {
    match stage {
        "trace" => Some("1"),
        "plan" | "fit" | "match" => Some("2"),
        "visible" | "background" | "still" | "render" | "write" => Some("3"),
        _ => None,
    }
}
