//! The system's own file dialogs.

use std::sync::mpsc::{Receiver, channel};
use std::thread;

use egui::Context;

use super::request::{Dialogs, PickRequest, PickResult};
use super::system::begin;

/// The desktop portal's dialogs, or the system's on macOS and Windows.
#[derive(Clone, Copy, Debug, Default)]
pub struct Native;

impl Dialogs for Native {
    fn pick(&self, request: &PickRequest, wake: Context) -> Receiver<PickResult> {
        let (sender, receiver) = channel();
        // macOS wants dialogs begun on the main thread; the answer is waited for on another.
        let dialog = begin(request);
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
