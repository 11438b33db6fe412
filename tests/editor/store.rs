//! The editor's store: journal, recovery, and the thread that opens and saves.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

use lightloom::editor::store::{
    Fingerprint, Folders, Hold, Journal, Note, Opened, Origin, Preferences, SaveRequest, Saver, StoreReply,
    StoreRequest, recoverable, trusted,
};
use lightloom_core::project::{Admitted, AssetFolder, Project, ProjectFile, Shows, relative};
use lightloom_core::targets::ImageTarget;

/// Only a store that hangs takes so long.
const PATIENCE: Duration = Duration::from_secs(60);

/// A folder of its own for each test, with a project in it.
struct Fixture {
    folder: tempfile::TempDir,
}

impl Fixture {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let example = Path::new(env!("CARGO_MANIFEST_DIR")).join("projects/letters_free.json");
        std::fs::copy(example, folder.path().join("shot.json")).unwrap();
        Self { folder }
    }

    fn path(&self) -> PathBuf {
        self.folder.path().join("shot.json")
    }

    fn folders(&self) -> Folders {
        Folders { state: self.folder.path().join("state"), config: self.folder.path().join("config") }
    }

    fn recovery(&self) -> PathBuf {
        self.folders().recovery()
    }

    fn file(&self) -> Arc<ProjectFile> {
        Arc::new(ProjectFile::open(&self.path()).unwrap().0)
    }

    fn note(&self, seed: u64) -> Note {
        let file = self.file();
        let seen = Some(Fingerprint::of(&std::fs::read(self.path()).unwrap()));
        let project = with_seed(&file, seed);
        Note {
            path: Some(self.path()),
            title: "Letters".into(),
            file,
            project,
            seen,
            base: self.path(),
            admitted: Vec::new(),
        }
    }

    /// The request to save `project` where it was opened.
    fn save(&self, file: Arc<ProjectFile>, project: Arc<Project>, seen: Option<Fingerprint>) -> SaveRequest {
        SaveRequest { path: self.path(), file, project, origin: None, seen }
    }

    fn files_in_recovery(&self) -> usize {
        std::fs::read_dir(self.recovery()).map_or(0, Iterator::count)
    }
}

fn with_seed(file: &ProjectFile, seed: u64) -> Arc<Project> {
    Arc::new(Project { seed, ..file.project().clone() })
}

/// A saver, and what tells that an answer is there.
struct Waiting {
    saver: Saver,
    woken: Receiver<()>,
}

impl Waiting {
    fn new(fixture: &Fixture) -> Self {
        let (wake, woken) = channel();
        let saver = Saver::start(fixture.folders(), move || {
            let _ = wake.send(());
        })
        .unwrap();
        Self { saver, woken }
    }

    fn ask(&self, request: StoreRequest) -> StoreReply {
        self.saver.ask(request);
        self.woken.recv_timeout(PATIENCE).unwrap();
        self.saver.answer().unwrap()
    }

    fn attach(&self, path: &Path) -> StoreReply {
        let seen = Fingerprint::of(&std::fs::read(path).unwrap());
        self.ask(StoreRequest::Attach(Some((path.to_owned(), seen))))
    }

    fn open(&self, fixture: &Fixture) -> Opened {
        match self.ask(StoreRequest::Open(fixture.path())) {
            StoreReply::Opened(path, Ok(opened)) if path == fixture.path() => opened,
            other => panic!("{other:?}"),
        }
    }
}

#[test]
fn what_a_lost_editor_noted_is_offered_as_it_was_last() {
    let fixture = Fixture::new();
    let journal = Journal::start(fixture.recovery());
    (2..=9).for_each(|seed| journal.note(fixture.note(seed)));
    drop(journal);
    let found = recoverable(&fixture.recovery());
    let [recovery] = &found[..] else { panic!("{found:?}") };
    assert_eq!((recovery.title.as_str(), recovery.path.as_ref()), ("Letters", Some(&fixture.path())));
    assert_eq!(recovery.work.as_ref().unwrap().project().seed, 9);
    assert!(!recovery.file_changed);
    assert_eq!(fixture.file().project().seed, 1, "the user's file was not touched");
}

