//! A whole report of a small project: every section is there, its text is plain sentences, and stages are timed once.

use std::sync::OnceLock;

use lightloom_core::Progress;
use lightloom_core::engine::Engine;
use lightloom_core::project::{AssetFolder, Project};
use lightloom_report::{Cell, Effort, Part, Report, Section, Table, report, sections};

use crate::letters;

fn whole() -> &'static Report {
    static REPORT: OnceLock<Report> = OnceLock::new();
    REPORT.get_or_init(|| {
        let (folder, path) = letters::project(&["c", "s"]);
        let engine = Engine::new(AssetFolder::new(&path, false).unwrap());
        let project = Project::load(&path).unwrap();
        report(&engine, &project, Effort::Quick, &[], folder.path(), &Progress::new()).unwrap()
    })
}

/// All text of a part.
fn texts(part: &Part) -> Vec<&str> {
    match part {
        Part::Text(text) => vec![text],
        Part::Table(Table { caption, columns, rows, .. }) => {
            let cells = rows.iter().flat_map(|row| &row.cells).filter_map(|cell| match cell {
                Cell::Text(text) => Some(text.as_str()),
                _ => None,
            });
            [caption.as_str()].into_iter().chain(columns.iter().copied()).chain(cells).collect()
        }
        Part::Plot(plot) => {
            let lines = plot.panels.iter().flat_map(|panel| &panel.lines).map(|line| &line.label);
            let panels = plot.panels.iter().flat_map(|panel| [&panel.title, &panel.x.label, &panel.y.label]);
            lines.chain(panels).chain([&plot.title]).map(String::as_str).collect()
        }
        Part::Pictures(shown) => {
            let labels = shown.pictures.iter().map(|picture| &picture.label);
            labels.chain([&shown.caption]).map(String::as_str).collect()
        }
    }
}

#[test]
fn no_text_holds_a_backslash_a_line_break_or_a_gap() {
    for section in &whole().sections {
        for text in section.parts.iter().flat_map(texts).chain([section.title.as_str()]) {
            assert!(!text.contains(['\\', '\n', '\t']) && !text.contains("  "), "{}: {text:?}", section.name);
        }
    }
}

#[test]
fn every_section_is_measured_and_none_fails() {
    let report = whole();
    let measured: Vec<&str> = report.sections.iter().map(|section| section.name).collect();
    assert!(report.absent.is_empty(), "{:?}", report.absent);
    assert_eq!(measured, sections().collect::<Vec<_>>());
}

#[test]
fn each_stage_is_measured_once_at_a_size_and_compared_with_the_machine() {
    let table = |name: &str| {
        whole().sections.iter().flat_map(Section::tables).find(|table| table.name == name).unwrap()
    };
    let text = |cell: &Cell| match cell {
        Cell::Text(text) => text.clone(),
        other => panic!("no text: {other:?}"),
    };
    let number = |cell: &Cell| match cell {
        Cell::Number(value) => *value,
        other => panic!("no number: {other:?}"),
    };
    let rows: Vec<(String, f64)> =
        table("growth").rows.iter().map(|row| (text(&row.cells[0]), number(&row.cells[2]))).collect();
    for (i, row) in rows.iter().enumerate() {
        assert!(!rows[..i].contains(row), "{row:?}");
    }
    let machine = table("machine");
    // The project traces nothing; all other stages with a limit are compared.
    assert_eq!(machine.rows.len(), 5, "{machine:?}");
    for row in &machine.rows {
        let ratio = number(&row.cells[4]);
        assert!(ratio > 0.0 && ratio.is_finite(), "{row:?}");
        let same = |other: &&lightloom_report::Row| {
            text(&other.cells[0]) == text(&row.cells[0])
                && matches!(other.cells[5], Cell::Number(limit) if limit / number(&other.cells[3]) == ratio)
        };
        assert!(table("growth").rows.iter().any(|other| same(&other)), "{row:?}");
    }
}
