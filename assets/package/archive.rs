//! A compressed archive of the same bytes whenever and wherever it is made.

use std::fs::File;
use std::io;
use std::path::Path;

use flate2::Compression;
use flate2::write::GzEncoder;

/// A `.tar.gz` file in the making.
pub(crate) struct Archive {
    tar: tar::Builder<GzEncoder<File>>,
    folder: String,
}

impl Archive {
    /// Creates the file; all it will hold lies in `folder`.
    pub(crate) fn new(path: &Path, folder: &str) -> io::Result<Self> {
        let gzip = GzEncoder::new(File::create(path)?, Compression::best());
        Ok(Self { tar: tar::Builder::new(gzip), folder: folder.into() })
    }

    /// Adds a file. Neither its owner nor its date are kept.
    pub(crate) fn add(&mut self, path: &str, bytes: &[u8], executable: bool) -> io::Result<()> {
        let mut header = tar::Header::new_gnu();
        header.set_size(bytes.len() as u64);
        header.set_mode(if executable { 0o755 } else { 0o644 });
        self.tar.append_data(&mut header, format!("{}/{path}", self.folder), bytes)
    }

    /// Writes what is left.
    pub(crate) fn finish(self) -> io::Result<()> {
        self.tar.into_inner()?.finish()?.sync_all()
    }
}
