//! Project files, and the files that they name.

use std::path::{Path, PathBuf};

use lightloom_core::engine::Engine;
use lightloom_core::project::{AssetFolder, Project, ProjectFile};
use serde_json::{Value, json};

use super::{Row, told};
use crate::scenes::texts;

/// A project of two keys of points.
pub(crate) fn good() -> Value {
    json!({
        "lightloom": 1,
        "name": "Shot",
        "seed": 7,
        "keys": [
            { "frame": 1, "shows": { "points": { "file": "left.csv" } } },
            { "frame": 11, "shows": { "points": { "file": "right.csv" } } }
        ],
        "flow": { "gamma": 0.25, "alpha": 0.001, "grid": [16, 16], "steps": 8 },
        "render": { "width": 16, "height": 16, "photons": 100, "passes": 1 },
        "output": { "name": "shot.####", "fps": [24, 1], "frames": "1-11" }
    })
}

/// Writes a project and its points into a folder.
pub(crate) fn written(folder: &Path, bytes: &[u8]) -> PathBuf {
    let path = folder.join("shot.json");
    std::fs::write(&path, bytes).unwrap();
    for (name, x) in [("left.csv", 0.25), ("right.csv", 0.75)] {
        let rows =
            (0..200).map(|i| format!("{},{}\n", x + 0.0005 * f64::from(i), 0.3 + 0.001 * f64::from(i)));
        std::fs::write(folder.join(name), rows.collect::<String>()).unwrap();
    }
    path
}

/// Loads and checks the project of a file; the notes on it.
fn check(bytes: &[u8]) -> Result<Vec<String>, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = written(folder.path(), bytes);
    checked(&path).map_err(|error| told(error, folder.path()))
}

fn checked(path: &Path) -> lightloom_core::Result<Vec<String>> {
    let project = Project::load(path)?;
    Ok(texts(&Engine::new(AssetFolder::new(path, false)?).check(&project)?.notes))
}

/// The good project with another value at a place.
fn with(pointer: &str, value: Value) -> Vec<u8> {
    let mut project = good();
    let (parent, name) = pointer.rsplit_once('/').unwrap();
    match project.pointer_mut(parent).unwrap() {
        Value::Array(list) => list[name.parse::<usize>().unwrap()] = value,
        object => object[name] = value,
    }
    project.to_string().into_bytes()
}

/// The good project with another text in place of one of its own.
fn replaced(old: &str, new: &str) -> Vec<u8> {
    let text = good().to_string();
    assert!(text.contains(old), "{old}");
    text.replacen(old, new, 1).into_bytes()
}

fn utf16(text: &str) -> Vec<u8> {
    text.encode_utf16().flat_map(u16::to_le_bytes).collect()
}

