//! The paths of a project's meshes and pictures.
//!
//! Paths in a project are relative to the project file, with forward slashes. They must stay inside the project's folder or,
//! where that folder has a neighbour called `assets` (`projects/a.json` beside `assets/`), inside their common parent.
//! Everything else is refused unless the user allows it: an untrusted project cannot read private files.

use std::path::{Component, Path, PathBuf};

use crate::{Error, Result};

/// The limit of most systems, bytes.
const MAX_PATH_BYTES: usize = 4096;

/// The resolver of asset paths of one project.
#[derive(Clone, Debug)]
pub struct AssetFolder {
    folder: PathBuf,
    root: Option<PathBuf>,
}

impl AssetFolder {
    /// The resolver for the project file at `project`. `allow_external` allows paths outside.
    ///
    /// # Errors
    /// The project's folder cannot be found.
    pub fn new(project: &Path, allow_external: bool) -> Result<Self> {
        let folder = match project.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => folder,
            _ => Path::new("."),
        };
        let folder = folder.canonicalize().map_err(Error::io("find the folder", folder))?;
        let shared = folder.parent().filter(|parent| parent.join("assets").is_dir());
        let root = (!allow_external).then(|| shared.unwrap_or(&folder).to_owned());
        Ok(Self { folder, root })
    }

    /// The file of the path `written` in the project value at `place`.
    ///
    /// # Errors
    /// A path that is not portable, leads outside, or does not exist.
    pub fn resolve(&self, written: &str, place: &str) -> Result<PathBuf> {
        let shown: String = written.chars().take(80).collect();
        let wrong = |what: &str| Error::value(place, format!("'{}' {what}", shown.escape_default()));
        if written.is_empty() {
            return Err(wrong("names no file; give a path relative to the project file"));
        }
        if written.len() > MAX_PATH_BYTES {
            return Err(wrong("… is longer than 4096 bytes; shorten the path"));
        }
        if written.contains('\0') {
            return Err(wrong("holds a NUL character"));
        }
        if written.contains('\\') {
            return Err(wrong(
                "holds a backslash; write it relative to the project file, with forward slashes",
            ));
        }
        let absolute = Path::new(written).is_absolute() || written.as_bytes().get(1) == Some(&b':');
        if absolute && self.root.is_some() {
            return Err(wrong(
                "is an absolute path; write it relative to the project file, or pass --allow-external",
            ));
        }
        let path = self.folder.join(written);
        if let Some(root) = &self.root
            && !normalise(&path).starts_with(root)
        {
            return Err(outside(&shown, place, root));
        }
        let real = path.canonicalize().map_err(|e| {
            wrong(&format!(
                "cannot be read at '{}': {e}; is it there, and spelled like this?",
                path.display()
            ))
        })?;
        match &self.root {
            Some(root) if !real.starts_with(root) => Err(outside(&shown, place, root)),
            _ => Ok(real),
        }
    }
}

fn outside(written: &str, place: &str, root: &Path) -> Error {
    let what = format!(
        "'{written}' leads out of '{}'; copy the file there, or pass --allow-external",
        root.display()
    );
    Error::value(place, what)
}

/// The path without `.` and `..`, without access to the file system.
fn normalise(path: &Path) -> PathBuf {
    let mut clean = PathBuf::new();
    for part in path.components() {
        match part {
            Component::ParentDir => {
                clean.pop();
            }
            Component::CurDir => {}
            other => clean.push(other),
        }
    }
    clean
}
