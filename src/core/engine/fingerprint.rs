//! The fingerprint of a render: a hash of everything that its pixels depend on.
//!
//! Frames carry it, so that a later run knows which of them it would make again.

use std::collections::{BTreeMap, HashMap};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use serde_json::Value;
use sha2::{Digest as _, Sha256};

use crate::files::read_regular_file;
use crate::project::{AssetFolder, Project};
use crate::{Error, Result};

/// Number of the way in which pixels are made. Raise it with every change of the code after which a project gives other
/// bytes than before; the golden frames of the tests tell.
const ENGINE: u32 = 9;
/// Largest file that a project is made from.
const MAX_BYTES: u64 = 64 << 30;

/// The fingerprint of a render of `project`, in hexadecimal digits: its content without names and the choice of frames and
/// formats, the bytes of its files, and the version of this program. `mesh_files` are the files that its meshes were read
/// from, those of materials among them.
///
/// # Errors
/// A file cannot be read.
pub(super) fn fingerprint(project: &Project, assets: &AssetFolder, mesh_files: &[PathBuf]) -> Result<String> {
    let mut known = HashMap::new();
    let mut hash_of = |path: &Path| match known.get(path) {
        Some(hash) => Ok(String::clone(hash)),
        None => hash_of_file(path).inspect(|hash| drop(known.insert(path.to_owned(), hash.clone()))),
    };
    let hash = |file: &str| {
        let hash = assets.resolve(file, "file").and_then(|path| hash_of(&path))?;
        Ok((file.to_owned(), hash))
    };
    let hashes: BTreeMap<String, String> = project.files().into_iter().map(hash).collect::<Result<_>>()?;
    let mut project = project.clone();
    project.rename_files(|file| hashes.get(file).cloned().unwrap_or_default());
    let mut content = serde_json::to_value(&project)
        .map_err(|error| Error::value("project", format!("cannot be written as JSON: {error}")))?;
    leave_out(&mut content, &["name"]);
    if let Some(output) = content.get_mut("output") {
        leave_out(output, &["name", "frames", "formats", "draws_constraints"]);
    }
    for constraint in content.get_mut("constraints").and_then(Value::as_array_mut).into_iter().flatten() {
        leave_out(constraint, &["group"]);
    }
    let apart = [project.output.separates_caustics(), project.output.shows_plane()];
    let version = env!("CARGO_PKG_VERSION");
    let mut hash = Sha256::new();
    hash.update(format!("Lightloom {version} engine {ENGINE}\n{content}\n{apart:?}\n"));
    let mut hashes = mesh_files.iter().map(|path| hash_of(path)).collect::<Result<Vec<_>>>()?;
    // Wherever the files lie.
    hashes.sort();
    hashes.iter().for_each(|of_file| hash.update(of_file));
    Ok(hexadecimal(&hash.finalize()))
}

fn leave_out(content: &mut Value, names: &[&str]) {
    if let Value::Object(members) = content {
        members.retain(|name, _| !names.contains(&name.as_str()));
    }
}

fn hash_of_file(path: &Path) -> Result<String> {
    Ok(hexadecimal(&Sha256::digest(read_regular_file(path, MAX_BYTES)?)))
}

fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    })
}
