//! The content of a folder, read on a thread of its own, and what a typed path leads to.

use std::io;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, channel};
use std::thread;

use egui::Context;

use crate::editor::dialogs::request::{Purpose, with_ending};
use crate::editor::guard::Guard;

/// Maximum number of listed entries of a folder.
const MOST: usize = 5_000;

/// A folder that is read, or was.
pub(super) enum Listing {
    Reading(Receiver<Read>),
    Read(Read),
}

/// The content of a folder, or the result of a typed path.
#[derive(Clone, Debug, Default)]
pub(super) struct Read {
    pub(super) folder: PathBuf,
    pub(super) entries: Vec<FolderEntry>,
    pub(super) problem: Option<String>,
    /// The typed path, if it can be chosen.
    pub(super) taken: Option<PathBuf>,
    /// Whether it would overwrite a file.
    pub(super) exists: bool,
}

#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct FolderEntry {
    pub(super) is_file: bool,
    pub(super) name: String,
}

/// A typed path with ~ replaced by the home folder.
pub(in crate::editor::dialogs) fn home(typed: &str) -> PathBuf {
    let rest = typed.strip_prefix("~/").or_else(|| (typed == "~").then_some(""));
    match (rest, directories::UserDirs::new()) {
        (Some(rest), Some(dirs)) => dirs.home_dir().join(rest),
        _ => typed.into(),
    }
}

/// Makes a folder and reads it, on a thread of its own.
pub(super) fn make(folder: PathBuf, purpose: Purpose, ctx: &Context) -> Listing {
    on_thread(ctx, move || match std::fs::create_dir(&folder) {
        Ok(()) => list(folder, purpose),
        Err(error) => {
            let problem = Some(in_words(&folder, &error));
            Read { problem, ..list(folder.parent().unwrap_or(&folder).to_owned(), purpose) }
        }
    })
}

/// Reads a folder, or resolves a path, on a thread of its own.
pub(super) fn read(folder: PathBuf, path: Option<PathBuf>, purpose: Purpose, wake: &Context) -> Listing {
    on_thread(wake, move || look(folder, path, purpose))
}

fn on_thread(wake: &Context, work: impl FnOnce() -> Read + Send + 'static) -> Listing {
    let (sender, receiver) = channel();
    let wake = wake.clone();
    let guard = Guard::new("folder");
    let work = move || {
        let fault =
            |words| Read { problem: Some(format!("a fault of the program: {words}")), ..Read::default() };
        // The dialog may be closed by now.
        let _ = sender.send(guard.run(work).unwrap_or_else(fault));
        wake.request_repaint();
    };
    // Without a thread the sender is dropped, which shows as a message.
    let _ = thread::Builder::new().name("folder".into()).spawn(work);
    Listing::Reading(receiver)
}

/// Why a folder cannot be read or made, and what to do.
fn in_words(folder: &Path, error: &io::Error) -> String {
    let what = match error.kind() {
        io::ErrorKind::PermissionDenied => "you have no permission there; choose another folder",
        io::ErrorKind::NotFound => "there is no such folder; was it moved, or is its disk not connected?",
        io::ErrorKind::NotADirectory => "this is a file, not a folder",
        io::ErrorKind::AlreadyExists => "there is something of that name already; choose another name",
        io::ErrorKind::StorageFull => "the disk is full; free some space, or choose another disk",
        io::ErrorKind::ReadOnlyFilesystem => "the disk is write-protected; choose another one",
        io::ErrorKind::TimedOut => "the disk does not answer; is the network there?",
        _ => return format!("'{}': {error}", folder.display()),
    };
    format!("'{}': {what}", folder.display())
}

fn look(folder: PathBuf, path: Option<PathBuf>, purpose: Purpose) -> Read {
    let wants_folder = purpose.files().1.is_empty();
    match path {
        // A folder that was typed is gone to, unless it is what is wanted.
        Some(path) if path.is_dir() && !wants_folder => list(path, purpose),
        Some(path) if wants_folder || path.is_file() || purpose.saves() => {
            let saved = with_ending(&purpose, path.clone());
            let exists = purpose.saves() && saved.exists();
            Read { taken: Some(path), exists, ..list(folder, purpose) }
        }
        Some(path) => {
            let problem = Some(format!("'{}' does not exist; is it spelled like this?", path.display()));
            Read { problem, ..list(folder, purpose) }
        }
        None => list(folder, purpose),
    }
}

