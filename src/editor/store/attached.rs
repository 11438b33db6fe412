//! The file of the open document: its lock, and whether another program changes it.

use std::path::{Path, PathBuf};
use std::time::SystemTime;

use lightloom_core::files;

use super::Fingerprint;
use super::save::MOST_BYTES;
use crate::file_lock::{FileLock, Locked};

/// Whether the document may be saved to its file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Hold {
    /// It may; with a notice where a lock was taken over.
    Here(Option<String>),
    /// Another editor has it open: who.
    Elsewhere(String),
}

/// The file of the open document.
#[derive(Debug)]
pub(super) struct Attached {
    /// As named by the document.
    named: PathBuf,
    /// Canonical.
    real: PathBuf,
    lock: Option<FileLock>,
    seen: Fingerprint,
    stamp: Option<Stamp>,
}

/// When a file was written last, and its size.
type Stamp = (SystemTime, u64);

impl Attached {
    /// Holds and watches the file at `path`, which had the fingerprint `seen`. The lock of `before` is kept where that is the
    /// same file.
    pub(super) fn new(path: PathBuf, seen: Fingerprint, before: Option<Self>) -> (Self, Hold) {
        let real = path.canonicalize().unwrap_or_else(|_| path.clone());
        let stamp = stamp(&real);
        let kept = before.filter(|before| before.real == real).and_then(|before| before.lock);
        let (lock, hold) = match kept.map_or_else(|| FileLock::take(&real), |lock| Locked::Here(lock, None)) {
            Locked::Here(lock, notice) => (Some(lock), Hold::Here(notice)),
            Locked::Elsewhere(who) => (None, Hold::Elsewhere(who)),
            Locked::Impossible => (None, Hold::Here(None)),
        };
        (Self { named: path, real, lock, seen, stamp }, hold)
    }

    /// Whether this is the file at `path`, and held.
    pub(super) fn holds(&self, path: &Path) -> bool {
        self.lock.is_some() && path.canonicalize().is_ok_and(|real| real == self.real)
    }

    /// The file was written by this editor.
    pub(super) fn written(&mut self, path: &Path, seen: Fingerprint) {
        if path == self.named {
            (self.seen, self.stamp) = (seen, stamp(&self.real));
        }
    }

    /// Shows that the owner lives; returns the file and its new fingerprint where another program changed it since.
    pub(super) fn tick(&mut self) -> Option<(PathBuf, Fingerprint)> {
        self.lock.iter_mut().for_each(FileLock::beat);
        let now = stamp(&self.real);
        // A file that is gone is written again by the next save.
        if now.is_none() || now == self.stamp {
            return None;
        }
        self.stamp = now;
        let seen = Fingerprint::of(&files::read_regular_file(&self.real, MOST_BYTES).ok()?);
        let changed = seen != std::mem::replace(&mut self.seen, seen);
        changed.then(|| (self.named.clone(), seen))
    }
}

fn stamp(path: &Path) -> Option<Stamp> {
    let data = std::fs::metadata(path).ok()?;
    Some((data.modified().ok()?, data.len()))
}

/// Who else has the project file at `path` open, if anyone.
pub(super) fn other_owner(path: &Path) -> Option<String> {
    match FileLock::take(&path.canonicalize().ok()?) {
        Locked::Elsewhere(who) => Some(who),
        Locked::Here(..) | Locked::Impossible => None,
    }
}
