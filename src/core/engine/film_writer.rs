//! The film of a render: frames are kept as they are written, and encoded in the end.

use std::path::Path;

use crate::export::{FilmFormat, Reel, film, write_film};
use crate::project::Project;
use crate::render::Image;
use crate::{Progress, Result};

/// A film to be written.
pub(super) struct FilmWriter<'a> {
    path: &'a Path,
    format: FilmFormat,
    reel: Reel,
    holds: Vec<u32>,
    frames_per_second: [u32; 2],
}

impl<'a> FilmWriter<'a> {
    /// The film of the frames `numbers`; until it is written they lie in a scratch file in `scratch`.
    ///
    /// # Errors
    /// No known kind of film; the system refuses.
    pub(super) fn new(path: &'a Path, scratch: &Path, project: &Project, numbers: &[i32]) -> Result<Self> {
        let size = [project.render.width as usize, project.render.height as usize];
        Ok(Self {
            path,
            format: FilmFormat::of(path, "film")?,
            reel: Reel::new(scratch, size, numbers.len())?,
            holds: film::holds(numbers),
            frames_per_second: project.output.fps,
        })
    }

    /// The file.
    pub(super) fn path(&self) -> &Path {
        self.path
    }

    /// Keeps frame number `index` in screen values.
    ///
    /// # Errors
    /// The system refuses.
    pub(super) fn keep(&self, index: usize, shown: &Image) -> Result<()> {
        self.reel.put(index, shown)
    }

    /// Writes the file.
    ///
    /// # Errors
    /// The system or ffmpeg refuses; cancelled.
    pub(super) fn write(&self, progress: &Progress) -> Result<()> {
        let Self { path, format, reel, holds, frames_per_second } = self;
        write_film(path, *format, reel, holds, *frames_per_second, progress)
    }
}
