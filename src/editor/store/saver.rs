//! The file thread: opens and saves, so that the window never waits for a disk.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::JoinHandle;

use lightloom_core::project::{Project, ProjectFile};
use lightloom_core::{Error, Result, files};

use super::{Fingerprint, Folders, Preferences, Recovery, disk, recoverable};

/// Maximum size of a project file; a larger file is not overwritten.
const MOST_BYTES: u64 = 64 << 20;

/// A request to the saver; replies come in the same order.
#[derive(Debug)]
pub enum StoreRequest {
    /// Reads a project file.
    Open(PathBuf),
    /// Writes a project file.
    Save(SaveRequest),
    /// Looks for work that a crash left.
    LookForLost,
    /// Deletes such work.
    Discard(Box<Recovery>),
    /// Writes the preferences.
    Remember(Box<Preferences>),
}

/// A request to save a project.
#[derive(Clone, Debug)]
pub struct SaveRequest {
    /// Destination.
    pub path: PathBuf,
    /// The file it was read from.
    pub file: Arc<ProjectFile>,
    /// The current project.
    pub project: Arc<Project>,
    /// Expected fingerprint of the file at `path`; none overwrites whatever is there.
    pub seen: Option<Fingerprint>,
}

/// The reply to a request.
#[derive(Debug)]
pub enum StoreReply {
    /// A file was read, or why not.
    Opened(PathBuf, Result<Opened>),
    /// A project was written, or why not; then the old file is unchanged.
    Saved(SaveRequest, Result<Saved>),
    /// Nothing was written: another program changed the file since it was last read or written. Repeated with `seen`
    /// none, the request overwrites it.
    ChangedOnDisk(SaveRequest),
    /// Recoverable work, newest first.
    Lost(Vec<Recovery>),
    /// Another request failed, for this reason.
    Failed(String),
}

/// A file that was read.
#[derive(Clone, Debug)]
pub struct Opened {
    /// The file.
    pub file: Arc<ProjectFile>,
    /// Notes on content that this program does not know.
    pub notes: Vec<String>,
    /// Its fingerprint.
    pub seen: Fingerprint,
}

/// A file that was written.
#[derive(Clone, Debug)]
pub struct Saved {
    /// Its new fingerprint.
    pub seen: Fingerprint,
    /// Why there is no backup of the previous version, if so.
    pub note: Option<String>,
}

/// The handle of the file thread. Dropping it waits for all requests.
#[derive(Debug)]
pub struct Saver {
    requests: Option<Sender<StoreRequest>>,
    answers: Receiver<StoreReply>,
    thread: Option<JoinHandle<()>>,
}

impl Saver {
    /// Starts the thread. `wake` is called on it after each reply.
    ///
    /// # Errors
    /// The system starts no thread.
    pub fn start(folders: Folders, wake: impl Fn() + Send + 'static) -> Result<Self> {
        let (requests, inbox) = channel::<StoreRequest>();
        let (outbox, answers) = channel();
        let serve = move || {
            for request in inbox {
                let answer = catch_unwind(AssertUnwindSafe(|| answer(&folders, request)));
                let failed =
                    || Some(StoreReply::Failed("an internal error; the file may not be saved".into()));
                let Some(answer) = answer.unwrap_or_else(|_| failed()) else { continue };
                if outbox.send(answer).is_err() {
                    // The window is gone; what it asked for is done all the same.
                    continue;
                }
                wake();
            }
        };
        let thread = std::thread::Builder::new().name("saver".into()).spawn(serve);
        let thread = thread.map_err(Error::io("start a thread for", "files"))?;
        Ok(Self { requests: Some(requests), answers, thread: Some(thread) })
    }

    /// Sends a request; returns at once.
    pub fn ask(&self, request: StoreRequest) {
        if let Some(requests) = &self.requests {
            // The thread ends only after this sender.
            let _ = requests.send(request);
        }
    }

    /// The next reply, if any.
    pub fn answer(&self) -> Option<StoreReply> {
        self.answers.try_recv().ok()
    }
}

impl Drop for Saver {
    fn drop(&mut self) {
        self.requests = None;
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

fn answer(folders: &Folders, request: StoreRequest) -> Option<StoreReply> {
    let failed = |result: Result<()>| result.err().map(|error| StoreReply::Failed(error.to_string()));
    match request {
        StoreRequest::Open(path) => {
            let opened = open(&path);
            Some(StoreReply::Opened(path, opened))
        }
        StoreRequest::Save(request) => Some(match save(folders, &request) {
            Ok(Some(saved)) => StoreReply::Saved(request, Ok(saved)),
            Ok(None) => StoreReply::ChangedOnDisk(request),
            Err(error) => StoreReply::Saved(request, Err(error)),
        }),
        StoreRequest::LookForLost => Some(StoreReply::Lost(recoverable(&folders.recovery()))),
        StoreRequest::Discard(recovery) => failed(recovery.discard()),
        StoreRequest::Remember(preferences) => failed(preferences.save(&folders.config)),
    }
}

fn open(path: &Path) -> Result<Opened> {
    let bytes = files::read_regular_file(path, MOST_BYTES)?;
    let (file, notes) = ProjectFile::parse(&bytes, path)?;
    Ok(Opened { file: Arc::new(file), notes, seen: Fingerprint::of(&bytes) })
}

/// Saves a project; none where the file does not have the expected fingerprint.
fn save(folders: &Folders, request: &SaveRequest) -> Result<Option<Saved>> {
    // Through a link the file behind it is written; the link stays.
    let path = request.path.canonicalize().unwrap_or_else(|_| request.path.clone());
    let old = present(&path)?;
    if let (Some(old), Some(seen)) = (&old, request.seen)
        && Fingerprint::of(old) != seen
    {
        return Ok(None);
    }
    let text = request.file.save(&path, &request.project)?;
    let backup = old.filter(|old| old != text.as_bytes()).map(|old| keep(folders, &path, &old));
    if let Some(folder) = path.parent() {
        disk::sweep(folder);
    }
    let note = backup.and_then(Result::err).map(|error| format!("saved, but without backup: {error}"));
    Ok(Some(Saved { seen: Fingerprint::of(text.as_bytes()), note }))
}

/// The content of the file at `path`; none where there is none. Refuses a file that must not be overwritten.
fn present(path: &Path) -> Result<Option<Vec<u8>>> {
    match std::fs::metadata(path) {
        Ok(data) if data.permissions().readonly() => {
            Err(Error::format(path, "", "is write-protected; save under another name"))
        }
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(None),
        Ok(_) | Err(_) => files::read_regular_file(path, MOST_BYTES).map(Some),
    }
}

/// Writes a backup of the previous version. The name contains a hash of the folder, so that equal names do not collide.
fn keep(folders: &Folders, path: &Path, old: &[u8]) -> Result<()> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let folder = Fingerprint::of(path.as_os_str().as_encoded_bytes()).short();
    disk::write(&folders.backups().join(format!("{name}.{folder}.bak")), old)
}
