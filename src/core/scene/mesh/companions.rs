//! The files that a mesh file names: without them it is not the same mesh elsewhere.

use std::path::{Path, PathBuf};

use super::library::{Assets, MOST_FILES, Owner};
use super::obj;
use super::text::{self, Lines};
use crate::files::read_regular_file;
use crate::{Progress, Result};

/// A material file of an OBJ file, found as when the mesh is loaded.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MaterialFile {
    /// Its path relative to the folder of the mesh; absolute where the mesh names it so.
    pub written: String,
    /// The file.
    pub path: PathBuf,
}

/// The material files of the OBJ file at `path`, which the project calls `written`, each once; and notes on those that are
/// not found. `assets` resolves a path as written, for the value at a place.
///
/// # Errors
/// `Io`, `Format` or `Limit` where the mesh cannot be read; cancelled.
pub fn material_files(
    (written, path): (&str, &Path),
    assets: Assets<'_>,
    progress: &Progress,
) -> Result<(Vec<MaterialFile>, Vec<String>)> {
    let bytes = read_regular_file(path, obj::MAX_BYTES)?;
    let owner = Owner { name: written, written, path, place: "mesh", assets };
    let (mut files, mut notes) = (Vec::<MaterialFile>::new(), Vec::new());
    for (number, line) in Lines::new(&bytes, path)? {
        if number % 65_536 == 0 {
            progress.check()?;
        }
        let (keyword, rest) = text::keyword(&line);
        if !keyword.eq_ignore_ascii_case("mtllib") {
            continue;
        }
        for (name, found) in owner.files(rest) {
            match found {
                Ok(found) if files.iter().any(|known| known.path == found.path) => (),
                Ok(found) if files.len() < MOST_FILES => {
                    files.push(MaterialFile { written: found.written, path: found.path });
                }
                Ok(_) => (),
                Err(error) => {
                    notes.push(format!("{written}: its material file '{name}' was not found: {error}"));
                }
            }
        }
    }
    Ok((files, notes))
}
