//! The graphics device of the window: whether it is still there, and what is shown on it.

use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::sync::{Mutex, PoisonError};

/// Tells the window that its graphics device is lost, and the next window what was open.
#[derive(Debug, Default)]
pub struct Device {
    lost: AtomicBool,
    /// Whether the window is being closed: devices go with it.
    closed: AtomicBool,
    /// The file of the open document.
    shown: Mutex<Option<PathBuf>>,
}

impl Device {
    /// The device is lost.
    pub fn lose(&self) {
        self.lost.store(true, Relaxed);
    }

    /// Whether it is lost: nothing more can be drawn.
    pub fn is_lost(&self) -> bool {
        self.lost.load(Relaxed)
    }

    /// The window is being closed by its user.
    pub(super) fn close(&self) {
        self.closed.store(true, Relaxed);
    }

    pub(super) fn is_closed(&self) -> bool {
        self.closed.load(Relaxed)
    }

    /// A document is open, with this file if it has one.
    pub(super) fn show(&self, file: Option<PathBuf>) {
        *self.shown.lock().unwrap_or_else(PoisonError::into_inner) = file;
    }

    pub(super) fn shown(&self) -> Option<PathBuf> {
        self.shown.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Whether it was lost while the window was open; forgets it, as there is a new one.
    pub(super) fn begin_anew(&self) -> bool {
        self.lost.swap(false, Relaxed)
    }
}
