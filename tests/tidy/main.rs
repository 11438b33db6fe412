//! The house rules that a machine can watch: file length, and which module may use which.
#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::{Path, PathBuf};

/// The core's modules, lowest first: each may use only those before it (and itself).
const ORDER: [&str; 16] = [
    "error",
    "setting",
    "progress",
    "files",
    "math",
    "scene",
    "photon",
    "targets",
    "constraint",
    "matching",
    "flow",
    "render",
    "export",
    "project",
    "engine",
    "lib",
];

/// Modules that compute on plain slices and know nothing of the scene.
const SCENELESS: [&str; 4] = ["targets", "constraint", "matching", "flow"];

const LONGEST_FILE: usize = 500;

fn sources(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() && !path.ends_with("target") {
            found.extend(sources(&path));
        } else if path.extension().is_some_and(|e| e == "rs") {
            found.push(path);
        }
    }
    found.sort();
    found
}

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
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

/// The first path segment after every `crate::`, also inside `use crate::{a, b::c}`.
fn used_modules(text: &str) -> Vec<&str> {
    let end_of_word = |c: char| !(c.is_alphanumeric() || c == '_');
    let mut used = Vec::new();
    for (at, _) in text.match_indices("crate::") {
        let rest = &text[at + "crate::".len()..];
        if let Some(group) = rest.strip_prefix('{') {
            let mut depth = 0;
            let end = group.find(|c| {
                depth += i32::from(c == '{') - i32::from(c == '}');
                depth < 0
            });
            let mut level = 0;
            for part in group[..end.unwrap_or(0)].split_inclusive(['{', '}', ',']) {
                let name = part.trim().split(end_of_word).next().unwrap();
                if level == 0 && !name.is_empty() {
                    used.push(name);
                }
                level += part.matches('{').count() as i32 - part.matches('}').count() as i32;
            }
        } else {
            used.push(rest.split(end_of_word).next().unwrap());
        }
    }
    used
}

#[test]
fn modules_use_only_what_lies_below_them() {
    let core = root().join("src/core");
    let rank = |name: &str| ORDER.iter().position(|module| *module == name);
    let mut wrong = Vec::new();
    for path in sources(&core) {
        let relative = path.strip_prefix(&core).unwrap();
        let first = relative.components().next().unwrap().as_os_str().to_str().unwrap();
        let module = first.trim_end_matches(".rs");
        let own = rank(module).unwrap_or_else(|| panic!("{module} has no place in the order; give it one"));
        for used in used_modules(&fs::read_to_string(&path).unwrap()) {
            let scene = SCENELESS.contains(&module) && ["scene", "photon"].contains(&used);
            if rank(used).is_some_and(|other| other > own) || scene {
                wrong.push(format!("{} uses {used}", relative.display()));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn the_watch_reads_grouped_uses() {
    assert_eq!(used_modules("use crate::{Error, flow::{Fade, Grid}, math};"), ["Error", "flow", "math"]);
    assert_eq!(used_modules("use crate::scene::Scene;"), ["scene"]);
}
