//! The stiff and the extreme, at reduced size: every row holds the bound that it states beforehand.

use std::sync::OnceLock;

use lightloom_core::{Error, Progress};
use lightloom_report::{Bound, Effort, Stability, StabilityRow, stability};

fn table() -> &'static Stability {
    static TABLE: OnceLock<Stability> = OnceLock::new();
    TABLE.get_or_init(|| stability(Effort::Quick, &Progress::new()).unwrap())
}

#[test]
fn every_row_holds_its_bound() {
    let missed: Vec<&StabilityRow> = table().missed().collect();
    assert!(missed.is_empty(), "{missed:#?}");
}

#[test]
fn nothing_is_not_a_number_not_even_where_a_bound_is_missed() {
    for row in &table().rows {
        let Some(measured) = &row.measured else {
            assert!(matches!(row.bound, Bound::Refused { .. }) || !row.within, "{row:?}");
            continue;
        };
        assert!(measured.finite, "{row:?}");
        let numbers = [
            measured.endpoint_error,
            measured.solver_error,
            measured.condition,
            measured.energy,
            Some(row.seconds),
        ];
        assert!(numbers.into_iter().flatten().all(f64::is_finite), "{row:?}");
    }
}

#[test]
fn the_files_hold_every_row_and_mark_those_that_miss() {
    let folder = tempfile::tempdir().unwrap();
    let table = table();
    let files = table.report(Effort::Quick).write(folder.path(), "stability").unwrap();
    let read = |end: &str| {
        let path = files.iter().find(|path| path.to_string_lossy().ends_with(end)).unwrap();
        std::fs::read_to_string(path).unwrap()
    };
    assert_eq!(read(".html").matches("class=\"bad\"").count(), table.missed().count());
    let csv = read("stability.csv");
    assert_eq!(csv.matches(",within,").count(), table.rows.len() - table.missed().count());
    assert_eq!(csv.matches(",missed,").count(), table.missed().count());
    assert!(table.to_json().contains("\"solver_error\""));
}

#[test]
fn a_cancelled_table_says_so() {
    let progress = Progress::new();
    progress.cancel();
    assert!(matches!(stability(Effort::Quick, &progress), Err(Error::Cancelled)));
}
