//! The paths of a project's meshes and pictures.
//!
//! Paths in a project are relative to the project file, with forward slashes. They must stay inside the project's folder or,
//! where that folder has a neighbour called `assets` (`projects/a.json` beside `assets/`), inside their common parent.
//! Everything else is refused unless the user allows it ([`Admitted`]): an untrusted project cannot read private files.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::{Arc, PoisonError, RwLock};

use super::relative_path::{is_absolute, normalise};
use crate::{Error, Result};

/// The limit of most systems, bytes.
const MAX_PATH_BYTES: usize = 4096;

/// Files that projects may read although they are outside of their folders: the user picked or trusted them. Clones share the
/// list.
///
/// With an OBJ file its material files are admitted, too: `.mtl` files in the folder above its own, and anywhere below that.
#[derive(Clone, Debug, Default)]
pub struct Admitted(Arc<RwLock<BTreeSet<PathBuf>>>);

impl Admitted {
    /// Admits these files; those that cannot be found are kept as they are named, since a disk may come back.
    pub fn new(files: impl IntoIterator<Item = PathBuf>) -> Self {
        let real = files.into_iter().map(|file| file.canonicalize().unwrap_or(file));
        Self(Arc::new(RwLock::new(real.collect())))
    }

    /// Admits a file, too.
    pub fn add(&self, file: &Path) {
        let real = file.canonicalize().unwrap_or_else(|_| file.to_owned());
        self.0.write().unwrap_or_else(PoisonError::into_inner).insert(real);
    }

    /// The files, in order.
    pub fn files(&self) -> Vec<PathBuf> {
        self.0.read().unwrap_or_else(PoisonError::into_inner).iter().cloned().collect()
    }

    /// The number of files.
    pub fn count(&self) -> usize {
        self.0.read().unwrap_or_else(PoisonError::into_inner).len()
    }

    /// Whether both are the same list.
    pub fn is(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }

    /// Whether a file may be read; `real` is canonical.
    fn holds(&self, real: &Path) -> bool {
        let files = self.0.read().unwrap_or_else(PoisonError::into_inner);
        let ends =
            |path: &Path, ending: &str| path.extension().is_some_and(|e| e.eq_ignore_ascii_case(ending));
        let beside = |mesh: &PathBuf| {
            let folder = mesh.parent();
            ends(mesh, "obj")
                && folder.and_then(Path::parent).or(folder).is_some_and(|above| real.starts_with(above))
        };
        files.contains(real) || (ends(real, "mtl") && files.iter().any(beside))
    }
}

/// The resolver of asset paths of one project.
#[derive(Clone, Debug)]
pub struct AssetFolder {
    folder: PathBuf,
    /// The folder that paths stay in.
    root: PathBuf,
    /// Whether they may leave it.
    anywhere: bool,
    admitted: Admitted,
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
        let root = shared.unwrap_or(&folder).to_owned();
        Ok(Self { folder, root, anywhere: allow_external, admitted: Admitted::default() })
    }

    /// The same resolver, which also finds these files outside.
    pub fn admitting(self, admitted: Admitted) -> Self {
        Self { admitted, ..self }
    }

    /// Whether the file `real`, canonical, may be read by a project here.
    pub fn allows(&self, real: &Path) -> bool {
        self.anywhere || self.is_inside(real) || self.admitted.holds(real)
    }

    /// Whether a file, canonical, lies where projects here may read without being asked.
    pub(super) fn is_inside(&self, real: &Path) -> bool {
        real.starts_with(&self.root)
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
        let path = self.folder.join(written);
        let found = path.canonicalize();
        if !self.anywhere && !normalise(&path).starts_with(&self.root) {
            // Whether there is such a file is told only of those that may be read.
            return found
                .ok()
                .filter(|real| self.admitted.holds(real))
                .ok_or_else(|| outside(&shown, place, &self.root));
        }
        let real = found.map_err(|e| {
            if is_pattern(written) {
                return wrong(
                    "stands for a sequence, and none is read: a plate, a target and a mesh are one file each and stand still; name one of its files",
                );
            }
            wrong(&format!(
                "cannot be read at '{}': {e}; is it there, and spelled like this?",
                path.display()
            ))
        })?;
        if self.allows(&real) { Ok(real) } else { Err(outside(&shown, place, &self.root)) }
    }
}

/// Whether a path has a place for the number of a frame, as `plate.####.exr` and `plate.%04d.exr` have.
fn is_pattern(written: &str) -> bool {
    let counts = |rest: &str| rest.trim_start_matches(|c: char| c.is_ascii_digit()).starts_with('d');
    written.contains("##") || written.split('%').skip(1).any(counts)
}

fn outside(written: &str, place: &str, root: &Path) -> Error {
    let how = if is_absolute(written) { "is an absolute path outside" } else { "leads out" };
    let what = format!(
        "'{written}' {how} of '{}'; copy the file there, trust it in the editor, or pass --allow-external",
        root.display()
    );
    Error::value(place, what)
}
