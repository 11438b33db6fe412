//! The system's own file dialogs.

use std::sync::mpsc::{Receiver, channel};
use std::thread;
use std::time::{Duration, Instant};

use egui::Context;
use rfd::AsyncFileDialog;

use super::request::{Dialogs, PickRequest, PickResult};

/// A dialog cancelled sooner than this was never shown: no user answers so fast, and where the system
/// has no file dialog the answer comes within some milliseconds.
const NOBODY: Duration = Duration::from_millis(250);

/// The desktop portal's dialogs, or the system's on macOS and Windows.
#[derive(Clone, Copy, Debug, Default)]
pub struct Native;

impl Dialogs for Native {
    fn pick(&self, request: &PickRequest, wake: Context) -> Receiver<PickResult> {
        let (sender, receiver) = channel();
        let asked = Instant::now();
        // macOS wants dialogs begun on the main thread; the answer is waited for on another.
        let dialog = begin(request);
        let wait = move || {
            let result = match pollster::block_on(dialog) {
                Some(file) => PickResult::Picked(file.path().to_owned()),
                None if asked.elapsed() < NOBODY => PickResult::Unavailable,
                None => PickResult::Cancelled,
            };
            // The window may have dropped the question.
            let _ = sender.send(result);
            wake.request_repaint();
        };
        // Without a thread the sender is dropped, which counts as unavailable.
        let _ = thread::Builder::new().name("file dialog".into()).spawn(wait);
        receiver
    }
}

type Answer = std::pin::Pin<Box<dyn Future<Output = Option<rfd::FileHandle>> + Send>>;

fn begin(request: &PickRequest) -> Answer {
    let (kind, endings) = request.purpose.files();
    let mut dialog = AsyncFileDialog::new().set_title(request.purpose.title());
    if let Some(folder) = &request.folder {
        dialog = dialog.set_directory(folder);
    }
    if endings.is_empty() {
        return Box::pin(dialog.pick_folder());
    }
    dialog = dialog.add_filter(kind, endings);
    if request.purpose.saves() {
        return Box::pin(dialog.set_file_name(&request.name).save_file());
    }
    Box::pin(dialog.pick_file())
}
