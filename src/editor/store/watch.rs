//! The thread that looks whether the files change which the open project reads. It has nothing else to do: a network drive that
//! does not answer holds up no save.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::time::{Duration, SystemTime};

/// How often it looks.
const TICK: Duration = Duration::from_secs(1);

/// The handle of the thread, which ends soon after it is dropped.
#[derive(Debug)]
pub struct Watch {
    files: Sender<Vec<PathBuf>>,
    changed: Arc<AtomicBool>,
}

/// When a file was written last, and its size; none of one that is not there.
type Stamp = Option<(SystemTime, u64)>;

/// What is known of the files.
#[derive(Default)]
struct Watched {
    files: Vec<PathBuf>,
    /// As they were told last, and when they were looked at last.
    told: Vec<Stamp>,
    seen: Vec<Stamp>,
}

impl Watch {
    /// Starts the thread; none where the system starts none. `wake` is called on it after a change.
    pub fn start(wake: impl Fn() + Send + 'static) -> Option<Self> {
        let (files, inbox) = channel();
        let changed = Arc::new(AtomicBool::new(false));
        let tell = changed.clone();
        let look = move || {
            let mut watched = Watched::default();
            loop {
                match inbox.recv_timeout(TICK) {
                    Ok(files) => watched = Watched::new(files),
                    Err(RecvTimeoutError::Timeout) if watched.have_changed() => {
                        tell.store(true, Relaxed);
                        wake();
                    }
                    Err(RecvTimeoutError::Timeout) => (),
                    Err(RecvTimeoutError::Disconnected) => return,
                }
            }
        };
        std::thread::Builder::new().name("watch".into()).spawn(look).ok()?;
        Some(Self { files, changed })
    }

    /// Looks at these files from now on.
    pub fn look_at(&self, files: Vec<PathBuf>) {
        // The thread ends only after this sender.
        let _ = self.files.send(files);
    }

    /// Whether one of them was changed, deleted or put back since the last call.
    pub fn has_changed(&self) -> bool {
        self.changed.swap(false, Relaxed)
    }
}

impl Watched {
    fn new(files: Vec<PathBuf>) -> Self {
        let seen: Vec<Stamp> = files.iter().map(|file| stamp(file)).collect();
        Self { files, told: seen.clone(), seen }
    }

    /// Whether the files differ from those told last. One that is still being written is waited for: it must look the same twice.
    fn have_changed(&mut self) -> bool {
        let now: Vec<Stamp> = self.files.iter().map(|file| stamp(file)).collect();
        let rests = now == self.seen;
        self.seen = now;
        let changed = rests && self.seen != self.told;
        if changed {
            self.told.clone_from(&self.seen);
        }
        changed
    }
}

fn stamp(file: &Path) -> Stamp {
    let data = std::fs::metadata(file).ok()?;
    Some((data.modified().ok()?, data.len()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_that_comes_changes_and_goes_is_told_once_each_and_not_while_it_is_written() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("plate.exr");
        let mut watched = Watched::new(vec![file.clone()]);
        assert!(!watched.have_changed());
        for text in ["a", "longer"] {
            std::fs::write(&file, text).expect("a file");
            assert_eq!([(); 4].map(|()| watched.have_changed()), [false, true, false, false], "{text}");
        }
        // It grows from look to look.
        for length in 10..15 {
            std::fs::write(&file, vec![0; length]).expect("a file");
            assert!(!watched.have_changed(), "{length}");
        }
        assert!(watched.have_changed());
        std::fs::remove_file(&file).expect("it was there");
        assert_eq!([(); 3].map(|()| watched.have_changed()), [false, true, false]);
    }
}
