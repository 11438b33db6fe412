//! The editor's store is killed fifty times while it edits and saves: the file is always a whole version, and what is not in
//! it is offered for recovery.
//!
//! The test starts itself again as the victim: [`victim_edits_and_saves`] does nothing unless a folder is named to it.

use std::collections::hash_map::RandomState;
use std::hash::{BuildHasher as _, Hasher as _};
use std::io::{BufRead as _, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use lightloom::editor::store::{
    Folders, Hold, Journal, Note, SaveRequest, Saver, StoreReply, StoreRequest, recoverable,
};
use lightloom_core::constraint::{Constraint, Wall};
use lightloom_core::project::ProjectFile;

const FOLDER: &str = "LIGHTLOOM_TEST_VICTIM_FOLDER";
const SAVES: &str = "LIGHTLOOM_TEST_VICTIM_SAVES";
const START: &str = "LIGHTLOOM_TEST_VICTIM_START";

/// Rounds, unless [`MORE`] names another number.
const ROUNDS: usize = 50;
const MORE: &str = "LIGHTLOOM_KILL_ROUNDS";
/// What was changed longer ago than this must be offered.
const PROMISED: Duration = Duration::from_secs(2);
/// A victim whose test was broken off ends by itself.
const LONGEST_LIFE: Duration = Duration::from_secs(20);

/// Nobody shall know beforehand when the kill comes.
fn random_millis(from: u64, to: u64) -> Duration {
    Duration::from_millis(from + RandomState::new().build_hasher().finish() % (to - from))
}

fn millis_now() -> u128 {
    SystemTime::now().duration_since(UNIX_EPOCH).unwrap().as_millis()
}

fn folders(folder: &Path) -> Folders {
    Folders { state: folder.join("state"), config: folder.join("config") }
}

fn file_in(folder: &Path) -> PathBuf {
    folder.join("work/shot.json")
}

/// Takes a line of a victim's report apart: what it did, the number of the change, and when.
fn report(line: &str) -> Option<(&str, u64, u128)> {
    let mut words = line.split(' ');
    let what = words.next().filter(|what| ["changed", "saving", "saved"].contains(what))?;
    Some((what, words.next()?.parse().ok()?, words.next()?.parse().ok()?))
}

/// Edits and saves until it is killed, and says what it did. The number of a change is the project's seed.
#[test]
fn victim_edits_and_saves() {
    let Some(folder) = std::env::var_os(FOLDER).map(PathBuf::from) else { return };
    let saves = std::env::var(SAVES).unwrap() == "yes";
    let mut number: u64 = std::env::var(START).unwrap().parse().unwrap();
    let path = file_in(&folder);
    let say = |what: &str, number: u64| println!("{what} {number} {}", millis_now());

    let (wake, woken) = channel();
    let saver = Saver::start(folders(&folder), move || wake.send(()).unwrap()).unwrap();
    let journal = Journal::start(folders(&folder).recovery());
    saver.ask(StoreRequest::Open(path.clone()));
    woken.recv().unwrap();
    let Some(StoreReply::Opened(_, Ok(opened))) = saver.answer() else { panic!("not opened") };
    // The lock of the one before, who was killed, is taken over.
    saver.ask(StoreRequest::Attach(Some((path.clone(), opened.seen))));
    woken.recv().unwrap();
    assert!(matches!(saver.answer(), Some(StoreReply::Attached(_, Hold::Here(_), _))));
    let mut seen = Some(opened.seen);
    let mut saving = false;
    let born = Instant::now();
    while born.elapsed() < LONGEST_LIFE {
        number += 1;
        let mut project = opened.file.project().clone();
        project.seed = number;
        let project = Arc::new(project);
        journal.note(Note {
            path: Some(path.clone()),
            title: "shot".into(),
            file: opened.file.clone(),
            project: project.clone(),
            seen,
            base: path.clone(),
            admitted: Vec::new(),
        });
        say("changed", number);
        if saves && !saving && number.is_multiple_of(3) {
            say("saving", number);
            saver.ask(StoreRequest::Save(SaveRequest {
                path: path.clone(),
                file: opened.file.clone(),
                project,
                origin: None,
                seen,
            }));
            saving = true;
            if number.is_multiple_of(2) {
                woken.recv().unwrap();
            }
        }
        match saver.answer() {
            Some(StoreReply::Saved(request, Ok(saved))) => {
                say("saved", request.project.seed);
                seen = Some(saved.seen);
                saving = false;
                if request.project.seed == number {
                    journal.clean();
                }
            }
            None => {}
            other => panic!("{other:?}"),
        }
        std::thread::sleep(random_millis(1, 20));
    }
}

/// What the victims have said so far.
#[derive(Default)]
struct Said {
    /// Each change and when it was made, milliseconds since 1970.
    changes: Vec<(u64, u128)>,
    /// The last change whose saving was begun, and the last whose saving was over.
    saving: u64,
    saved: u64,
}

/// Lets a victim live for `life` after its first change. Returns the time of the kill, milliseconds since 1970.
fn live_and_die(folder: &Path, start: u64, saves: bool, life: Duration, said: &Arc<Mutex<Said>>) -> u128 {
    let mut victim = Command::new(std::env::current_exe().unwrap())
        .args(["--exact", "crash::victim_edits_and_saves", "--nocapture"])
        .env(FOLDER, folder)
        .env(SAVES, if saves { "yes" } else { "no" })
        .env(START, start.to_string())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let lines = BufReader::new(victim.stdout.take().unwrap()).lines();
    let (first, begun): (_, Receiver<()>) = channel();
    let listener = {
        let said = said.clone();
        std::thread::spawn(move || {
            for line in lines.map_while(Result::ok) {
                let mut said = said.lock().unwrap();
                match report(&line) {
                    Some(("changed", number, time)) => said.changes.push((number, time)),
                    Some(("saving", number, _)) => said.saving = number,
                    Some((_, number, _)) => said.saved = number,
                    None => continue,
                }
                let _ = first.send(());
            }
        })
    };
    begun.recv_timeout(LONGEST_LIFE).expect("the victim never began");
    std::thread::sleep(life);
    let killed = millis_now();
    victim.kill().unwrap();
    victim.wait().unwrap();
    listener.join().unwrap();
    killed
}

/// A project large enough for a kill to meet it half written.
fn large_project() -> ProjectFile {
    let example = Path::new(env!("CARGO_MANIFEST_DIR")).join("projects/letters_free.json");
    let (example, _) = ProjectFile::open(&example).unwrap();
    let mut project = example.project().clone();
    project.constraints.push(Constraint::Wall(Wall {
        name: "coast".into(),
        points: (0..5000).map(|i| [i as f32 / 5000.0, 0.5]).collect(),
        thickness: 0.02,
        span: None,
        enabled: true,
        locked: false,
        group: String::new(),
    }));
    ProjectFile::new(project).unwrap()
}

fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).into_iter().flatten();
    entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
}

