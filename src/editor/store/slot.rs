//! The file of one journal with a lock that marks its owner. The system releases the lock when its owner ends,
//! so a file whose lock is free belongs to a crashed editor.

use std::fs::{File, OpenOptions};
use std::path::{Path, PathBuf};

use lightloom_core::files::{make_private, try_hold};
use lightloom_core::{Error, Result};

/// Attempts to create a name that no other editor removes at the same moment.
const TRIES: usize = 16;

/// A journal's file, held by its lock.
#[derive(Debug)]
pub(super) struct JournalSlot {
    file: PathBuf,
    lock_path: PathBuf,
    _lock: File,
}

impl JournalSlot {
    /// A new slot with a random name; the file itself does not exist yet.
    pub(super) fn new(folder: &Path) -> Result<Self> {
        make_private(folder)?;
        for _ in 0..TRIES {
            let lock = tempfile::Builder::new().prefix("").suffix(".lock").rand_bytes(12).tempfile_in(folder);
            let (lock, lock_path) =
                lock.and_then(|lock| Ok(lock.keep()?)).map_err(Error::io("create a file in", folder))?;
            // Whoever clears away empty slots may have come between: then another name.
            if try_hold(&lock) && lock_path.exists() {
                return Ok(Self { file: lock_path.with_extension("json"), lock_path, _lock: lock });
            }
        }
        let busy = std::io::Error::other("other editors take every file away");
        Err(Error::io("create a file in", folder)(busy))
    }

    /// The file.
    pub(super) fn file(&self) -> &Path {
        &self.file
    }

    /// Deletes the file and keeps the slot.
    ///
    /// # Errors
    /// The file and the system's reason.
    pub(super) fn clear(&self) -> Result<()> {
        match std::fs::remove_file(&self.file) {
            Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
                Err(Error::io("remove", &self.file)(error))
            }
            _ => Ok(()),
        }
    }

    /// All slots with a file and without an owner, now owned by this editor. Those without a file are removed.
    pub(super) fn abandoned(folder: &Path) -> Vec<Self> {
        let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
        let mut files: Vec<_> = entries
            .flatten()
            .map(|entry| entry.path())
            .filter(|path| path.extension().is_some_and(|end| end == "json" || end == "lock"))
            .map(|path| path.with_extension("json"))
            .collect();
        files.sort();
        files.dedup();
        // Where there is no file, the lock is removed as the slot goes.
        files.into_iter().filter_map(Self::take).filter(|slot| slot.file.exists()).collect()
    }

    fn take(file: PathBuf) -> Option<Self> {
        let lock_path = file.with_extension("lock");
        let lock = OpenOptions::new().write(true).create(true).truncate(false).open(&lock_path).ok()?;
        try_hold(&lock).then_some(Self { file, lock_path, _lock: lock })
    }
}

impl Drop for JournalSlot {
    fn drop(&mut self) {
        if !self.file.exists() {
            let _ = std::fs::remove_file(&self.lock_path);
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn a_slot_is_abandoned_once_its_holder_is_gone() {
        let folder = tempfile::tempdir().unwrap();
        let slot = JournalSlot::new(folder.path()).unwrap();
        std::fs::write(slot.file(), b"work").unwrap();
        assert!(JournalSlot::abandoned(folder.path()).is_empty());
        drop(slot);
        let found = JournalSlot::abandoned(folder.path());
        assert_eq!(found.len(), 1);
        assert!(JournalSlot::abandoned(folder.path()).is_empty(), "held by the one who found it");
        found[0].clear().unwrap();
        drop(found);
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    }

    #[test]
    fn locks_without_work_are_cleared_away_and_work_without_lock_is_found() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("a.lock"), b"").unwrap();
        std::fs::write(folder.path().join("b.json"), b"work").unwrap();
        let found = JournalSlot::abandoned(folder.path());
        assert!(matches!(&found[..], [one] if one.file().ends_with("b.json")));
        assert!(!folder.path().join("a.lock").exists());
    }
}
