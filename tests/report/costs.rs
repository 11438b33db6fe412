//! The report: what exactness of the flow and of the matching costs, read from its tables.

use std::path::Path;
use std::sync::OnceLock;
use std::time::Duration;

use lightloom_core::engine::Engine;
use lightloom_core::project::{AssetFolder, Project};
use lightloom_core::{Error, Progress};
use lightloom_report::{Cell, Effort, Part, Report, Section, Table, Tone, report};
use serde_json::{Value, json};

fn measured(path: &Path, section: &str, progress: &Progress) -> Result<Report, Error> {
    let engine = Engine::new(AssetFolder::new(path, false).unwrap());
    let (project, scratch) = (Project::load(path).unwrap(), path.parent().unwrap());
    report(&engine, &project, Effort::Quick, &[section.to_owned()], scratch, progress)
}

/// What a section says of a small project, changed before.
fn changed(section: &str, change: impl FnOnce(&mut Value, &Path)) -> Report {
    let (folder, path) = crate::letters::project(&["c", "s"]);
    let mut project: Value = serde_json::from_str(&std::fs::read_to_string(&path).unwrap()).unwrap();
    change(&mut project, folder.path());
    std::fs::write(&path, project.to_string()).unwrap();
    let report = measured(&path, section, &Progress::new()).unwrap();
    assert!(!report.has_failed(), "{:?}", report.absent);
    report
}

fn chapter(section: &str, change: impl FnOnce(&mut Value, &Path)) -> Section {
    changed(section, change).sections.into_iter().next().unwrap()
}

/// A flow that a fine grid resolves well: smooth, and without swirls.
fn smooth(project: &mut Value) {
    project["flow"] = json!({ "grid": 24, "steps": 16, "guides": 1500, "alpha": 1e-2 });
}

/// What the section of the flow says of it, measured once for all tests.
fn smooth_flow() -> &'static Section {
    static SECTION: OnceLock<Section> = OnceLock::new();
    SECTION.get_or_init(|| chapter("flow", |project, _| smooth(project)))
}

/// Across the way of both letters.
fn wall(project: &mut Value) {
    project["constraints"] =
        json!([{ "type": "wall", "points": [[0.3, 0.5], [0.7, 0.5]], "thickness": 0.04 }]);
}

fn table<'a>(chapter: &'a Section, name: &str) -> &'a Table {
    chapter.tables().find(|table| table.name == name).unwrap()
}

fn text(cell: &Cell) -> &str {
    match cell {
        Cell::Text(text) => text,
        _ => panic!("no text: {cell:?}"),
    }
}

fn number(cell: &Cell) -> f64 {
    match cell {
        Cell::Number(value) => *value,
        Cell::Text(text) => text.parse().unwrap(),
        Cell::Nothing => f64::NAN,
    }
}

/// A column, of the rows whose first cell is `name`.
fn column(table: &Table, name: &str, column: &str) -> Vec<f64> {
    let column = table.columns.iter().position(|other| *other == column).unwrap();
    table
        .rows
        .iter()
        .filter(|row| text(&row.cells[0]) == name)
        .map(|row| number(&row.cells[column]))
        .collect()
}

fn words(chapter: &Section) -> String {
    let texts = chapter.parts.iter().filter_map(|part| match part {
        Part::Text(text) => Some(text.as_str()),
        _ => None,
    });
    texts.collect::<Vec<_>>().join("\n")
}

#[test]
fn errors_of_a_flow_fall_as_it_is_worked_out_more_exactly() {
    let chapter = smooth_flow();
    let (alone, all) = (table(chapter, "flow_alone"), table(chapter, "flow"));
    assert_eq!(column(alone, "steps", "value"), [2.0, 4.0, 8.0, 16.0, 32.0, 48.0]);
    let steps = column(alone, "steps", "rms (plane)");
    let doubt = column(all, "reference", "rms (plane)")[0];
    println!("steps {steps:?}, reference {doubt}");
    // Second order would be 4; the coarsest are not yet there. The last is what the others are compared with.
    assert!(steps[..5].windows(2).all(|pair| pair[0] > 2.0 * pair[1]), "{steps:?}");
    for knob in ["grid", "guides", "tolerance"] {
        let errors = column(alone, knob, "rms (plane)");
        println!("{knob} {errors:?}");
        assert!(errors.windows(2).all(|pair| pair[0] > pair[1]), "{knob}: {errors:?}");
        assert_eq!(errors.last(), Some(&0.0));
    }
    // Against the reference all errors together count; what it is off itself is less than any of those that are judged.
    let coarse = column(all, "steps", "rms (plane)");
    assert!(doubt > 0.0 && coarse.iter().filter(|error| **error > doubt).count() >= 3, "{coarse:?} {doubt}");
}