/// The user's file is a whole version, whose number comes back; nothing beside it could be taken for it, and the backups
/// are whole too.
fn require_whole_files(folder: &Path, original: &ProjectFile) -> u64 {
    let text = std::fs::read_to_string(file_in(folder)).unwrap();
    let (file, notes) = ProjectFile::parse(text.as_bytes(), Path::new("shot.json")).unwrap();
    let mut whole = original.project().clone();
    whole.seed = file.project().seed;
    assert!(notes.is_empty() && text == original.text_of(&whole).unwrap(), "{}", whole.seed);
    let half_written = |name: &str| name.starts_with(".lightloom-") && name.ends_with(".tmp");
    for name in names(&folder.join("work")) {
        assert!(half_written(&name) || ["shot.json", ".shot.json.lock"].contains(&&*name), "{name}");
    }
    for name in names(&folders(folder).backups()).iter().filter(|name| !half_written(name)) {
        assert!(ProjectFile::open(&folders(folder).backups().join(name)).is_ok(), "{name}");
    }
    whole.seed
}

#[test]
fn killed_fifty_times_nothing_older_than_two_seconds_is_lost() {
    let root = tempfile::tempdir().unwrap();
    let folder = root.path();
    std::fs::create_dir_all(folder.join("work")).unwrap();
    let original = large_project();
    original.save(&file_in(folder), original.project()).unwrap();
    let said = Arc::new(Mutex::new(Said::default()));
    let (mut offered, mut old_changes) = (0, 0);
    let mut newest = original.project().seed;
    let mut in_file = newest;

    let rounds = std::env::var(MORE).map_or(ROUNDS, |rounds| rounds.parse().unwrap());
    for round in 0..rounds {
        let life = if round % 10 == 9 { random_millis(2300, 3000) } else { random_millis(1, 800) };
        let saves = round % 3 != 0;
        *said.lock().unwrap() = Said { saving: in_file, saved: in_file, ..Said::default() };
        let killed = live_and_die(folder, newest, saves, life, &said);
        let said = said.lock().unwrap();

        in_file = require_whole_files(folder, &original);
        assert!((said.saved..=said.saving).contains(&in_file), "round {round}: {in_file}");

        // What is neither in the file nor offered was changed a moment ago.
        let mut kept = in_file;
        for recovery in recoverable(&folders(folder).recovery()) {
            assert_eq!(recovery.path, Some(file_in(folder)));
            kept = kept.max(recovery.work.as_ref().unwrap().project().seed);
            recovery.discard().unwrap();
            offered += 1;
        }
        let old = said.changes.iter().filter(|(_, time)| time + PROMISED.as_millis() <= killed);
        let promised = old.clone().map(|(number, _)| *number).max().unwrap_or(0);
        assert!(kept >= promised, "round {round}: kept {kept}, lost {promised}");
        old_changes += old.count();
        newest = kept;
    }
    println!(
        "{rounds} kills, {newest} changes kept, {old_changes} older than 2 s, recovery offered {offered} times"
    );
    assert!(old_changes > 0, "no victim lived long enough");
    assert!(offered > 0, "nothing was ever offered");
}
