//! One film to be written, for the encoders.

use std::io::{self, Write};
use std::path::Path;

use super::reel::Reel;
use crate::{Error, Progress, Result};

/// A film to be written.
pub(super) struct Film<'a> {
    pub(super) path: &'a Path,
    pub(super) reel: &'a Reel,
    pub(super) holds: &'a [u32],
    pub(super) frames_per_second: [u32; 2],
    pub(super) progress: &'a Progress,
    /// Whether the work was stopped before.
    pub(super) stopped: bool,
}

impl Film<'_> {
    /// Writes the file atomically.
    pub(super) fn fill(&self, fill: impl FnOnce(&mut dyn Write) -> Result<()>) -> Result<()> {
        let mut failed = None;
        let written = crate::files::write_atomic(self.path, |file| {
            fill(file).map_err(|error| {
                failed = Some(error);
                io::Error::other("not completed")
            })
        });
        failed.map_or(written, Err)
    }

    /// `Err(Cancelled)` once the film is not wanted any more. Blocks while paused.
    pub(super) fn check(&self) -> Result<()> {
        match self.progress.check() {
            Err(Error::Cancelled) if self.stopped && !self.progress.is_abandoned() => Ok(()),
            other => other,
        }
    }

    /// For `map_err`: the encoder's or the system's reason.
    pub(super) fn refused<E: std::error::Error + Send + Sync + 'static>(&self) -> impl Fn(E) -> Error {
        |error| Error::io("write", self.path)(io::Error::other(error))
    }
}