#[test]
fn a_table_of_the_flow_keeps_its_word() {
    let chapter = smooth_flow();
    let all = table(chapter, "flow");
    let at = |name: &str| all.columns.iter().position(|column| *column == name).unwrap();
    let (seconds, rms, front) = (at("seconds"), at("rms (plane)"), at("on the front"));
    let rows = &all.rows[..all.rows.len() - 1];
    for row in rows {
        // One in a thousand is farther than the mean square, and none is farther than the plane is long.
        let [rms, high, most] = [rms, rms + 1, rms + 2].map(|i| number(&row.cells[i]));
        assert!(0.0 < rms && rms < high && high <= most && most < 1.0, "{row:?}");
    }
    let own: Vec<_> = rows.iter().filter(|row| row.tone == Tone::Marked).collect();
    assert!(own.len() == 1 && text(&own[0].cells[0]) == "the project's");
    let offers: Vec<_> =
        rows.iter().map(|row| (number(&row.cells[seconds]), number(&row.cells[rms]))).collect();
    for (row, offer) in rows.iter().zip(&offers) {
        let beaten = offers.iter().any(|other| other.0 <= offer.0 && other.1 <= offer.1 && other != offer);
        assert_eq!(text(&row.cells[front]) == "no", beaten, "{row:?}");
    }
    for row in &table(chapter, "flow_cheapest").rows[..3] {
        let (wanted, found) = (number(&row.cells[0]), number(&row.cells[2]));
        let best = offers.iter().filter(|offer| offer.1 <= wanted).map(|offer| offer.0).reduce(f64::min);
        match best {
            Some(seconds) => assert_eq!(found, seconds),
            None => assert_eq!(text(&row.cells[1]), "none measured reaches it"),
        }
    }
    assert_eq!(chapter.plots().count(), 2);
    chapter.plots().for_each(|plot| assert!(plot.to_svg().unwrap().contains("</svg>")));
}

#[test]
fn the_same_seed_makes_the_same_errors() {
    let run = || {
        let chapter = chapter("flow", |project, _| wall(project));
        assert!(
            words(&chapter).contains("around its walls")
                && words(&chapter).contains("turbulence of the project")
        );
        let alone = table(&chapter, "flow_alone");
        ["steps", "grid", "guides", "tolerance"].map(|knob| column(alone, knob, "rms (plane)"))
    };
    assert_eq!(run(), run());
}

#[test]
fn a_pairing_is_never_below_the_bound_and_gets_nearer_with_more_work() {
    let chapter = chapter("matching", |_, _| ());
    let all = table(&chapter, "matching");
    let of = |name: &str| {
        let (values, ratios) = (column(all, name, "value"), column(all, name, "cost over the bound"));
        let mut rows: Vec<(f64, f64)> = values.into_iter().zip(ratios).collect();
        rows.sort_by(|a, b| a.0.total_cmp(&b.0));
        rows
    };
    for row in &all.rows {
        // The bound is a sum of f64: rounding is below 1e-9.
        assert!(number(&row.cells[5]) >= 1.0 - 1e-9, "{row:?}");
    }
    let (sweeps, halves) = (of("sweeps"), of("no map, sweeps"));
    println!("{sweeps:?} {halves:?}");
    // An exchange is only made where it gains.
    assert!(sweeps.windows(2).all(|pair| pair[0].1 >= pair[1].1 - 1e-12));
    assert!(halves.windows(2).all(|pair| pair[0].1 >= pair[1].1 - 1e-12));
    let one = |name: &str| of(name)[0].1;
    // With no iteration the map leaves all in place: the halves alone.
    assert_eq!(of("iterations")[0].1, halves.iter().find(|(sweeps, _)| *sweeps == 6.0).unwrap().1);
    assert!(one("transport") < one("stylized (2016)") && one("transport") <= of("iterations")[0].1);
    let marked: Vec<_> = all.rows.iter().filter(|row| row.tone == Tone::Marked).collect();
    assert!(marked.len() == 1 && text(&marked[0].cells[0]) == "transport");
}

#[test]
fn around_walls_the_map_that_knows_them_is_nearest() {
    let chapter = chapter("matching", |project, _| wall(project));
    let all = table(&chapter, "matching");
    let one = |name: &str| column(all, name, "cost over the bound")[0];
    assert!(1.0 < one("transport around walls") && one("transport around walls") < one("transport"));
    assert!(words(&chapter).contains("no more than a bound"));
}

#[test]
fn rows_as_given_are_measured_as_they_are() {
    let chapter = chapter("matching", |project, folder| {
        // Both go to where the other would be nearer.
        std::fs::write(folder.join("from.csv"), "0.2,0.3\n0.4,0.7\n").unwrap();
        std::fs::write(folder.join("to.csv"), "0.5,0.7\n0.3,0.3\n").unwrap();
        project["matching"] = json!("given");
        for (key, file) in [(0, "from.csv"), (1, "to.csv")] {
            project["keys"][key]["shows"] = json!({ "points": { "file": file } });
        }
    });
    let all = table(&chapter, "matching");
    let one = |name: &str| column(all, name, "cost over the bound")[0];
    // (0.3, 0.4) and (-0.1, -0.4) against (0.1, 0) twice.
    assert!((one("rows as given") / one("transport") - (0.25 + 0.17) / 0.02).abs() < 1e-3);
}

#[test]
fn a_method_without_fields_has_no_flow_to_measure() {
    let linear = |project: &mut Value, _: &Path| project["method"] = json!("linear");
    let report = changed("flow", linear);
    assert!(report.sections.is_empty() && report.absent[0].why.contains("fits no fields"));
    assert_eq!(changed("matching", linear).sections.len(), 1);
}

#[test]
fn a_measurement_can_be_stopped() {
    let (_folder, path) = crate::letters::project(&["c", "s"]);
    for section in ["flow", "matching"] {
        let progress = Progress::new();
        let watched = progress.clone();
        // From the first run of the section on there are many to come.
        let watcher = std::thread::spawn(move || {
            while watched.snapshot().stage != Some(section) {
                std::thread::sleep(Duration::from_micros(100));
            }
            watched.cancel();
        });
        assert!(matches!(measured(&path, section, &progress), Err(Error::Cancelled)));
        watcher.join().unwrap();
    }
}