#[test]
fn a_change_is_written_while_the_editor_runs_and_not_offered_to_another() {
    let fixture = Fixture::new();
    let journal = Journal::start(fixture.recovery());
    journal.note(fixture.note(5));
    let written = || {
        let entries = std::fs::read_dir(fixture.recovery()).into_iter().flatten().flatten();
        entries.map(|entry| entry.path()).any(|path| path.extension().is_some_and(|end| end == "json"))
    };
    let begun = std::time::Instant::now();
    while !written() && begun.elapsed() < PATIENCE {
        std::thread::sleep(Duration::from_millis(5));
    }
    assert!(written());
    assert!(recoverable(&fixture.recovery()).is_empty());
    assert_eq!(journal.problem(), None);
}

#[test]
fn a_clean_end_leaves_nothing() {
    let fixture = Fixture::new();
    let journal = Journal::start(fixture.recovery());
    journal.note(fixture.note(5));
    journal.clean();
    drop(journal);
    assert_eq!(fixture.files_in_recovery(), 0);

    drop({
        let journal = Journal::start(fixture.recovery());
        journal.note(fixture.note(5));
        journal
    });
    let found = recoverable(&fixture.recovery()).pop().unwrap();
    let journal = Journal::resume(found);
    assert!(recoverable(&fixture.recovery()).is_empty(), "it has an editor again");
    journal.clean();
    drop(journal);
    assert_eq!(fixture.files_in_recovery(), 0);
}

#[test]
fn work_that_is_recovered_is_safe_until_it_is_saved() {
    let fixture = Fixture::new();
    for seed in 2..5 {
        let journal = match recoverable(&fixture.recovery()).pop() {
            Some(found) => Journal::resume(found),
            None => Journal::start(fixture.recovery()),
        };
        journal.note(fixture.note(seed));
        drop(journal);
        // Taken up and lost again before anything was changed.
        drop(Journal::resume(recoverable(&fixture.recovery()).pop().unwrap()));
        let found = recoverable(&fixture.recovery());
        assert!(
            matches!(&found[..], [one] if one.work.as_ref().unwrap().project().seed == seed),
            "{found:?}"
        );
    }
}

#[test]
fn work_that_stands_in_its_file_is_not_offered() {
    let fixture = Fixture::new();
    let journal = Journal::start(fixture.recovery());
    let note = fixture.note(5);
    journal.note(note.clone());
    note.file.save(&fixture.path(), &note.project).unwrap();
    drop(journal);
    assert!(recoverable(&fixture.recovery()).is_empty());
    assert_eq!(fixture.files_in_recovery(), 0);
}

#[test]
fn it_is_told_when_the_file_was_changed_after_the_work() {
    let fixture = Fixture::new();
    let journal = Journal::start(fixture.recovery());
    let note = fixture.note(5);
    journal.note(note.clone());
    note.file.save(&fixture.path(), &with_seed(&note.file, 6)).unwrap();
    drop(journal);
    assert!(recoverable(&fixture.recovery())[0].file_changed);
}

#[test]
fn recovery_files_that_cannot_be_read_are_offered_with_the_reason_and_can_be_discarded() {
    let fixture = Fixture::new();
    std::fs::create_dir_all(fixture.recovery()).unwrap();
    for (name, text) in [
        ("a", ""),
        ("b", "{\"path\":null,\"title\":\"T\",\"time\":18446744073709551615,\"seen\":null,\"text\":\"{\"}"),
    ] {
        std::fs::write(fixture.recovery().join(name).with_extension("json"), text).unwrap();
    }
    let found = recoverable(&fixture.recovery());
    assert_eq!(found.len(), 2);
    for recovery in found {
        let message = recovery.work.as_ref().unwrap_err().to_string();
        assert!(message.contains(".json"), "{message}");
        recovery.discard().unwrap();
    }
    assert_eq!(fixture.files_in_recovery(), 0);
}

