//! A scene of another program that is being read on a thread of its own.

use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, TryRecvError, channel};

use lightloom_core::import::{self, Import};
use lightloom_core::{Error, Progress, Result};

use crate::editor::guard::Guard;

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
        let guard = Guard::new("import");
        let read = move || {
            let fault = |words| Err(Error::format(&path, "", format!("a fault of the program: {words}")));
            // The window may have given it up.
            let _ = sender.send(guard.run(|| import::read(&path, &reading)).unwrap_or_else(fault));
        };
        std::thread::Builder::new().name("import".into()).spawn(read)?;
        Ok(Self { file: file.to_owned(), result, progress })
    }

    /// The scene, once it is read.
    pub(super) fn result(&self) -> Option<Result<Import>> {
        match self.result.try_recv() {
            Ok(result) => Some(result),
            Err(TryRecvError::Empty) => None,
            Err(TryRecvError::Disconnected) => Some(Err(Error::Cancelled)),
        }
    }
}

impl Drop for Importing {
    fn drop(&mut self) {
        self.progress.cancel();
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::editor::guard;

    #[test]
    fn a_panic_is_told_and_the_next_file_is_read() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("a.obj");
        std::fs::write(&file, "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n")
            .unwrap();
        let result = |importing: Importing| {
            loop {
                match importing.result() {
                    Some(result) => break result,
                    None => std::thread::yield_now(),
                }
            }
        };
        let failed = result(guard::planted("import", || Importing::start(&file).unwrap())).unwrap_err();
        assert!(failed.to_string().contains("a.obj': a fault of the program: a planted panic"), "{failed}");
        assert!(result(Importing::start(&file).unwrap()).is_ok());
    }
}
