//! The stability table: stiff and extreme inputs in groups of [`rows`], each with the bound that it must hold. A bound is
//! stated before its row is run; a row that misses it is shown as missing.
//!
//! A value that the project format forbids has a row that must be refused with a clear message. Where the computation can
//! take the value all the same, another row runs it beneath the format.

mod case;
mod fit_case;
mod flow_case;
mod glass;
mod meeting_case;
mod picture_case;
mod rows;
mod scene_case;
mod table;

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::Instant;

pub use case::{Bound, EnergyOf, Limits, Measured};
pub use table::{Stability, StabilityRow};

use crate::effort::Effort;
use case::Case;
use lightloom_core::{Error, Progress, Result};
use rows::GROUPS;

/// Runs all rows. A row that fails or panics misses its bound; only cancelling stops the run.
///
/// # Errors
/// `Cancelled`.
pub fn stability(effort: Effort, progress: &Progress) -> Result<Stability> {
    let start = Instant::now();
    let all: Vec<_> = GROUPS
        .iter()
        .flat_map(|group| (group.rows)(effort).into_iter().map(|row| (group.name, row)))
        .collect();
    progress.set_stages(vec![("stability", effort.pick(40.0, 600.0))]);
    progress.begin("stability", all.len() as u64);
    let mut rows = Vec::new();
    for (group, row) in all {
        progress.check()?;
        rows.push(run(group, row.build(effort), &progress.inner())?);
        progress.advance(1);
    }
    Ok(Stability { rows, seconds: start.elapsed().as_secs_f64() })
}

fn run(group: &'static str, case: Case, progress: &Progress) -> Result<StabilityRow> {
    let start = Instant::now();
    // The case owns all that it leaves behind in a panic.
    let outcome = catch_unwind(AssertUnwindSafe(|| (case.run)(progress)))
        .unwrap_or_else(|cause| Err(Error::Numeric { stage: "panic", what: message_of(&*cause) }));
    let seconds = start.elapsed().as_secs_f64();
    let missed = case.bound.missed(&outcome)?;
    let note = match &outcome {
        Err(error) if missed.is_empty() => error.to_string(),
        _ => missed.join("; "),
    };
    let (within, measured) = (missed.is_empty(), outcome.ok());
    Ok(StabilityRow { group, case: case.name, bound: case.bound, measured, seconds, within, note })
}

fn message_of(cause: &(dyn Any + Send)) -> String {
    let text = cause.downcast_ref::<&str>().map(|text| (*text).to_owned());
    text.or_else(|| cause.downcast_ref::<String>().cloned()).unwrap_or_else(|| "without a word".to_owned())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use std::collections::HashSet;

    use super::*;

    fn row(run: impl Fn(&Progress) -> Result<Measured> + 'static) -> Result<StabilityRow> {
        super::run("group", Case::new("case", Bound::Holds(Limits::FINITE), run), &Progress::new())
    }

    #[test]
    fn the_table_has_140_rows_of_different_names_and_plain_text() {
        for effort in [Effort::Quick, Effort::Full] {
            let rows = GROUPS.iter().flat_map(|group| {
                (group.rows)(effort)
                    .into_iter()
                    .map(|row| (group.name, row.build(effort)))
                    .collect::<Vec<_>>()
            });
            let mut names = HashSet::new();
            for (group, Case { name, bound, .. }) in rows {
                let text = format!("{name}: {}", bound.to_text());
                assert!(!text.contains(['\\', '\n']) && !text.contains("  "), "{text:?}");
                assert!(names.insert((group, name)), "{text}");
            }
            assert_eq!(names.len(), 140);
        }
    }

    #[test]
    fn a_row_that_panics_or_fails_misses_and_tells_why() {
        let rows = [
            row(|_| panic!("lost in {} cells", 3)).unwrap(),
            row(|_| Err(Error::value("flow", "lost in 3 cells"))).unwrap(),
        ];
        assert!(rows.iter().all(|row| !row.within && row.note.contains("lost in 3 cells")), "{rows:?}");
        assert!(row(|_| Ok(Measured { finite: true, ..Measured::default() })).unwrap().within);
        assert!(!row(|_| Ok(Measured::default())).unwrap().within, "not finite");
        assert!(matches!(row(|_| Err(Error::Cancelled)), Err(Error::Cancelled)));
    }
}
