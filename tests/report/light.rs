//! The report's sections of the light: what passes and photons buy, and the sheet of grids and gammas.

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use lightloom_core::engine::Engine;
use lightloom_core::project::{AssetFolder, Project};
use lightloom_core::{Error, Progress};
use lightloom_report::{Cell, Effort, Part, Picture, Report, Row, report};
use serde_json::{Value, json};
use tempfile::TempDir;

/// C becomes S, small; `change` is laid over it.
fn project(change: &Value) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let targets = crate::root().join("assets/targets");
    for name in ["letter_c.png", "letter_s.png"] {
        std::fs::copy(targets.join(name), folder.path().join(name)).unwrap();
    }
    std::fs::write(folder.path().join("points.csv"), "0.2,0.3\n0.4,0.7\n0.6,0.5\n").unwrap();
    let shows = |name: &str| json!({ "image": { "file": format!("letter_{name}.png") } });
    let mut project = json!({
        "lightloom": 1,
        "name": "Letters",
        "keys": [{ "frame": 1, "shows": shows("c") }, { "frame": 20, "shows": shows("s") }],
        "flow": { "grid": 16, "steps": 6, "guides": 1500, "alpha": 1e-3 },
        // A small kernel, so that noise outweighs blur.
        "render": { "width": 96, "height": 96, "photons": 4000, "passes": 8, "radius": 0.02 }
    });
    for (key, value) in change.as_object().unwrap() {
        project[key] = value.clone();
    }
    let path = folder.path().join("project.json");
    std::fs::write(&path, project.to_string()).unwrap();
    (folder, path)
}

fn measure(path: &Path, effort: Effort, section: &str, progress: &Progress) -> Result<Report, Error> {
    let engine = Engine::new(AssetFolder::new(path, false).unwrap());
    let scratch = tempfile::tempdir().unwrap();
    let only = [section.to_owned()];
    report(&engine, &Project::load(path).unwrap(), effort, &only, scratch.path(), progress)
}

/// A sheet of the letters, measured once for all tests.
fn sheet() -> &'static Report {
    static SHEET: OnceLock<Report> = OnceLock::new();
    SHEET.get_or_init(|| {
        let (_folder, path) = project(&json!({}));
        measure(&path, Effort::Quick, "study", &Progress::new()).unwrap()
    })
}

fn rows(report: &Report) -> Vec<&Row> {
    report.sections.iter().flat_map(|chapter| chapter.tables()).flat_map(|table| &table.rows).collect()
}

fn number(row: &Row, column: usize) -> Option<f64> {
    match row.cells[column] {
        Cell::Number(value) => Some(value),
        _ => None,
    }
}

fn pictures(report: &Report) -> Vec<&Picture> {
    let parts = report.sections.iter().flat_map(|chapter| &chapter.parts);
    let grids = parts.filter_map(|part| match part {
        Part::Pictures(grid) => Some(&grid.pictures),
        _ => None,
    });
    grids.flatten().collect()
}

/// Columns of the table of errors.
const PHOTONS: usize = 0;
const PASSES: usize = 1;
const RMS: usize = 4;
const PERCEPTUAL: usize = 5;
const FLICKER: usize = 6;
const SLOPE: usize = 7;

