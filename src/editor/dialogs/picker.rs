//! File selection through the system's dialog, or the built-in one where the system has none.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, TryRecvError};

use egui::Context;

use super::browser::Browser;
use super::request::{Dialogs, PickRequest, PickResult, Purpose, with_ending};

/// A file picker with at most one open dialog.
pub struct Picker {
    dialogs: Arc<dyn Dialogs>,
    state: PickerState,
}

enum PickerState {
    Idle,
    /// The system's dialog is open.
    Asked(PickRequest, Receiver<PickResult>),
    /// The built-in dialog is open.
    Browsing(PickRequest, Box<Browser>),
}

impl Picker {
    /// A picker that uses these dialogs.
    pub fn new(dialogs: Arc<dyn Dialogs>) -> Self {
        Self { dialogs, state: PickerState::Idle }
    }

    /// Opens a dialog; one that is already open is dropped.
    pub fn ask(&mut self, request: PickRequest, ctx: &Context) {
        let answer = self.dialogs.pick(&request, ctx.clone());
        self.state = PickerState::Asked(request, answer);
    }

    /// Whether a dialog is open.
    pub fn is_open(&self) -> bool {
        !matches!(self.state, PickerState::Idle)
    }

    /// Shows the built-in dialog where it is needed; returns the chosen file.
    pub fn show(&mut self, ctx: &Context) -> Option<(Purpose, PathBuf)> {
        match std::mem::replace(&mut self.state, PickerState::Idle) {
            PickerState::Idle => None,
            PickerState::Asked(request, answer) => match answer.try_recv() {
                Ok(PickResult::Picked(path)) => {
                    let path = with_ending(&request.purpose, path);
                    Some((request.purpose, path))
                }
                Ok(PickResult::Cancelled) => None,
                Err(TryRecvError::Empty) => {
                    self.state = PickerState::Asked(request, answer);
                    None
                }
                Ok(PickResult::Unavailable) | Err(TryRecvError::Disconnected) => {
                    let browser = Box::new(Browser::new(&request, ctx));
                    self.state = PickerState::Browsing(request, browser);
                    None
                }
            },
            PickerState::Browsing(request, mut browser) => match browser.show(ctx) {
                None => {
                    self.state = PickerState::Browsing(request, browser);
                    None
                }
                Some(None) => None,
                Some(Some(path)) => {
                    let path = with_ending(&request.purpose, path);
                    Some((request.purpose, path))
                }
            },
        }
    }
}
