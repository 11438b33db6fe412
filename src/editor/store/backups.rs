//! Backups: the last three versions of each saved file, in the state folder, where no disk that is pulled out takes them along.

use std::path::{Path, PathBuf};
use std::time::SystemTime;

use lightloom_core::{Error, Result, files};

use super::{Fingerprint, Folders, disk};

/// Kept versions of a file.
const KEPT: usize = 3;

/// An earlier version of a project file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Backup {
    /// The backup.
    pub path: PathBuf,
    /// When it was replaced.
    pub replaced: SystemTime,
}

/// The backups of the project file at `path`, newest first.
pub(super) fn of(folders: &Folders, path: &Path) -> Vec<Backup> {
    let place = |number| place(folders, path, number);
    let replaced = |path: &Path| std::fs::metadata(path).and_then(|data| data.modified()).ok();
    let backup = |path: PathBuf| replaced(&path).map(|replaced| Backup { path, replaced });
    (1..=KEPT).map(place).filter_map(backup).collect()
}

/// Keeps `old`, the content of the file at `path` that is about to be replaced, unless it is kept already; the oldest goes.
///
/// # Errors
/// The file and the system's reason; the other backups are then still there.
pub(super) fn keep(folders: &Folders, path: &Path, old: &[u8], most_bytes: u64) -> Result<()> {
    let newest = place(folders, path, 1);
    if files::read_regular_file(&newest, most_bytes).is_ok_and(|kept| kept == old) {
        return Ok(());
    }
    // The new one is whole before an old one moves.
    let next = newest.with_extension("next");
    disk::write(&next, old)?;
    for number in (0..KEPT).rev() {
        let (from, to) = match number {
            0 => (next.clone(), newest.clone()),
            _ => (place(folders, path, number), place(folders, path, number + 1)),
        };
        match std::fs::rename(&from, &to) {
            Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
                return Err(Error::io("write", &to)(error));
            }
            _ => (),
        }
    }
    Ok(())
}

/// The name contains a hash of the path, so that equal names do not collide.
fn place(folders: &Folders, path: &Path, number: usize) -> PathBuf {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let folder = Fingerprint::of(path.as_os_str().as_encoded_bytes()).short();
    folders.backups().join(format!("{name}.{folder}.bak{number}"))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn the_last_three_versions_are_kept_each_once() {
        let folder = tempfile::tempdir().unwrap();
        let folders = Folders { state: folder.path().join("state"), config: folder.path().join("config") };
        let path = folder.path().join("shot.json");
        for version in [1, 2, 3, 3, 4, 5, 5_u8] {
            keep(&folders, &path, &[version], 9).unwrap();
        }
        let kept: Vec<_> =
            of(&folders, &path).iter().map(|backup| std::fs::read(&backup.path).unwrap()).collect();
        assert_eq!(kept, [[5], [4], [3]]);
        assert!(of(&folders, &folder.path().join("other.json")).is_empty());
    }
}