#[test]
fn a_journal_that_cannot_write_says_so() {
    let fixture = Fixture::new();
    // A file stands where the folder should be.
    std::fs::write(fixture.folder.path().join("state"), b"").unwrap();
    let journal = Journal::start(fixture.recovery());
    journal.note(fixture.note(5));
    let begun = std::time::Instant::now();
    while journal.problem().is_none() && begun.elapsed() < PATIENCE {
        std::thread::sleep(Duration::from_millis(5));
    }
    let problem = journal.problem().unwrap();
    assert!(problem.contains("recovery") && problem.contains("state"), "{problem}");
    std::fs::remove_file(fixture.folder.path().join("state")).unwrap();
    drop(journal);
    assert_eq!(recoverable(&fixture.recovery()).len(), 1, "tried again at the end");
}

#[test]
fn opening_and_saving_gives_the_same_bytes_and_no_backup() {
    let fixture = Fixture::new();
    let before = std::fs::read(fixture.path()).unwrap();
    let waiting = Waiting::new(&fixture);
    let opened = waiting.open(&fixture);
    let project = Arc::new(opened.file.project().clone());
    let save = fixture.save(opened.file, project, Some(opened.seen));
    assert!(
        matches!(waiting.ask(StoreRequest::Save(save)), StoreReply::Saved(_, Ok(saved)) if saved.seen == opened.seen)
    );
    assert_eq!(std::fs::read(fixture.path()).unwrap(), before);
    assert!(!fixture.folders().backups().exists());
}

#[test]
fn the_last_three_versions_are_kept_aside() {
    let fixture = Fixture::new();
    let waiting = Waiting::new(&fixture);
    let opened = waiting.open(&fixture);
    let mut seen = Some(opened.seen);
    let mut versions = vec![std::fs::read(fixture.path()).unwrap()];
    for seed in 2..7 {
        let project = with_seed(&opened.file, seed);
        let save = fixture.save(opened.file.clone(), project, seen);
        let StoreReply::Saved(_, Ok(saved)) = waiting.ask(StoreRequest::Save(save)) else {
            panic!("not saved")
        };
        assert_eq!(saved.note, None);
        seen = Some(saved.seen);
        let StoreReply::Attached(_, Hold::Here(None), backups) = waiting.attach(&fixture.path()) else {
            panic!("not held")
        };
        let kept: Vec<_> = backups.iter().map(|backup| std::fs::read(&backup.path).unwrap()).collect();
        let wanted: Vec<_> = versions.iter().rev().take(3).cloned().collect();
        assert_eq!(kept, wanted);
        versions.push(std::fs::read(fixture.path()).unwrap());
    }
}

#[test]
fn a_second_editor_neither_holds_nor_overwrites_the_file() {
    let fixture = Fixture::new();
    let (first, second) = (Waiting::new(&fixture), Waiting::new(&fixture));
    let opened = first.open(&fixture);
    assert!(matches!(first.attach(&fixture.path()), StoreReply::Attached(_, Hold::Here(None), _)));
    let StoreReply::Attached(_, Hold::Elsewhere(who), _) = second.attach(&fixture.path()) else {
        panic!("held twice")
    };
    assert!(who.contains(&std::process::id().to_string()), "{who}");
    let save = || fixture.save(opened.file.clone(), with_seed(&opened.file, 2), None);
    let StoreReply::Saved(_, Err(error)) = second.ask(StoreRequest::Save(save())) else {
        panic!("overwritten")
    };
    assert!(error.to_string().contains("another name"), "{error}");
    assert!(matches!(first.ask(StoreRequest::Save(save())), StoreReply::Saved(_, Ok(_))));
    drop(first);
    assert!(matches!(second.attach(&fixture.path()), StoreReply::Attached(_, Hold::Here(None), _)));
    drop(second);
    let left: Vec<_> =
        std::fs::read_dir(fixture.folder.path()).unwrap().map(|e| e.unwrap().file_name()).collect();
    assert!(left.iter().all(|name| !name.to_string_lossy().ends_with(".lock")), "{left:?}");
}

