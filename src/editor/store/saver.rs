//! The file thread: opens and saves, so that the window never waits for a disk.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread::JoinHandle;

use std::time::{Duration, Instant};

use lightloom_core::project::{AssetFolder, Project, ProjectFile};
use lightloom_core::{Error, Result, files};

use super::attached::{Attached, Hold, other_owner};
use super::backups::{self, Backup};
use super::save::{MOST_BYTES, Origin, SaveRequest, Saved, save};
use super::{Fingerprint, Folders, Preferences, Recovery, recoverable, trust};
use crate::editor::guard::Guard;

/// How often the file of the open document is looked at.
const TICK: Duration = Duration::from_secs(1);
/// How long an editor that was killed may still hold its files while the system clears it away.
const DYING: Duration = Duration::from_millis(if cfg!(test) { 60_000 } else { 1500 });
/// How often it is looked meanwhile whether it does.
const LOOK: Duration = Duration::from_millis(150);

/// A request to the saver; replies come in the same order.
#[derive(Debug)]
pub enum StoreRequest {
    /// Reads a project file.
    Open(PathBuf),
    /// Writes a project file.
    Save(SaveRequest),
    /// Holds and watches the file of the open document, which has this fingerprint; none releases the last one.
    Attach(Option<(PathBuf, Fingerprint)>),
    /// Finds the files of a project that lie outside of its folder and are not admitted.
    FindOutside(Arc<Project>, Origin),
    /// Finds whether the file picked for a purpose, which the window knows, lies outside and is not admitted.
    Locate(PathBuf, Origin),
    /// Adds files to the trust list.
    Trust(Vec<PathBuf>),
    /// Empties the trust list.
    ForgetTrusted,
    /// Looks for work that a crash left.
    LookForLost,
    /// Deletes such work.
    Discard(Box<Recovery>),
    /// Writes the preferences.
    Remember(Box<Preferences>),
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
    /// The file of the open document: whether it may be saved there, and its backups, newest first.
    Attached(PathBuf, Hold, Vec<Backup>),
    /// Another program changed the file of the open document; its new fingerprint.
    ChangedMeanwhile(PathBuf, Fingerprint),
    /// The files of this project that lie outside of its folder and are not admitted.
    Outside(Arc<Project>, Vec<PathBuf>),
    /// Whether a picked file lies outside.
    Located(PathBuf, bool),
    /// Recoverable work, newest first.
    Lost(Vec<Recovery>),
    /// Another request failed, for this reason.
    Failed(String),
    /// A fault of the program ended a request; what a panic said.
    Fault(String),
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
        let guard = Guard::new("saver");
        let serve = move || {
            let mut server = Server { folders, attached: None };
            loop {
                let request = match inbox.recv_timeout(TICK) {
                    Ok(request) => Some(request),
                    Err(RecvTimeoutError::Timeout) => None,
                    Err(RecvTimeoutError::Disconnected) => return,
                };
                let answer = guard.run(|| match request {
                    Some(request) => server.answer(request),
                    None => server.tick(),
                });
                let Some(answer) = answer.unwrap_or_else(|words| Some(StoreReply::Fault(words))) else {
                    continue;
                };
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

/// What the file thread works on.
struct Server {
    folders: Folders,
    attached: Option<Attached>,
}

impl Server {
    fn tick(&mut self) -> Option<StoreReply> {
        let (path, seen) = self.attached.as_mut()?.tick()?;
        Some(StoreReply::ChangedMeanwhile(path, seen))
    }

    fn answer(&mut self, request: StoreRequest) -> Option<StoreReply> {
        let folders = &self.folders;
        let failed = |result: Result<()>| result.err().map(|error| StoreReply::Failed(error.to_string()));
        match request {
            StoreRequest::Open(path) => {
                let opened = open(&path);
                Some(StoreReply::Opened(path, opened))
            }
            StoreRequest::Save(request) => Some(self.save(request)),
            StoreRequest::Attach(None) => {
                self.attached = None;
                None
            }
            StoreRequest::Attach(Some((path, seen))) => Some(self.attach(path, seen)),
            StoreRequest::FindOutside(project, origin) => {
                let outside = outside(&project, &origin).unwrap_or_default();
                Some(StoreReply::Outside(project, outside))
            }
            StoreRequest::Locate(path, origin) => {
                let outside = is_outside(&path, &origin).unwrap_or(false);
                Some(StoreReply::Located(path, outside))
            }
            StoreRequest::Trust(files) => failed(trust::trust(folders, &files)),
            StoreRequest::ForgetTrusted => failed(trust::forget(folders)),
            StoreRequest::LookForLost => Some(StoreReply::Lost(recoverable(&folders.recovery()))),
            StoreRequest::Discard(recovery) => failed(recovery.discard()),
            StoreRequest::Remember(preferences) => failed(preferences.save(&folders.config)),
        }
    }

    fn attach(&mut self, path: PathBuf, seen: Fingerprint) -> StoreReply {
        let begun = Instant::now();
        let hold = loop {
            let (attached, hold) = Attached::new(path.clone(), seen, self.attached.take());
            self.attached = Some(attached);
            if matches!(hold, Hold::Here(_)) || begun.elapsed() > DYING {
                break hold;
            }
            std::thread::sleep(LOOK);
        };
        let real = path.canonicalize().unwrap_or_else(|_| path.clone());
        StoreReply::Attached(path, hold, backups::of(&self.folders, &real))
    }

    fn save(&mut self, request: SaveRequest) -> StoreReply {
        let own = self.attached.as_ref().is_some_and(|attached| attached.holds(&request.path));
        if !own && let Some(who) = other_owner(&request.path) {
            let what = format!("is open in {who}; save under another name");
            let error = Error::format(&request.path, "", what);
            return StoreReply::Saved(request, Err(error));
        }
        match save(&self.folders, &request) {
            Ok(Some(saved)) => {
                self.attached.iter_mut().for_each(|attached| attached.written(&request.path, saved.seen));
                StoreReply::Saved(request, Ok(saved))
            }
            Ok(None) => StoreReply::ChangedOnDisk(request),
            Err(error) => StoreReply::Saved(request, Err(error)),
        }
    }
}

/// The files of a project that are there, but outside of its folder and not admitted.
fn outside(project: &Project, origin: &Origin) -> Result<Vec<PathBuf>> {
    let folder = origin.file.parent().unwrap_or(Path::new(""));
    let real = project.files().into_iter().filter_map(|file| folder.join(file).canonicalize().ok());
    let assets = AssetFolder::new(&origin.file, false)?.admitting(origin.admitted.clone());
    let mut outside: Vec<_> = real.filter(|real| real.is_file() && !assets.allows(real)).collect();
    outside.sort();
    outside.dedup();
    Ok(outside)
}

fn is_outside(path: &Path, origin: &Origin) -> Result<bool> {
    let real = path.canonicalize().map_err(Error::io("find", path))?;
    Ok(!AssetFolder::new(&origin.file, false)?.admitting(origin.admitted.clone()).allows(&real))
}

fn open(path: &Path) -> Result<Opened> {
    let bytes = files::read_regular_file(path, MOST_BYTES)?;
    let (file, notes) = ProjectFile::parse(&bytes, path)?;
    Ok(Opened { file: Arc::new(file), notes, seen: Fingerprint::of(&bytes) })
}