pub(super) fn rows() -> Vec<Row> {
    let text = good().to_string();
    let deep = format!("{{\"lightloom\":1,\"name\":{}", "[".repeat(100_000));
    let raw: Vec<(&str, Vec<u8>, &str)> = vec![
        ("empty file", Vec::new(), "empty project"),
        ("blanks alone", b" \n\t".to_vec(), "empty project"),
        ("cut off in the middle", text.as_bytes()[..text.len() / 2].to_vec(), "line 1, column … cut off"),
        ("UTF-16", utf16(&text), "UTF-16; save it as UTF-8"),
        ("no UTF-8", b"{\"lightloom\":1,\"name\":\"\xff\"}".to_vec(), "is not UTF-8"),
        ("NaN as a number", replaced("\"gamma\":0.25", "\"gamma\":NaN"), "line 1 … flow.gamma"),
        ("Infinity as a number", replaced("\"gamma\":0.25", "\"gamma\":Infinity"), "line 1 … flow.gamma"),
        ("1e39, beyond 32 bits", replaced("\"alpha\":0.001", "\"alpha\":1e39"), "flow.alpha"),
        (
            "1e999, beyond 64 bits",
            replaced("\"alpha\":0.001", "\"alpha\":1e999"),
            "line 1 … flow.alpha … out of range",
        ),
        ("a member twice", replaced("\"seed\":7", "\"seed\":7,\"seed\":8"), "duplicate … seed"),
        ("100 000 levels deep", deep.into_bytes(), "line 1, column"),
        ("text behind the end", format!("{text} {{}}").into_bytes(), "more text stands after"),
        ("another JSON file", b"[1, 2]".to_vec(), "line 1, column"),
        ("null for a number", with("/flow/gamma", Value::Null), "flow.gamma … null"),
        ("text for a number", with("/flow/gamma", json!("high")), "flow.gamma … string"),
        ("-1 photons", with("/render/photons", json!(-1)), "render.photons … -1"),
        ("1.5 photons", with("/render/photons", json!(1.5)), "render.photons … 1.5"),
        ("0 photons", with("/render/photons", json!(0)), "render.photons … to"),
        ("10^12 photons", with("/render/photons", json!(1_000_000_000_000_u64)), "render.photons … to"),
        ("5e9 passes", with("/render/passes", json!(5_000_000_000_u64)), "render.passes"),
        ("misspelt member", with("/flow/gama", json!(0.5)), "flow … gama"),
        ("grid of 100000 x 100000", with("/flow/grid", json!([100_000, 100_000])), "flow.grid … GiB"),
        ("grid of 0 x 0", with("/flow/grid", json!([0, 0])), "flow.grid … 8"),
        ("grid of 1 x 64", with("/flow/grid", json!([1, 64])), "flow.grid … 8"),
        ("gamma -0.1", with("/flow/gamma", json!(-0.1)), "flow.gamma … 0 to 1"),
        ("gamma 1.1", with("/flow/gamma", json!(1.1)), "flow.gamma … 0 to 1"),
        ("alpha 0", with("/flow/alpha", json!(0)), "flow.alpha … to"),
        ("alpha 1e-30", with("/flow/alpha", json!(1e-30)), "flow.alpha … to"),
        ("alpha 1e30", with("/flow/alpha", json!(1e30)), "flow.alpha … to"),
        ("beta -1", with("/flow/beta", json!(-1)), "flow.beta … to"),
        ("beta 1e30", with("/flow/beta", json!(1e30)), "flow.beta … to"),
        ("tau 1.5", with("/flow/fade", json!({ "type": "paper", "tau": 1.5 })), "flow.fade"),
        ("tau 1", with("/flow/fade", json!({ "type": "paper", "tau": 1.0 })), "flow.fade.tau … 0 to 0.99"),
        (
            "a caustic without lights",
            with("/caustics", json!([{ "name": "red" }])),
            "caustics … add \"scene\"",
        ),
        ("rho 0", with("/flow/rho", json!(0)), "flow.rho … to"),
        ("rho -1", with("/flow/rho", json!(-1)), "flow.rho … to"),
        ("frames 9-1", with("/output/frames", json!("9-1")), "output.frames"),
        ("frames without any", with("/output/frames", json!("")), "output.frames"),
        ("frames 1-1000000000", with("/output/frames", json!("1-1000000000")), "output.frames"),
        ("0 frames per second", with("/output/fps", json!([0, 1])), "output.fps"),
        ("1/0 frames per second", with("/output/fps", json!([1, 0])), "output.fps"),
        ("two keys at one frame", with("/keys/1/frame", json!(1)), "keys[1].frame"),
        ("no keys", with("/keys", json!([])), "keys"),
        ("a name without frame number", with("/output/name", json!("shot")), "output.name … #"),
        ("a name that leads out", with("/output/name", json!("../shot.####")), "output.name"),
        ("needs a later reader", with("/lightloom", json!(9)), "lightloom … version 9 … newer Lightloom"),
        ("100 000 points in a wall", many_points(100_000), "constraints[0] … limit"),
        ("bigger than 64 MiB", " ".repeat((64 << 20) + 1).into_bytes(), "the limit is 67108864"),
    ];
    let read: Vec<(&str, Vec<u8>, &str)> = vec![
        ("byte order mark", [b"\xef\xbb\xbf", text.as_bytes()].concat(), ""),
        ("grid of 4096 x 8", with("/flow/grid", json!([4096, 8])), ""),
        ("1 photon", with("/render/photons", json!(1)), ""),
        ("beta 0", with("/flow/beta", json!(0)), ""),
    ];
    let refused = raw.into_iter().map(|(input, bytes, words)| Row::refused(input, words, || check(&bytes)));
    let mut rows: Vec<Row> = refused.collect();
    rows.extend(read.into_iter().map(|(input, bytes, words)| Row::read(input, words, || check(&bytes))));
    rows.push(Row::read("a member that nobody knows, in the window", "unknown: flow.later", || {
        let (file, unknown) = ProjectFile::parse(&with("/flow/later", json!(1)), Path::new("shot.json"))
            .map_err(|e| e.to_string())?;
        let written = file.text_of(file.project()).map_err(|e| e.to_string())?;
        assert!(written.contains("later"), "it is written back");
        Ok(unknown.iter().map(|place| format!("unknown: {place}")).collect())
    }));
    rows.push(Row::refused("a value that is no number, to be saved", "flow.gamma", || {
        let mut project = Project::parse(&with("/seed", json!(1)), Path::new("shot.json")).unwrap();
        project.flow.gamma = f32::NAN;
        project.to_json().map_err(|error| error.to_string())
    }));
    rows
}

