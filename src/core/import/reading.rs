//! Reads a file of any kind.

use std::path::Path;

use super::imported::Import;
use super::{gltf, obj, setting};
use crate::scene::gltf::GltfFile;
use crate::scene::mesh;
use crate::{Error, Progress, Result};

/// Reads a glTF or an OBJ file.
///
/// # Errors
/// `Format` names the file, the place and what to do: also for formats that are not read, with what to export instead.
/// `Limit`, `Io`, `Cancelled`.
pub fn read(path: &Path, progress: &Progress) -> Result<Import> {
    if let Some(advice) = mesh::advice(path) {
        return Err(Error::format(path, "", advice));
    }
    let ending = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    let draft = match ending.as_str() {
        _ if GltfFile::is_named(path) => gltf::read(path, progress)?,
        "obj" => obj::read(path, progress)?,
        _ => {
            let what =
                "is none of .glb, .gltf and .obj; export glTF 2.0 (.glb), which holds lamps and cameras, too";
            return Err(Error::format(path, "", what));
        }
    };
    setting::complete(draft, path, progress)
}