/// The folders and the files of the wanted kind, sorted by name, without hidden ones.
fn list(folder: PathBuf, purpose: Purpose) -> Read {
    let folder = folder.canonicalize().unwrap_or(folder);
    let entries = match std::fs::read_dir(&folder) {
        Ok(entries) => entries,
        Err(error) => {
            let problem = Some(in_words(&folder, &error));
            return Read { folder, problem, ..Read::default() };
        }
    };
    let endings = purpose.files().1;
    let wanted = |path: &Path| {
        let ending = path.extension().map(|e| e.to_string_lossy().to_lowercase());
        ending.is_some_and(|ending| endings.contains(&ending.as_str()))
    };
    let mut entries: Vec<FolderEntry> = entries
        .flatten()
        .take(MOST)
        .filter_map(|entry| {
            let name = entry.file_name().to_string_lossy().into_owned();
            let is_file = !entry.path().is_dir();
            let shown = !name.starts_with('.') && (!is_file || wanted(&entry.path()));
            shown.then_some(FolderEntry { is_file, name })
        })
        .collect();
    entries.sort();
    Read { folder, entries, ..Read::default() }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn place() -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("frames")).unwrap();
        for name in ["b.json", "A.JSON", "d.obj", ".hidden.json"] {
            std::fs::write(folder.path().join(name), "{}").unwrap();
        }
        folder
    }

    #[test]
    fn a_panic_is_told_and_the_next_folder_is_read() {
        let (folder, ctx) = (place(), Context::default());
        let listed = || read(folder.path().into(), None, Purpose::OpenProject, &ctx);
        let result = |listing| match listing {
            Listing::Reading(results) => results.recv().unwrap(),
            Listing::Read(read) => read,
        };
        let failed = result(crate::editor::guard::planted("folder", listed));
        assert!(failed.problem.is_some_and(|problem| problem.contains("a planted panic")));
        assert_eq!(result(listed()).entries.len(), 3);
    }

    #[test]
    fn folders_come_first_and_only_files_of_the_kind_are_listed() {
        let folder = place();
        let names = |purpose| {
            list(folder.path().into(), purpose).entries.into_iter().map(|e| e.name).collect::<Vec<_>>()
        };
        assert_eq!(names(Purpose::OpenProject), ["frames", "A.JSON", "b.json"]);
        assert_eq!(names(Purpose::ExportFolder), ["frames"]);
        assert_eq!(names(Purpose::Asset(crate::editor::asset::AssetUse::Mesh)), ["frames", "d.obj"]);
    }

    #[test]
    fn a_typed_path_leads_to_a_file_a_folder_or_a_message() {
        let folder = place();
        let at = |name: &str, purpose| look(folder.path().into(), Some(folder.path().join(name)), purpose);
        assert_eq!(at("b.json", Purpose::OpenProject).taken, Some(folder.path().join("b.json")));
        let inside = at("frames", Purpose::OpenProject);
        assert!(inside.taken.is_none() && inside.folder.ends_with("frames"));
        assert!(at("none.json", Purpose::OpenProject).problem.is_some());
        assert!(at("frames", Purpose::ExportFolder).taken.is_some());
    }

    #[test]
    fn saving_over_a_file_asks_again_also_where_the_ending_was_not_typed() {
        let folder = place();
        let at =
            |name: &str| look(folder.path().into(), Some(folder.path().join(name)), Purpose::SaveProject);
        assert!(at("b.json").exists && at("b").exists);
        assert!(!at("new").exists && at("new").taken.is_some());
    }

    #[test]
    fn why_a_folder_cannot_be_read_or_made_is_told_in_words() {
        let folder = place();
        let message = |path: &str| list(folder.path().join(path), Purpose::OpenProject).problem.unwrap();
        assert!(message("gone").contains("no such folder") && message("b.json").contains("not a folder"));
        let made =
            |name: &str| match make(folder.path().join(name), Purpose::OpenProject, &Context::default()) {
                Listing::Reading(results) => results.recv().unwrap(),
                Listing::Read(read) => read,
            };
        assert!(made("new").problem.is_none() && folder.path().join("new").is_dir());
        assert!(made("new").problem.unwrap().contains("already"));
    }
}
