//! The lock of a file: a hidden file beside it that tells other processes who has it, such as a project that is open in an editor.
//!
//! The system's lock on that file tells whether its owner lives, on this machine; across machines, where not every disk shares
//! such locks, the owner touches the file every minute. What a dead owner left is taken over.

use std::fs::{File, OpenOptions};
use std::io::{Read as _, Seek as _, Write as _};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant, SystemTime};

use lightloom_core::files::{is_at, try_hold};
use serde::{Deserialize, Serialize};

/// How often the owner shows that it lives.
const BEAT: Duration = Duration::from_secs(60);
/// Silence after which an owner on another machine counts as gone; clocks may differ by minutes.
const SILENCE: Duration = Duration::from_secs(600);
/// Attempts where an owner removes the file at the same moment.
const TRIES: usize = 16;
/// Longest text about the owner.
const MOST_BYTES: u64 = 4096;

/// Whether this editor may write the file.
#[derive(Debug)]
pub(crate) enum Locked {
    /// It may; with a notice where a lock was taken over.
    Here(FileLock, Option<String>),
    /// Another editor has it open: who.
    Elsewhere(String),
    /// No lock can be made there, as in a folder that is write-protected.
    Impossible,
}

/// A lock that this editor holds until it is dropped.
#[derive(Debug)]
pub(crate) struct FileLock {
    path: PathBuf,
    file: File,
    touched: Instant,
}

#[derive(Debug, Default, Serialize, Deserialize)]
#[serde(default)]
struct Owner {
    host: String,
    process: u32,
}

impl FileLock {
    /// Takes the lock of the project file at `project`, canonical.
    pub(crate) fn take(project: &Path) -> Locked {
        let Some(name) = project.file_name() else { return Locked::Impossible };
        let path = project.with_file_name(format!(".{}.lock", name.to_string_lossy()));
        for _ in 0..TRIES {
            let opened = OpenOptions::new().read(true).write(true).create(true).truncate(false).open(&path);
            let Ok(mut file) = opened else { return Locked::Impossible };
            if !try_hold(&file) {
                return Locked::Elsewhere(Owner::read(&mut file).unwrap_or_default().words());
            }
            // Its owner may have removed it in the meantime: then another file is the lock now.
            if !is_at(&file, &path) {
                continue;
            }
            let old = Owner::read(&mut file);
            let age = file.metadata().and_then(|data| data.modified()).ok();
            let age = age.and_then(|at| SystemTime::now().duration_since(at).ok()).unwrap_or_default();
            let own = Owner::own();
            let notice = match old {
                None => None,
                Some(old) if old.host != own.host && age < SILENCE => return Locked::Elsewhere(old.words()),
                Some(old) => Some(format!(
                    "It was open in {}, which ended without closing it; you have it now",
                    old.words()
                )),
            };
            if own.write(&mut file).is_err() {
                return Locked::Impossible;
            }
            return Locked::Here(Self { path, file, touched: Instant::now() }, notice);
        }
        Locked::Impossible
    }

    /// Shows other machines that the owner lives, once a minute.
    pub(crate) fn beat(&mut self) {
        if self.touched.elapsed() >= BEAT {
            // A disk that is gone for a moment comes back.
            let _ = self.file.set_modified(SystemTime::now());
            self.touched = Instant::now();
        }
    }
}

impl Drop for FileLock {
    fn drop(&mut self) {
        // Removed while it is held; another editor that waits for it makes a new one.
        if is_at(&self.file, &self.path) {
            let _ = std::fs::remove_file(&self.path);
        }
    }
}

impl Owner {
    fn own() -> Self {
        Self { host: gethostname::gethostname().to_string_lossy().into_owned(), process: std::process::id() }
    }

    /// The owner that a lock names; none where it is new.
    fn read(file: &mut File) -> Option<Self> {
        let mut text = Vec::new();
        file.take(MOST_BYTES).read_to_end(&mut text).ok()?;
        if text.is_empty() { None } else { Some(serde_json::from_slice(&text).unwrap_or_default()) }
    }

    fn write(&self, file: &mut File) -> std::io::Result<()> {
        file.set_len(0)?;
        file.rewind()?;
        file.write_all(serde_json::to_string(self)?.as_bytes())
    }

    fn words(&self) -> String {
        match self.host.is_empty() {
            true => "another editor".to_owned(),
            false => format!("another editor (process {} on {})", self.process, self.host),
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn lock_file(project: &Path) -> PathBuf {
        project.with_file_name(".shot.json.lock")
    }

    #[test]
    fn one_editor_holds_it_and_the_next_may_when_it_closes() {
        let folder = tempfile::tempdir().unwrap();
        let project = folder.path().join("shot.json");
        let Locked::Here(lock, None) = FileLock::take(&project) else { panic!("free") };
        let Locked::Elsewhere(who) = FileLock::take(&project) else { panic!("held") };
        assert!(who.contains(&std::process::id().to_string()), "{who}");
        drop(lock);
        assert!(!lock_file(&project).exists());
        assert!(matches!(FileLock::take(&project), Locked::Here(_, None)));
    }

    #[test]
    fn what_the_dead_left_is_taken_over_with_a_notice() {
        let folder = tempfile::tempdir().unwrap();
        let project = folder.path().join("shot.json");
        let there = |owner: &Owner, age: Duration| {
            let mut file = File::create(lock_file(&project)).unwrap();
            owner.write(&mut file).unwrap();
            file.set_modified(SystemTime::now() - age).unwrap();
        };
        // On this machine the system tells that nobody holds it, however young it is.
        there(&Owner { process: 1, ..Owner::own() }, Duration::ZERO);
        assert!(matches!(FileLock::take(&project), Locked::Here(_, Some(_))));
        let far = Owner { host: "far".into(), process: 7 };
        there(&far, SILENCE / 2);
        assert!(matches!(FileLock::take(&project), Locked::Elsewhere(who) if who.contains("far")));
        there(&far, SILENCE * 2);
        assert!(matches!(FileLock::take(&project), Locked::Here(_, Some(notice)) if notice.contains("far")));
    }
}
