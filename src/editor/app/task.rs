//! Work on the user's files on a thread of its own: it tells how far it is, and can be cancelled.

use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::thread::JoinHandle;
use std::time::Duration;

use eframe::egui;
use lightloom_core::{Error, Progress, Result};

use crate::editor::guard::Guard;

/// How often the window looks whether the work is done.
const LOOK: Duration = Duration::from_millis(30);

/// Work that is being done. It is cancelled when this is dropped, and has put everything back in its place then.
pub(super) struct Task<T> {
    /// The file or folder that it is about.
    pub(super) file: PathBuf,
    /// What is done, such as "Reading".
    pub(super) doing: &'static str,
    result: Receiver<Result<T>>,
    progress: Progress,
    thread: Option<JoinHandle<()>>,
}

impl<T: Send + 'static> Task<T> {
    /// Begins the work.
    ///
    /// # Errors
    /// The system starts no thread.
    pub(super) fn start(
        doing: &'static str,
        file: &Path,
        work: impl FnOnce(&Progress) -> Result<T> + Send + 'static,
    ) -> std::io::Result<Self> {
        let (sender, result) = channel();
        let progress = Progress::new();
        let theirs = progress.clone();
        let (path, guard) = (file.to_owned(), Guard::new(doing));
        let run = move || {
            let fault = |words| Err(Error::format(&path, "", format!("a fault of the program: {words}")));
            // The window may have given it up.
            let _ = sender.send(guard.run(|| work(&theirs)).unwrap_or_else(fault));
        };
        let thread = std::thread::Builder::new().name(doing.to_lowercase()).spawn(run)?;
        Ok(Self { file: file.to_owned(), doing, result, progress, thread: Some(thread) })
    }

    /// The result, once it is there; until then the window looks again.
    pub(super) fn result(&self, ctx: &egui::Context) -> Option<Result<T>> {
        match self.result.try_recv() {
            Ok(result) => Some(result),
            Err(TryRecvError::Empty) => {
                ctx.request_repaint_after(LOOK);
                None
            }
            Err(TryRecvError::Disconnected) => Some(Err(Error::Cancelled)),
        }
    }
}

impl<T> Task<T> {
    /// What is shown of it.
    pub(super) fn shown(&self) -> Doing<'_> {
        let name = self.file.file_name().unwrap_or(self.file.as_os_str()).to_string_lossy();
        Doing {
            words: format!("{} '{name}'", self.doing),
            share: self.progress.snapshot().fraction as f32,
            progress: &self.progress,
        }
    }
}

impl<T> Drop for Task<T> {
    fn drop(&mut self) {
        self.progress.cancel();
        if let Some(thread) = self.thread.take() {
            // A panic was told as the result.
            let _ = thread.join();
        }
    }
}

/// What the status bar shows of a task.
pub(super) struct Doing<'a> {
    words: String,
    share: f32,
    progress: &'a Progress,
}

impl Doing<'_> {
    /// A bar with what is done, and a button that cancels it.
    pub(super) fn show(&self, ui: &mut egui::Ui) {
        let text = egui::RichText::new(&self.words).small();
        let bar = egui::ProgressBar::new(self.share).text(text).desired_width(260.0).corner_radius(4);
        ui.add(bar).accessible_name(&self.words);
        if self.progress.is_cancelled() {
            ui.weak("stopping");
        } else if ui.button("Cancel").on_hover_text("Stops, and leaves everything as it was.").clicked() {
            self.progress.cancel();
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::editor::guard;

    #[test]
    fn a_panic_is_told_and_the_next_work_is_done() {
        let ctx = egui::Context::default();
        let start = |name| Task::start(name, Path::new("a.obj"), |_| Ok(7)).unwrap();
        let result = |task: Task<i32>| {
            loop {
                match task.result(&ctx) {
                    Some(result) => break result,
                    None => std::thread::yield_now(),
                }
            }
        };
        let failed = result(guard::planted("Reading", || start("Reading"))).unwrap_err();
        assert!(failed.to_string().contains("a.obj': a fault of the program: a planted panic"), "{failed}");
        assert_eq!(result(start("Reading")).unwrap(), 7);
    }
}
