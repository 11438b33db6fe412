//! The frames of a film before it is written: screen values in a scratch file, so that memory does not grow with their number.

use std::fs::File;
use std::io::{Read as _, Seek as _, SeekFrom, Write as _};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use crate::export::png;
use crate::render::image::Image;
use crate::{Error, Result};

/// Bytes of one pixel in a reel: R, G, B.
pub(super) const CHANNELS: usize = 3;

/// Frames of 8 bits per channel in an unnamed file that disappears with the process.
#[derive(Debug)]
pub struct Reel {
    size: [usize; 2],
    count: usize,
    folder: PathBuf,
    file: Mutex<File>,
}

impl Reel {
    /// Room for `count` frames of `size` pixels in an unnamed file in `folder`.
    ///
    /// # Errors
    /// The system refuses.
    pub fn new(folder: &Path, size: [usize; 2], count: usize) -> Result<Self> {
        let file = tempfile::tempfile_in(folder).map_err(Error::io("create a scratch file in", folder))?;
        Ok(Self { size, count, folder: folder.to_owned(), file: Mutex::new(file) })
    }

    /// Number of frames.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Width and height in pixels.
    pub fn size(&self) -> [usize; 2] {
        self.size
    }

    /// Keeps a picture of screen values as frame `index`, dithered as in a PNG. From any thread, in any order.
    ///
    /// # Errors
    /// The system refuses.
    ///
    /// # Panics
    /// If the picture has another size, or there is no such frame.
    pub fn put(&self, index: usize, encoded: &Image) -> Result<()> {
        assert_eq!([encoded.width, encoded.height], self.size, "frames of one size");
        assert!(index < self.count, "frame {index} of {}", self.count);
        let bytes = png::bytes(encoded);
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        let written = file.seek(self.place(index)).and_then(|_| file.write_all(&bytes));
        written.map_err(Error::io("write the scratch file in", &self.folder))
    }

    /// The bytes R, G, B of a frame, row by row; those of a frame that was never put are not defined.
    pub(super) fn get(&self, index: usize) -> Result<Vec<u8>> {
        let mut bytes = vec![0; self.size[0] * self.size[1] * CHANNELS];
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        let read = file.seek(self.place(index)).and_then(|_| file.read_exact(&mut bytes));
        read.map_err(Error::io("read the scratch file in", &self.folder))?;
        Ok(bytes)
    }

    fn place(&self, index: usize) -> SeekFrom {
        SeekFrom::Start((index * self.size[0] * self.size[1] * CHANNELS) as u64)
    }
}