#[test]
fn what_another_program_changes_is_told_once_and_what_this_one_saves_is_not() {
    let fixture = Fixture::new();
    let waiting = Waiting::new(&fixture);
    let opened = waiting.open(&fixture);
    waiting.attach(&fixture.path());
    let project = with_seed(&opened.file, 2);
    let save = fixture.save(opened.file, project, None);
    assert!(matches!(waiting.ask(StoreRequest::Save(save)), StoreReply::Saved(..)));
    std::fs::write(fixture.path(), b"another's work").unwrap();
    waiting.woken.recv_timeout(PATIENCE).unwrap();
    let Some(StoreReply::ChangedMeanwhile(path, seen)) = waiting.saver.answer() else { panic!("not told") };
    assert_eq!((path, seen), (fixture.path(), Fingerprint::of(b"another's work")));
    assert!(waiting.saver.answer().is_none());
}

#[test]
fn files_from_elsewhere_are_copied_beside_the_project_or_trusted_for_good() {
    let fixture = Fixture::new();
    let far = tempfile::tempdir().unwrap();
    let at = |name: &str| far.path().canonicalize().unwrap().join(name);
    for name in ["picked.png", "trusted.png", "refused.png"] {
        std::fs::write(at(name), name).unwrap();
    }
    let waiting = Waiting::new(&fixture);
    let file = fixture.file();
    let mut project = file.project().clone();
    let name = |name: &str| relative(&at(name), &fixture.path());
    project.keys[0].shows = Shows::Image(ImageTarget::new(name("picked.png")));
    project.keys[1].shows = Shows::Image(ImageTarget::new(name("trusted.png")));
    let project = Arc::new(project);
    waiting.saver.ask(StoreRequest::Trust(vec![at("trusted.png")]));
    let origin =
        |admitted| Origin { file: fixture.path(), admitted, trusted: trusted(Some(&fixture.folders())) };
    let find = StoreRequest::FindOutside(project.clone(), origin(Admitted::default()));
    let StoreReply::Outside(_, outside) = waiting.ask(find) else { panic!("no answer") };
    assert_eq!(outside, [at("picked.png"), at("trusted.png")]);
    assert_eq!(trusted(Some(&fixture.folders())).files(), [at("trusted.png")]);

    let admitted = Admitted::new([at("picked.png"), at("trusted.png")]);
    let save =
        SaveRequest { path: fixture.path(), file, project, origin: Some(origin(admitted)), seen: None };
    let StoreReply::Saved(_, Ok(saved)) = waiting.ask(StoreRequest::Save(save)) else { panic!("not saved") };
    assert_eq!(saved.copied, 1);
    let read = Project::load(&fixture.path()).unwrap();
    assert_eq!(read, *saved.project);
    assert_eq!(read.files(), ["assets/picked.png", &*name("trusted.png")]);
    assert_eq!(std::fs::read(fixture.folder.path().join("assets/picked.png")).unwrap(), b"picked.png");
    // What reads the trust list finds both.
    let assets =
        AssetFolder::new(&fixture.path(), false).unwrap().admitting(trusted(Some(&fixture.folders())));
    for file in read.files() {
        assets.resolve(file, "file").unwrap();
    }
    assert!(assets.resolve(&name("refused.png"), "file").is_err());
    waiting.saver.ask(StoreRequest::ForgetTrusted);
    drop(waiting);
    assert!(trusted(Some(&fixture.folders())).files().is_empty());
}

#[test]
fn a_file_that_another_program_changed_is_replaced_only_when_asked() {
    let fixture = Fixture::new();
    let waiting = Waiting::new(&fixture);
    let opened = waiting.open(&fixture);
    std::fs::write(fixture.path(), b"somebody else's work").unwrap();
    let project = with_seed(&opened.file, 2);
    let save = fixture.save(opened.file, project, Some(opened.seen));
    let StoreReply::ChangedOnDisk(save) = waiting.ask(StoreRequest::Save(save)) else {
        panic!("not noticed")
    };
    assert_eq!(std::fs::read(fixture.path()).unwrap(), b"somebody else's work");
    assert!(matches!(
        waiting.ask(StoreRequest::Save(SaveRequest { seen: None, ..save })),
        StoreReply::Saved(_, Ok(_))
    ));
    assert_eq!(fixture.file().project().seed, 2);
}

