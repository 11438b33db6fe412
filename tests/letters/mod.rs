//! A small project of letters, for the tests that measure one.

use std::path::PathBuf;

use serde_json::{Value, json};
use tempfile::TempDir;

/// C becomes S, small; `keys` are the letters in order.
pub(crate) fn project(keys: &[&str]) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let targets = crate::root().join("assets/targets");
    for name in ["letter_c.png", "letter_s.png"] {
        std::fs::copy(targets.join(name), folder.path().join(name)).unwrap();
    }
    std::fs::write(folder.path().join("points.csv"), "0.2,0.3\n0.4,0.7\n0.6,0.5\n").unwrap();
    let shows = |name: &&str| match *name {
        "points" => json!({ "points": { "file": "points.csv" } }),
        name => json!({ "image": { "file": format!("letter_{name}.png") } }),
    };
    let keys: Vec<Value> =
        keys.iter().zip(1..).map(|(name, frame)| json!({ "frame": frame, "shows": shows(name) })).collect();
    let project = json!({
        "lightloom": 1,
        "name": "Small <letters> & more",
        "keys": keys,
        "matching": if keys.iter().any(|key| key["shows"]["points"].is_object()) { "given" } else { "transport" },
        "flow": { "grid": 24, "steps": 6, "guides": 1500, "alpha": 1e-4, "turbulence": { "strength": 50 } },
        "render": { "width": 96, "height": 96, "photons": 3000 }
    });
    let path = folder.path().join("letters.json");
    std::fs::write(&path, project.to_string()).unwrap();
    (folder, path)
}