#[test]
fn the_error_falls_with_the_passes_and_the_reference_has_the_least() {
    let (_folder, path) = project(&json!({}));
    let found = measure(&path, Effort::Full, "render", &Progress::new()).unwrap();
    let all = rows(&found);
    let (reference, runs) = all.split_last().unwrap();
    let own: Vec<&&Row> = runs.iter().filter(|row| number(row, PHOTONS) == Some(4000.0)).collect();
    let passes: Vec<f64> = own.iter().map(|row| number(row, PASSES).unwrap()).collect();
    assert_eq!(passes, [1.0, 2.0, 4.0, 8.0]);
    for column in [RMS, PERCEPTUAL, FLICKER] {
        let errors: Vec<f64> = own.iter().map(|row| number(row, column).unwrap()).collect();
        assert!(errors.is_sorted_by(|a, b| a > b), "column {column}: {errors:?}");
    }
    // The limit is -1/3. Noise alone falls as -1/3 too while the kernel shrinks, by up to -1/2 where points are spread more
    // evenly than by chance; edges, whose blur shrinks slowly, lift it.
    let slope = own.iter().find_map(|row| number(row, SLOPE)).unwrap();
    assert!((-0.5..=-0.2).contains(&slope), "slope {slope}");
    let noise = number(reference, RMS).unwrap();
    assert!(runs.iter().all(|row| number(row, RMS).unwrap() > noise), "the reference has {noise}");
    // One setting is the project's own.
    let marked = runs.iter().filter(|row| row.tone == lightloom_report::Tone::Marked);
    assert_eq!(marked.map(|row| number(row, PASSES)).collect::<Vec<_>>(), [Some(8.0)]);
}

#[test]
fn the_same_seed_gives_the_same_errors_and_pictures() {
    let (_folder, path) = project(&json!({}));
    let run = |section| measure(&path, Effort::Quick, section, &Progress::new()).unwrap();
    let png = |report: &Report| pictures(report).iter().map(|p| p.png.clone()).collect::<Vec<_>>();
    let same = |a: &Report, b: &Report| !png(a).is_empty() && png(a) == png(b);
    assert!(same(sheet(), &run("study")));
    let (a, b) = (run("render"), run("render"));
    assert!(same(&a, &b));
    let errors = |report: &Report| {
        rows(report).iter().map(|row| [RMS, PERCEPTUAL].map(|c| number(row, c))).collect::<Vec<_>>()
    };
    assert_eq!(errors(&a), errors(&b));
}

#[test]
fn light_that_rests_has_an_error_and_does_not_flicker() {
    let (_folder, path) =
        project(&json!({ "keys": [{ "frame": 1, "shows": { "image": { "file": "letter_c.png" } } }] }));
    let found = measure(&path, Effort::Quick, "render", &Progress::new()).unwrap();
    for row in rows(&found) {
        assert!(number(row, RMS).unwrap() > 0.0 && number(row, FLICKER).is_none());
    }
}

#[test]
fn a_sheet_has_a_picture_for_each_grid_and_gamma() {
    let shown = pictures(sheet());
    let labels: Vec<&str> = shown.iter().map(|picture| picture.label.as_str()).collect();
    let all = labels.join("; ");
    assert!(shown.len() == 6 && all.contains("grid 16, gamma 0.5, as the project has it"), "{all}");
    let decoded: Vec<_> =
        shown.iter().map(|p| image::load_from_memory(&p.png).unwrap().into_rgb8()).collect();
    assert!(decoded.iter().all(|p| p.dimensions() == decoded[0].dimensions()), "one crop for all");
    // A liquid and a gradient do not look alike.
    assert!(decoded[0] != decoded[2]);
}

#[test]
fn rows_paired_as_given_have_no_passes_to_look_at() {
    let shows = json!({ "points": { "file": "points.csv" } });
    let (_folder, path) = project(&json!({
        "keys": [{ "frame": 1, "shows": shows }, { "frame": 9, "shows": shows }], "matching": "given"
    }));
    let found = measure(&path, Effort::Quick, "render", &Progress::new()).unwrap();
    assert!(found.sections.is_empty() && !found.absent[0].failed, "{:?}", found.absent);
}

#[test]
fn a_section_that_is_cancelled_stops() {
    let (_folder, path) = project(&json!({}));
    for section in ["render", "study"] {
        let progress = Progress::new();
        let watcher = progress.clone();
        let found = std::thread::scope(|scope| {
            let run = scope.spawn(|| measure(&path, Effort::Full, section, &progress));
            while watcher.snapshot().stage != Some(section) && !run.is_finished() {
                std::thread::yield_now();
            }
            watcher.cancel();
            run.join().unwrap()
        });
        assert!(matches!(found, Err(Error::Cancelled)), "{section}: {found:?}");
    }
}
