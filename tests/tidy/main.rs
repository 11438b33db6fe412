//! The house rules that a machine can watch: file length, which module may use which, and circles among files.
#![allow(missing_docs, clippy::unwrap_used)]

mod circles;
mod module;
mod package;
mod tokens;

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use circles::circles;
use module::Module;
use package::Package;

/// The core's modules, lowest first: each may use only those before it (and itself).
const ORDER: [&str; 20] = [
    "note",
    "error",
    "setting",
    "progress",
    "files",
    "math",
    "continuity",
    "scene",
    "photon",
    "targets",
    "constraint",
    "matching",
    "bridge",
    "flow",
    "render",
    "export",
    "project",
    "import",
    "engine",
    "lib",
];

/// Modules that compute on plain slices and know nothing of the scene.
const SCENELESS: [&str; 6] = ["continuity", "targets", "constraint", "matching", "bridge", "flow"];

/// A window and a command line.
const OUTSIDE: [&str; 9] =
    ["lightloom", "eframe", "egui", "egui_wgpu", "wgpu", "rfd", "clap", "indicatif", "ctrlc"];

/// What a folder never names.
const UNKNOWN_IN: [(&str, &[&str]); 4] = [
    ("src/core", &OUTSIDE),
    ("src/core", &["lightloom_report"]),
    ("src/report", &OUTSIDE),
    ("src/editor", &["cli", "clap", "indicatif", "ctrlc"]),
];

const LONGEST_FILE: usize = 500;

/// Where code for single systems may stand: in the core's access to files, which the project's check compiles for several of them,
/// and where a program is started or a dialog asked for.
const FOR_ONE_SYSTEM: [&str; 4] =
    ["src/core/files/", "src/editor/device.rs", "src/editor/dialogs/mod.rs", "src/editor/dialogs/system.rs"];

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn sources(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(sources(&path));
        } else if path.extension().is_some_and(|e| e == "rs") {
            found.push(path);
        }
    }
    found.sort();
    found
}

/// The path from the top of the repository on, with `/`.
fn name(file: &Path) -> String {
    let parts = file.strip_prefix(root()).unwrap().iter().map(|part| part.to_str().unwrap());
    parts.collect::<Vec<_>>().join("/")
}

/// The packages of `src`: each has a `lib.rs`.
fn packages() -> Vec<Package> {
    let roots = sources(&root().join("src")).into_iter().filter(|file| file.ends_with("lib.rs"));
    roots.map(|file| Package::read(&file)).collect()
}

#[test]
fn no_source_file_is_too_long() {
    let long: Vec<_> = ["src", "tests", "assets"]
        .iter()
        .flat_map(|folder| sources(&root().join(folder)))
        .filter(|path| fs::read_to_string(path).unwrap().lines().count() > LONGEST_FILE)
        .collect();
    assert!(long.is_empty(), "over {LONGEST_FILE} lines: {long:?}");
}

#[test]
fn every_source_file_belongs_to_a_package() {
    let read: BTreeSet<_> = packages().into_iter().flat_map(|package| package.files).collect();
    let all = sources(&root().join("src")).into_iter().filter(|file| *file != root().join("src/main.rs"));
    let orphans: Vec<_> = all.filter(|file| !read.contains(file) && !file.ends_with("tests.rs")).collect();
    assert!(orphans.is_empty(), "{orphans:#?}");
}

#[test]
fn what_differs_between_systems_stands_in_few_places() {
    let differs = |line: &str| {
        let system = ["unix", "windows", "target_os", "target_family"].iter().any(|name| line.contains(name));
        (line.contains("cfg(") && system) || line.contains("std::os::")
    };
    let of_all = |file: &PathBuf| !FOR_ONE_SYSTEM.iter().any(|place| name(file).starts_with(place));
    let wrong: Vec<_> = sources(&root().join("src"))
        .iter()
        .filter(|file| of_all(file))
        .filter(|file| {
            let text = fs::read_to_string(file).unwrap();
            text.split("#[cfg(test)]").next().unwrap().lines().any(differs)
        })
        .map(|file| name(file))
        .collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn modules_use_only_what_lies_below_them() {
    let core = root().join("src/core");
    let package = Package::read(&core.join("lib.rs"));
    let module = |file: usize| {
        let first = package.files[file].strip_prefix(&core).unwrap().iter().next().unwrap();
        first.to_str().unwrap().trim_end_matches(".rs").to_owned()
    };
    let rank = |file: usize| {
        let module = module(file);
        let found = ORDER.iter().position(|name| *name == module);
        found.unwrap_or_else(|| panic!("{module} has no place in the order; give it one"))
    };
    let mut wrong = Vec::new();
    for (file, imports) in package.imports().iter().enumerate() {
        let sceneless = SCENELESS.contains(&&*module(file));
        for &other in imports {
            let scene = sceneless && ["scene", "photon"].contains(&&*module(other));
            if rank(other) > rank(file) || scene {
                wrong.push(format!("{} uses {}", name(&package.files[file]), name(&package.files[other])));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
    let gone: Vec<_> =
        ORDER.iter().filter(|name| (0..package.files.len()).all(|file| module(file) != **name)).collect();
    assert!(gone.is_empty(), "in the order, but no module: {gone:?}");
}

#[test]
fn the_core_knows_no_window_and_the_editor_no_command_line() {
    let mut wrong = Vec::new();
    for (folder, unknown) in UNKNOWN_IN {
        let folder = root().join(folder);
        for file in sources(&root().join("src")).into_iter().filter(|file| file.starts_with(&folder)) {
            let module = Module::read(&fs::read_to_string(&file).unwrap());
            let paths = module.uses.iter().map(|import| &import.path).chain(&module.paths);
            let foreign = |path: &&Vec<String>| {
                let first = path.iter().find(|part| !["crate", "super", "self"].contains(&part.as_str()));
                path.len() > 1 && first.is_some_and(|first| unknown.contains(&first.as_str()))
            };
            wrong.extend(paths.filter(foreign).map(|path| format!("{}: {}", name(&file), path.join("::"))));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn no_two_files_import_each_other_in_a_circle() {
    let mut found = Vec::new();
    for package in packages() {
        let imports = package.imports();
        for circle in circles(&imports) {
            for file in &circle {
                let others = circle.iter().filter(|other| imports[*file].contains(other));
                let names: Vec<_> = others.map(|other| name(&package.files[*other])).collect();
                found.push(format!("{} uses {}", name(&package.files[*file]), names.join(", ")));
            }
        }
    }
    assert!(found.is_empty(), "{found:#?}");
}

#[test]
fn the_watch_reads_grouped_uses() {
    let module = Module::read("use crate::{Error, flow::{Fade, Grid}, math}; use crate::scene::Scene;");
    let second: Vec<_> = module.uses.iter().map(|import| import.path[1].as_str()).collect();
    assert_eq!(second, ["Error", "flow", "flow", "math", "scene"]);
}
