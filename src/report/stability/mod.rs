//! The stiff and the extreme: does the program hold where it is hardest? Rows in groups ([`group`], one file each); each
//! row states its bound before it is run, and one that misses is shown as missing.
//!
//! Where the project format forbids a value, a row asks that it be refused with a clear message, and where the stage below
//! can take it all the same, another row runs that.

mod case;
mod group;
mod light;
mod solid;
mod table;
mod walk;

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::Instant;

use serde::Serialize;

pub use case::{Bound, EnergyOf, Limits, Measured};

use case::Case;
use group::GROUPS;
use lightloom_core::{Error, Progress, Result};

/// How large the inputs are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Size {
    /// Fewer photons, steps and cells, all rows: within a minute.
    Reduced,
    /// As a final render has them; minutes.
    Full,
}

impl Size {
    /// The first for reduced, the second for full size.
    fn pick<T>(self, reduced: T, full: T) -> T {
        match self {
            Self::Reduced => reduced,
            Self::Full => full,
        }
    }
}

/// The table, run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Stability {
    /// Its rows, group by group.
    pub rows: Vec<StabilityRow>,
    /// Seconds of all.
    pub seconds: f64,
}

/// One row, run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StabilityRow {
    /// What it is about, such as `gamma and alpha`.
    pub group: &'static str,
    /// Which of it.
    pub case: String,
    /// Stated before it was run.
    pub bound: Bound,
    /// What came out; nothing where an error did.
    pub measured: Option<Measured>,
    /// Seconds it took.
    pub seconds: f64,
    /// Whether the bound holds.
    pub within: bool,
    /// What missed, or the message with which the row was refused.
    pub note: String,
}

/// Runs all rows. Only that the run is cancelled stops it; a row that fails or panics is a row that misses.
///
/// # Errors
/// `Cancelled`.
pub fn stability(size: Size, progress: &Progress) -> Result<Stability> {
    let start = Instant::now();
    let all: Vec<(&str, Vec<Case>)> = GROUPS.iter().map(|group| (group.name, (group.cases)(size))).collect();
    progress.set_stages(vec![("stability", size.pick(40.0, 600.0))]);
    progress.begin("stability", all.iter().map(|(_, cases)| cases.len() as u64).sum());
    let mut rows = Vec::new();
    for (group, cases) in all {
        for case in cases {
            progress.check()?;
            rows.push(run(group, case, &progress.inner())?);
            progress.advance(1);
        }
    }
    Ok(Stability { rows, seconds: start.elapsed().as_secs_f64() })
}

fn run(group: &'static str, case: Case, progress: &Progress) -> Result<StabilityRow> {
    let start = Instant::now();
    // What a row leaves behind in a panic is its own and goes with it.
    let outcome = catch_unwind(AssertUnwindSafe(|| (case.run)(progress)))
        .unwrap_or_else(|cause| Err(Error::Numeric { stage: "panic", what: words_of(&*cause) }));
    let seconds = start.elapsed().as_secs_f64();
    let missed = case.bound.missed(&outcome)?;
    let note = match &outcome {
        Err(error) if missed.is_empty() => error.to_string(),
        _ => missed.join("; "),
    };
    let (within, measured) = (missed.is_empty(), outcome.ok());
    Ok(StabilityRow { group, case: case.name, bound: case.bound, measured, seconds, within, note })
}

fn words_of(cause: &(dyn Any + Send)) -> String {
    let text = cause.downcast_ref::<&str>().map(|text| (*text).to_owned());
    text.or_else(|| cause.downcast_ref::<String>().cloned()).unwrap_or_else(|| "without a word".to_owned())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn row(run: impl Fn(&Progress) -> Result<Measured> + 'static) -> Result<StabilityRow> {
        super::run("group", Case::new("case", Bound::Holds(Limits::FINITE), run), &Progress::new())
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