fn many_points(count: usize) -> Vec<u8> {
    let wall = format!("{{\"type\":\"wall\",\"points\":[{}[0,0]]}}", "[0,0],".repeat(count - 1));
    replaced("\"lightloom\":1", &format!("\"constraints\":[{wall}],\"lightloom\":1"))
}

pub(super) fn asset_rows() -> Vec<Row> {
    let root = tempfile::tempdir().unwrap();
    let folder = root.path().join("project");
    std::fs::create_dir(&folder).unwrap();
    std::fs::write(root.path().join("outside.csv"), "0.5,0.5\n").unwrap();
    std::fs::create_dir(folder.join("folder.csv")).unwrap();
    #[cfg(unix)]
    {
        use std::os::unix::fs::symlink;
        symlink("loop.csv", folder.join("loop.csv")).unwrap();
        symlink("../outside.csv", folder.join("out.csv")).unwrap();
        symlink("/dev/zero", folder.join("zero.csv")).unwrap();
        let made = std::process::Command::new("mkfifo").arg(folder.join("pipe.csv")).status();
        assert!(made.unwrap().success());
    }
    let path = folder.join("shot.json");
    let observe = |file: &str| {
        std::fs::write(&path, with("/keys/0/shows/points/file", json!(file))).unwrap();
        checked(&path).map_err(|error| told(error, root.path()))
    };
    let long = "a/".repeat(2500);
    let mut inputs = vec![
        ("no name", "", "keys[0].shows.points.file"),
        ("not there", "none.csv", "none.csv … No such file"),
        ("absolute", "/etc/passwd", "keys[0].shows.points.file"),
        ("up and out", "../outside.csv", "leads out"),
        ("a share", "\\\\server\\c.csv", "keys[0].shows.points.file"),
        ("a drive", "C:\\c.csv", "keys[0].shows.points.file"),
        ("a NUL", "c\0.csv", "keys[0].shows.points.file"),
        ("5000 characters", &long, "keys[0].shows.points.file"),
        ("a folder", "folder.csv", "a folder; name a regular file"),
    ];
    if cfg!(unix) {
        inputs.extend([
            ("a link in a circle", "loop.csv", "loop.csv"),
            ("a link out of the folder", "out.csv", "leads out"),
            ("a link to /dev/zero", "zero.csv", "leads out"),
            ("a pipe", "pipe.csv", "a device, pipe or socket"),
        ]);
    }
    inputs.into_iter().map(|(input, file, words)| Row::refused(input, words, || observe(file))).collect()
}
