//! The autosave journal: every change of the open document is on disk within half a second, outside the user's file.

use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use lightloom_core::project::{Project, ProjectFile};
use lightloom_core::{Error, Result};

use super::record::Record;
use super::slot::JournalSlot;
use super::{Fingerprint, Recovery, disk};
use crate::editor::guard::Guard;

/// Delay in which changes are batched.
const GATHER: Duration = Duration::from_millis(400);
/// Delay before a failed write is retried.
const RETRY: Duration = Duration::from_secs(2);

/// The document after a change. Creating one copies pointers only.
#[derive(Clone, Debug)]
pub struct Note {
    /// The document's file; none where it was never saved.
    pub path: Option<PathBuf>,
    /// The title under which it is offered for recovery.
    pub title: String,
    /// The file the project came from.
    pub file: Arc<ProjectFile>,
    /// The current project.
    pub project: Arc<Project>,
    /// Fingerprint of the document's file when last read or saved; none where it was never saved.
    pub seen: Option<Fingerprint>,
    /// The file, existing or not, that the paths of the project are relative to.
    pub base: PathBuf,
    /// Files outside of its folder that the user let it read.
    pub admitted: Vec<PathBuf>,
}

/// The journal of one open document. Dropped without [`clean`](Self::clean), it writes pending changes and leaves its
/// file for recovery.
#[derive(Debug)]
pub struct Journal {
    messages: Option<Sender<Message>>,
    writer: Option<JoinHandle<()>>,
    problem: Problem,
}

enum Message {
    Note(Box<Note>, SystemTime),
    Clean,
}

impl Journal {
    /// A journal in `folder`, which is created on the first write.
    pub fn start(folder: PathBuf) -> Self {
        Self::run(folder, None)
    }

    /// Continues the journal of a recovered document in its own file, so that the work
    /// is never without a copy on disk.
    pub fn resume(recovery: Recovery) -> Self {
        let slot = recovery.into_slot();
        Self::run(slot.file().parent().unwrap_or(Path::new(".")).to_owned(), Some(slot))
    }

    fn run(folder: PathBuf, slot: Option<JournalSlot>) -> Self {
        let (messages, inbox) = channel();
        let problem = Problem::default();
        let writer = Writer { folder, slot, problem: problem.clone(), guard: Guard::new("journal") };
        let thread = std::thread::Builder::new().name("journal".into());
        let writer = match thread.spawn(move || writer.serve(&inbox)) {
            Ok(writer) => Some(writer),
            Err(error) => {
                problem.set(Some(format!("changes are not kept for recovery: {error}; save often")));
                None
            }
        };
        Self { messages: Some(messages), writer, problem }
    }

    /// Schedules the document to be written. Takes microseconds.
    pub fn note(&self, note: Note) {
        self.send(Message::Note(Box::new(note), SystemTime::now()));
    }

    /// Removes the journal's file: all changes were saved or discarded.
    /// After a save, call it only if nothing changed since the save was requested.
    pub fn clean(&self) {
        self.send(Message::Clean);
    }

    /// Why the last change could not be written, if so.
    pub fn problem(&self) -> Option<String> {
        self.problem.get()
    }

    fn send(&self, message: Message) {
        if self.writer.as_ref().is_some_and(JoinHandle::is_finished) {
            self.problem.set(Some("changes are no longer kept for recovery; save and start anew".into()));
        }
        if let Some(messages) = &self.messages {
            // Fails only where the thread is gone, which was just said.
            let _ = messages.send(message);
        }
    }
}

impl Drop for Journal {
    fn drop(&mut self) {
        // The closed channel ends the thread, after it has written what it has.
        self.messages = None;
        if let Some(writer) = self.writer.take() {
            let _ = writer.join();
        }
    }
}

/// The thread's last problem, shared with the window.
#[derive(Clone, Debug, Default)]
struct Problem(Arc<Mutex<Option<String>>>);

impl Problem {
    fn set(&self, problem: Option<String>) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = problem;
    }

    fn get(&self) -> Option<String> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

struct Writer {
    folder: PathBuf,
    slot: Option<JournalSlot>,
    problem: Problem,
    guard: Guard,
}

/// The newest change not written yet, and when it is due.
struct Pending {
    due: Instant,
    note: Box<Note>,
    time: SystemTime,
}

impl Writer {
    fn serve(mut self, inbox: &Receiver<Message>) {
        let mut pending: Option<Pending> = None;
        loop {
            let wait = pending.as_ref().map(|pending| pending.due.saturating_duration_since(Instant::now()));
            let message = match wait {
                None => inbox.recv().map_err(|_| RecvTimeoutError::Disconnected),
                // Due is due, also while changes keep coming in.
                Some(Duration::ZERO) => Err(RecvTimeoutError::Timeout),
                Some(wait) => inbox.recv_timeout(wait),
            };
            match message {
                Ok(Message::Note(note, time)) => {
                    let due = pending.map_or_else(|| Instant::now() + GATHER, |pending| pending.due);
                    pending = Some(Pending { due, note, time });
                }
                Ok(Message::Clean) => {
                    pending = None;
                    let cleared = self.slot.as_ref().map_or(Ok(()), JournalSlot::clear);
                    self.problem.set(cleared.err().map(|error| error.to_string()));
                }
                Err(RecvTimeoutError::Timeout) => pending = pending.and_then(|pending| self.attempt(pending)),
                Err(RecvTimeoutError::Disconnected) => {
                    pending.and_then(|pending| self.attempt(pending));
                    return;
                }
            }
        }
    }

    /// Writes a change; returns it for another attempt on failure.
    fn attempt(&mut self, pending: Pending) -> Option<Pending> {
        let guard = self.guard.clone();
        let written = guard.run(|| self.write(&pending).map_err(|error| error.to_string()));
        let written = written.unwrap_or_else(|words| Err(format!("a fault of the program: {words}")));
        let failed = written.is_err();
        self.problem.set(
            written.err().map(|error| format!("changes are not kept for recovery: {error}; save often")),
        );
        failed.then(|| Pending { due: Instant::now() + RETRY, ..pending })
    }

    fn write(&mut self, Pending { note, time, .. }: &Pending) -> Result<()> {
        let record = Record {
            // JSON knows no path that is not UTF-8: such a document is offered as one without file.
            path: note.path.as_ref().filter(|path| path.to_str().is_some()).map(|path| absolute(path)),
            title: note.title.clone(),
            time: time.duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs()),
            seen: note.seen,
            base: Some(absolute(&note.base)).filter(|path| path.to_str().is_some()),
            admitted: note.admitted.iter().filter(|path| path.to_str().is_some()).cloned().collect(),
            text: note.file.text_of(&note.project)?,
        };
        let bytes = serde_json::to_vec(&record)
            .map_err(|e| Error::value("journal", format!("cannot be written as JSON: {e}")))?;
        let slot = match self.slot.take() {
            Some(slot) => slot,
            None => JournalSlot::new(&self.folder)?,
        };
        let slot = self.slot.insert(slot);
        disk::write(slot.file(), &bytes)
    }
}

/// The absolute path: the editor may start elsewhere next time.
fn absolute(path: &Path) -> PathBuf {
    std::path::absolute(path).unwrap_or_else(|_| path.to_owned())
}
