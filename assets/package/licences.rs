//! The notices of the libraries that the program is built from.

use std::fmt::Write as _;
use std::path::Path;
use std::{fs, io};

use cargo_metadata::{DependencyKind, Metadata, MetadataCommand, Package, PackageId};

/// Beginnings of the names of files that hold a licence or a notice.
const NAMES: [&str; 5] = ["license", "licence", "copying", "notice", "unlicense"];

/// Name, version, licence and the texts of each library, one after the other, of the workspace around `folder`.
///
/// # Errors
/// When `cargo metadata` fails or a text cannot be read.
pub(crate) fn notices(folder: &Path) -> io::Result<String> {
    let mut command = MetadataCommand::new();
    let triple = format!("{}-unknown-linux-gnu", std::env::consts::ARCH);
    command.current_dir(folder).other_options(vec!["--filter-platform".into(), triple]);
    let metadata = command.exec().map_err(io::Error::other)?;
    let mut text = String::from("Lightloom is built from these libraries.\n");
    for package in linked(&metadata) {
        let licence = package.license.as_deref().unwrap_or("see below");
        let _ = write!(text, "\n{}\n{} {}: {licence}\n", "=".repeat(72), package.name, package.version);
        for (name, notice) in texts(package)? {
            let _ = write!(text, "\n--- {name}\n\n{}\n", notice.trim());
        }
    }
    Ok(text)
}

/// The libraries of others that end up in the program, by name: what it depends on to run, and what that does.
fn linked(metadata: &Metadata) -> Vec<&Package> {
    let nodes = metadata.resolve.as_ref().map_or(&[][..], |resolve| &resolve.nodes);
    let program = metadata.packages.iter().find(|package| package.name.as_str() == "lightloom");
    let mut found: Vec<&PackageId> = program.iter().map(|package| &package.id).collect();
    let mut next = 0;
    while let Some(id) = found.get(next).copied() {
        next += 1;
        let Some(node) = nodes.iter().find(|node| node.id == *id) else { continue };
        for dependency in &node.deps {
            let kinds = &dependency.dep_kinds;
            let runs = kinds.iter().any(|kind| kind.kind == DependencyKind::Normal);
            if runs && !found.contains(&&dependency.pkg) {
                found.push(&dependency.pkg);
            }
        }
    }
    let ours = |package: &&Package| package.source.is_none();
    let mut packages: Vec<&Package> =
        metadata.packages.iter().filter(|package| found.contains(&&package.id) && !ours(package)).collect();
    packages.sort_by_key(|package| (package.name.to_string(), package.version.clone()));
    packages
}

/// The licences and notices in the folder of a library, by name.
fn texts(package: &Package) -> io::Result<Vec<(String, String)>> {
    let Some(folder) = package.manifest_path.parent() else { return Ok(Vec::new()) };
    let mut texts = Vec::new();
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        let name = entry.file_name().to_string_lossy().into_owned();
        let lower = name.to_lowercase();
        if entry.file_type()?.is_file() && NAMES.iter().any(|start| lower.starts_with(start)) {
            texts.push((name, String::from_utf8_lossy(&fs::read(entry.path())?).into_owned()));
        }
    }
    texts.sort();
    Ok(texts)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    #[test]
    fn every_library_that_is_linked_is_named_with_its_licence_and_no_other() {
        let notices = notices(Path::new(env!("CARGO_MANIFEST_DIR"))).unwrap();
        for linked in ["egui", "wgpu", "rayon", "glam", "obvhs", "tobj", "exr"] {
            assert!(notices.contains(&format!("\n{linked} ")), "{linked} is missing");
        }
        // Used by tests and benchmarks alone.
        for other in ["divan", "proptest", "egui_kittest"] {
            assert!(!notices.contains(&format!("\n{other} ")), "{other} is not part of the program");
        }
        assert!(!notices.contains(": see below"), "each library states its licence");
    }
}
