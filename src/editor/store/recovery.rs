//! Recovery of unsaved documents after a crash.

use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use lightloom_core::project::ProjectFile;
use lightloom_core::{Error, Result, files};

use super::record::Record;
use super::slot::JournalSlot;
use super::{Fingerprint, disk};

/// Maximum size of a journal: one project file of 64 MiB with JSON escapes.
const MOST_BYTES: u64 = 160 << 20;

/// Unsaved work of a crashed editor. While this exists no other editor offers it; dropped, it is offered
/// again at the next start.
pub struct Recovery {
    /// The user's file; none where the document was never saved.
    pub path: Option<PathBuf>,
    /// Title of the document.
    pub title: String,
    /// Age of the last change.
    pub age: Duration,
    /// The last state of the project, or why it cannot be read.
    pub work: Result<Arc<ProjectFile>>,
    /// Fingerprint of the user's file when the crashed editor last read or saved it.
    pub seen: Option<Fingerprint>,
    /// Whether the user's file has changed since: the editor crashed right after saving, or another program
    /// wrote it. The file may be newer than this work.
    pub file_changed: bool,
    /// The file that the paths of the work are relative to, where the journal tells.
    pub base: Option<PathBuf>,
    /// Files outside of its folder that the user let it read.
    pub admitted: Vec<PathBuf>,
    slot: JournalSlot,
}

impl Recovery {
    /// Deletes the work.
    ///
    /// # Errors
    /// The file and the system's reason.
    pub fn discard(self) -> Result<()> {
        self.slot.clear()
    }

    pub(super) fn into_slot(self) -> JournalSlot {
        self.slot
    }
}

impl fmt::Debug for Recovery {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.debug_struct("Recovery").field("title", &self.title).field("age", &self.age).finish_non_exhaustive()
    }
}

/// The recoverable work in `folder`, newest first. Reads files: not for the window's thread. Work that equals
/// the user's file is deleted and not offered.
pub fn recoverable(folder: &Path) -> Vec<Recovery> {
    disk::sweep(folder);
    let mut found: Vec<_> = JournalSlot::abandoned(folder).into_iter().filter_map(look_into).collect();
    found.sort_by_key(|recovery| recovery.age);
    found
}

fn look_into(slot: JournalSlot) -> Option<Recovery> {
    let file = slot.file().to_owned();
    let read = files::read_regular_file(&file, MOST_BYTES).and_then(|bytes| {
        let broken = |e| Error::format(&file, "", format!("is no recovery file: {e}; discard it"));
        serde_json::from_slice::<Record>(&bytes).map_err(broken)
    });
    let record = match read {
        Ok(record) => record,
        Err(error) => {
            let title = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            let age = std::fs::metadata(&file).and_then(|data| data.modified()).map_or(Duration::ZERO, since);
            return Some(Recovery {
                path: None,
                title,
                age,
                work: Err(error),
                seen: None,
                file_changed: false,
                base: None,
                admitted: Vec::new(),
                slot,
            });
        }
    };
    let in_file = record.path.as_ref().and_then(|path| files::read_regular_file(path, MOST_BYTES).ok());
    if in_file.as_ref().is_some_and(|bytes| bytes == record.text.as_bytes()) && slot.clear().is_ok() {
        return None;
    }
    let file_changed = in_file.zip(record.seen).is_some_and(|(bytes, seen)| Fingerprint::of(&bytes) != seen);
    let named = record.path.as_deref().unwrap_or(&file);
    let work = ProjectFile::parse(record.text.as_bytes(), named).map(|(work, _)| Arc::new(work));
    let age = UNIX_EPOCH.checked_add(Duration::from_secs(record.time)).map_or(Duration::ZERO, since);
    Some(Recovery {
        path: record.path,
        title: record.title,
        age,
        work,
        seen: record.seen,
        file_changed,
        base: record.base,
        admitted: record.admitted,
        slot,
    })
}

/// Time since; zero for a time in the future.
fn since(time: SystemTime) -> Duration {
    time.elapsed().unwrap_or_default()
}
