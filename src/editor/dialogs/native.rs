//! The system's own file dialogs.

use std::sync::mpsc::{Receiver, channel};
use std::thread;

use egui::Context;
use rfd::AsyncFileDialog;

use super::request::{Dialogs, PickRequest, PickResult};
use super::system::begin;

/// The desktop portal's dialogs, or the system's on macOS and Windows.
#[derive(Debug)]
pub struct Native {
    /// A dialog over the window, without title or folder.
    blank: AsyncFileDialog,
}

impl Native {
    /// Dialogs over the window of a program.
    pub fn over(window: &eframe::CreationContext) -> Self {
        Self { blank: AsyncFileDialog::new().set_parent(window) }
    }
}

impl Dialogs for Native {
    fn pick(&self, request: &PickRequest, wake: Context) -> Receiver<PickResult> {
        let (sender, receiver) = channel();
        // macOS wants dialogs begun on the main thread; the answer is waited for on another.
        let dialog = begin(self.blank.clone(), request);
        let wait = move || {
            // The window may have dropped the question.
            let _ = sender.send(pollster::block_on(dialog));
            wake.request_repaint();
        };
        // Without a thread the sender is dropped, which counts as unavailable.
        let _ = thread::Builder::new().name("file dialog".into()).spawn(wait);
        receiver
    }
}
