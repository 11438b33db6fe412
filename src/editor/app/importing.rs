//! A scene of another program that is being read on a thread of its own.

use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, TryRecvError, channel};

use lightloom_core::import::{self, Import};
use lightloom_core::{Error, Progress, Result};

/// A file that is being read for the open document; reading stops when this is dropped.
pub(super) struct Importing {
    /// The file.
    pub(super) file: PathBuf,
    result: Receiver<Result<Import>>,
    progress: Progress,
}

impl Importing {
    /// Begins to read.
    ///
    /// # Errors
    /// The system starts no thread.
    pub(super) fn start(file: &Path) -> std::io::Result<Self> {
        let (sender, result) = channel();
        let progress = Progress::new();
        let (path, reading) = (file.to_owned(), progress.clone());
        // The window may have given it up.
        let read = move || drop(sender.send(import::read(&path, &reading)));
        std::thread::Builder::new().name("import".into()).spawn(read)?;
        Ok(Self { file: file.to_owned(), result, progress })
    }

    /// The scene, once it is read.
    pub(super) fn result(&self) -> Option<Result<Import>> {
        match self.result.try_recv() {
            Ok(result) => Some(result),
            Err(TryRecvError::Empty) => None,
            // The thread ended without an answer: it panicked.
            Err(TryRecvError::Disconnected) => {
                Some(Err(Error::format(&self.file, "", "could not be read: a fault of the program")))
            }
        }
    }
}

impl Drop for Importing {
    fn drop(&mut self) {
        self.progress.cancel();
    }
}
