//! Files on their way to the disk: while some are flushed, others are computed.

use std::any::Any;
use std::io::Write as _;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread::{self, Builder};

use crate::files::write_atomic;
use crate::{Error, Result};

/// Threads that wait for the disk: it flushes several files in little more time than one.
const WRITERS: usize = 4;

/// Takes files, which threads of its own write atomically.
pub(super) struct DiskQueue<'a> {
    /// Hands over to a writer; none where the system starts none.
    files: Option<SyncSender<(PathBuf, Vec<u8>)>>,
    outcome: &'a Outcome<'a>,
}

/// What comes of the files.
struct Outcome<'a> {
    /// Called with each finished file.
    saved: &'a (dyn Fn(&Path) + Sync),
    /// The first failure: an error, or a panic of `saved`.
    failed: Mutex<Option<thread::Result<Error>>>,
}

impl DiskQueue<'_> {
    /// Passes a file to the writers; waits while all are busy.
    ///
    /// # Errors
    /// An earlier file could not be written.
    pub(super) fn put(&self, path: PathBuf, bytes: Vec<u8>) -> Result<()> {
        if self.outcome.failure().is_some() {
            // What failed is told in the end.
            return Err(Error::Cancelled);
        }
        match &self.files {
            // The writers end after the last sender.
            Some(files) => files.send((path, bytes)).map_err(|_| Error::Cancelled),
            None => {
                self.outcome.write(&path, &bytes);
                Ok(())
            }
        }
    }
}

impl Outcome<'_> {
    fn failure(&self) -> MutexGuard<'_, Option<thread::Result<Error>>> {
        self.failed.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn write(&self, path: &Path, bytes: &[u8]) {
        let write = || write_atomic(path, |file| file.write_all(bytes)).map(|()| (self.saved)(path));
        let failed: thread::Result<Error> = match catch_unwind(AssertUnwindSafe(write)) {
            Ok(Ok(())) => return,
            Ok(Err(error)) => Ok(error),
            Err(panic) => Err(panic),
        };
        self.failure().get_or_insert(failed);
    }

    /// Writes what comes; after a failure the rest is dropped, so that nobody waits for ever.
    fn serve(&self, files: &Mutex<Receiver<(PathBuf, Vec<u8>)>>) {
        loop {
            let next = files.lock().unwrap_or_else(PoisonError::into_inner).recv();
            let Ok((path, bytes)) = next else { return };
            if self.failure().is_none() {
                self.write(&path, &bytes);
            }
        }
    }
}

/// Does some work that puts files into a queue, and waits until they are written; `saved` is called with each.
///
/// # Errors
/// Those of the work; a file cannot be written.
pub(super) fn with_disk<T>(
    saved: &(dyn Fn(&Path) + Sync),
    work: impl FnOnce(&DiskQueue) -> Result<T>,
) -> Result<T> {
    let outcome = Outcome { saved, failed: Mutex::new(None) };
    let (send, receive) = sync_channel(0);
    let receive = Mutex::new(receive);
    let done = thread::scope(|scope| {
        let serve = || outcome.serve(&receive);
        let writer = |_| Builder::new().name("frames".into()).spawn_scoped(scope, serve).ok();
        let writers = (0..WRITERS).filter_map(writer).count();
        let queue = DiskQueue { files: (writers > 0).then_some(send), outcome: &outcome };
        let done: std::result::Result<_, Box<dyn Any + Send>> =
            catch_unwind(AssertUnwindSafe(|| work(&queue)));
        // With it the writers end.
        drop(queue);
        done
    });
    match outcome.failed.into_inner().unwrap_or_else(PoisonError::into_inner) {
        Some(Ok(error)) => Err(error),
        Some(Err(panic)) => resume_unwind(panic),
        None => done.unwrap_or_else(|panic| resume_unwind(panic)),
    }
}
