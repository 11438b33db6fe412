//! The speed of each stage over the limit of this machine.
//!
//! A limit counts the least work of a stage, bytes that must move and floating point operations that must be done, at the
//! bandwidth and the rate of fused multiply-adds that are measured in the same run on the same threads. Tracing is compared
//! with rays through the bare hierarchy.

use super::section_def::{SectionDef, nothing_moves};
use crate::content::{Section, Table, Tone};
use crate::context::{Context, Limit};
use crate::stages::{Bounded, STAGES};
use lightloom_core::{Progress, Result};

pub(super) const SECTION: SectionDef =
    SectionDef { name: "machine", skip: nothing_moves, measure, seconds: [6.0, 20.0] };

fn measure(context: &mut Context, progress: &Progress) -> Result<Section> {
    progress.begin("machine", STAGES.len() as u64);
    let machine = context.machine();
    let columns = ["stage", "items per second", "item", "limit per second", "ratio", "limited by", "counted"];
    let caption = format!(
        "Threads: {}. Bandwidth {:.1} GB/s (a[i] = b[i] + s c[i] over 3 x 64 MiB), {:.0} billion floating point operations \
         per second, two for each fused multiply-add.",
        rayon::current_num_threads(),
        1e-9 * machine.bytes_per_second,
        1e-9 * machine.operations_per_second
    );
    let mut table = Table::new("machine", caption, &columns);
    for stage in &STAGES {
        if let Some(Bounded { item, counted, size: [quick, full] }) = &stage.bounded
            && let Some(sample) = stage.sample(context, context.effort.pick(*quick, *full), progress)?
            && let Some(Limit { items, seconds: least, by }) = sample.limit
        {
            let [rate, most, ratio] =
                [items / sample.seconds, items / least, least / sample.seconds].map(Into::into);
            let cells =
                vec![stage.name.into(), rate, (*item).into(), most, ratio, by.into(), (*counted).into()];
            table.push(Tone::Plain, cells);
        }
        progress.advance(1);
    }
    let mut section = Section::new("machine", "How near to the machine's limits");
    section.text(
        "The limit counts only work that no program could avoid, as if everything in the caches were free: gathers, sorting, \
         and the latency of memory are not in it. A ratio of 1 cannot be reached.",
    );
    section.table(table);
    Ok(section)
}