#[test]
fn a_file_that_was_deleted_is_no_changed_one() {
    let fixture = Fixture::new();
    let waiting = Waiting::new(&fixture);
    let opened = waiting.open(&fixture);
    std::fs::remove_file(fixture.path()).unwrap();
    let project = with_seed(&opened.file, 3);
    let save = fixture.save(opened.file, project, Some(opened.seen));
    assert!(matches!(waiting.ask(StoreRequest::Save(save)), StoreReply::Saved(_, Ok(_))));
    assert_eq!(fixture.file().project().seed, 3);
}

#[test]
fn what_cannot_be_opened_or_saved_is_an_answer_and_changes_nothing() {
    let fixture = Fixture::new();
    let waiting = Waiting::new(&fixture);
    let none = fixture.folder.path().join("none.json");
    assert!(matches!(waiting.ask(StoreRequest::Open(none)), StoreReply::Opened(_, Err(_))));
    let opened = waiting.open(&fixture);
    let before = std::fs::read(fixture.path()).unwrap();
    let mut bad = opened.file.project().clone();
    bad.flow.gamma = 7.0;
    let save = |path: PathBuf, project: Project| {
        let (file, project) = (opened.file.clone(), Arc::new(project));
        match waiting.ask(StoreRequest::Save(SaveRequest { path, file, project, origin: None, seen: None })) {
            StoreReply::Saved(_, Err(error)) => error.to_string(),
            other => panic!("{other:?}"),
        }
    };
    assert!(save(fixture.path(), bad).contains("flow.gamma"));
    let good = opened.file.project().clone();
    assert!(save(fixture.folder.path().join("no/such/folder.json"), good.clone()).contains("no/such"));
    assert!(save(fixture.folder.path().to_owned(), good.clone()).contains("folder"));
    let mut protected = std::fs::metadata(fixture.path()).unwrap().permissions();
    protected.set_readonly(true);
    std::fs::set_permissions(fixture.path(), protected).unwrap();
    assert!(save(fixture.path(), good).contains("write-protected"));
    assert_eq!(std::fs::read(fixture.path()).unwrap(), before);
}

#[cfg(unix)]
#[test]
fn saving_through_a_link_writes_the_file_behind_it() {
    let fixture = Fixture::new();
    let link = fixture.folder.path().join("link.json");
    std::os::unix::fs::symlink("shot.json", &link).unwrap();
    let waiting = Waiting::new(&fixture);
    let opened = waiting.open(&fixture);
    let project = with_seed(&opened.file, 2);
    let save =
        SaveRequest { path: link.clone(), file: opened.file, project, origin: None, seen: Some(opened.seen) };
    assert!(matches!(waiting.ask(StoreRequest::Save(save)), StoreReply::Saved(_, Ok(_))));
    assert!(link.is_symlink());
    assert_eq!(fixture.file().project().seed, 2);
}

#[test]
fn what_was_asked_for_is_done_before_the_saver_goes() {
    let fixture = Fixture::new();
    let waiting = Waiting::new(&fixture);
    let file = fixture.file();
    let project = with_seed(&file, 2);
    waiting.saver.ask(StoreRequest::Save(SaveRequest {
        path: fixture.path(),
        file,
        project,
        origin: None,
        seen: None,
    }));
    let mut preferences = Preferences::default();
    preferences.add_recent(&fixture.path());
    waiting.saver.ask(StoreRequest::Remember(Box::new(preferences.clone())));
    drop(waiting);
    assert_eq!(fixture.file().project().seed, 2);
    assert_eq!(Preferences::load(&fixture.folders().config), (preferences, None));
}

#[test]
fn lost_work_is_looked_for_and_discarded_by_the_saver() {
    let fixture = Fixture::new();
    let journal = Journal::start(fixture.recovery());
    journal.note(fixture.note(5));
    drop(journal);
    let waiting = Waiting::new(&fixture);
    let StoreReply::Lost(mut found) = waiting.ask(StoreRequest::LookForLost) else { panic!("no answer") };
    waiting.saver.ask(StoreRequest::Discard(Box::new(found.pop().unwrap())));
    assert!(matches!(waiting.ask(StoreRequest::LookForLost), StoreReply::Lost(none) if none.is_empty()));
    assert_eq!(fixture.files_in_recovery(), 0);
}
