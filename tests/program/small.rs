//! A small project for the program, and the program.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::{Value, json};
use tempfile::TempDir;

/// A folder with a small letters project: C becomes S over frames 1 to 9, no scene.
pub(crate) fn letters(method: &str) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let targets = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/targets");
    for name in ["letter_c.png", "letter_s.png"] {
        fs::copy(targets.join(name), folder.path().join(name)).unwrap();
    }
    let key = |frame: i32, file: &str| json!({ "frame": frame, "shows": { "image": { "file": file } } });
    let project = json!({
        "lightloom": 1,
        "name": "Small letters",
        "keys": [key(1, "letter_c.png"), key(9, "letter_s.png")],
        "method": method
    });
    let path = folder.path().join("letters.json");
    fs::write(&path, project.to_string()).unwrap();
    make_small(&path, 2);
    (folder, path)
}

/// Makes the project at `path` small: a coarse flow, few photons, small frames.
pub(crate) fn make_small(path: &Path, passes: usize) {
    let mut project: Value = serde_json::from_slice(&fs::read(path).unwrap()).unwrap();
    let small = json!({
        "flow": { "grid": 32, "steps": 8, "guides": 4000 },
        "render": { "width": 96, "height": 96, "photons": 6000, "passes": passes }
    });
    for (part, settings) in small.as_object().unwrap() {
        settings.as_object().unwrap().iter().for_each(|(name, value)| project[part][name] = value.clone());
    }
    fs::write(path, project.to_string()).unwrap();
}

/// Starts the program and waits for its end.
pub(crate) fn lightloom(args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_lightloom")).args(args).output().unwrap()
}
