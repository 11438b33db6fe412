//! A panic in the threads that read and write files.
#![allow(clippy::unwrap_used)]

use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

use lightloom_core::project::ProjectFile;

use super::*;
use crate::editor::guard;

/// Waits for a result.
fn until<T>(what: &str, mut found: impl FnMut() -> Option<T>) -> T {
    let begun = Instant::now();
    loop {
        if let Some(found) = found() {
            return found;
        }
        assert!(begun.elapsed() < Duration::from_secs(60), "waited in vain: {what}");
        std::thread::sleep(Duration::from_millis(2));
    }
}

fn project() -> Arc<ProjectFile> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("projects/letters_free.json");
    Arc::new(ProjectFile::open(&path).unwrap().0)
}

#[test]
fn a_change_is_kept_for_recovery_although_writing_it_panics_first() {
    let folder = tempfile::tempdir().unwrap();
    let journal = guard::planted("journal", || Journal::start(folder.path().to_owned()));
    let file = project();
    let project = Arc::new(file.project().clone());
    journal.note(Note {
        path: None,
        title: "mine".into(),
        file,
        project,
        seen: None,
        base: "mine.json".into(),
        admitted: Vec::new(),
    });
    let told = until("the message", || journal.problem());
    assert!(told.contains("planted") && told.contains("save often"), "{told}");
    // It is tried again by itself.
    until("the file", || journal.problem().is_none().then_some(()));
    drop(journal);
    let lost = recoverable(folder.path());
    assert_eq!(lost.iter().map(|lost| &*lost.title).collect::<Vec<_>>(), ["mine"]);
}

#[test]
fn a_save_that_panics_leaves_the_old_file_and_the_next_one_is_done() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.json");
    std::fs::write(&path, "old").unwrap();
    let folders = Folders { state: folder.path().join("state"), config: folder.path().join("config") };
    let saver = guard::planted("saver", || Saver::start(folders, || ()).unwrap());
    let file = project();
    let project = Arc::new(file.project().clone());
    let request = || {
        let (path, file, project) = (path.clone(), file.clone(), project.clone());
        StoreRequest::Save(SaveRequest { path, file, project, origin: None, seen: None })
    };
    saver.ask(request());
    let StoreReply::Fault(words) = until("the fault", || saver.answer()) else { panic!("no fault") };
    assert!(words.contains("planted"), "{words}");
    assert_eq!(std::fs::read_to_string(&path).unwrap(), "old");
    saver.ask(request());
    let StoreReply::Saved(_, Ok(_)) = until("the save", || saver.answer()) else { panic!("not saved") };
    assert_eq!(*ProjectFile::open(&path).unwrap().0.project(), *project);
}

#[test]
fn a_file_that_a_dying_editor_still_holds_is_held_once_that_is_gone() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.json");
    std::fs::write(&path, "{}").unwrap();
    let start = || {
        let folders = Folders { state: folder.path().join("state"), config: folder.path().join("config") };
        Saver::start(folders, || ()).unwrap()
    };
    let attach =
        |saver: &Saver| saver.ask(StoreRequest::Attach(Some((path.clone(), Fingerprint::of(b"{}")))));
    let held = |saver: &Saver| match until("the hold", || saver.answer()) {
        StoreReply::Attached(_, hold, _) => hold,
        other => panic!("{other:?}"),
    };
    let dying = start();
    attach(&dying);
    assert_eq!(held(&dying), Hold::Here(None));
    let next = start();
    attach(&next);
    // It is refused a few times meanwhile; nothing depends on how often.
    std::thread::sleep(Duration::from_millis(400));
    assert!(next.answer().is_none());
    drop(dying);
    assert_eq!(held(&next), Hold::Here(None));
}
