//! The bytes of a picture file, whose reading ends when the work is cancelled: decoders ask for nothing else so often.

use std::io::{self, BufRead, Cursor, Read, Seek, SeekFrom};

use crate::Progress;

/// Bytes that a decoder gets at once.
const PIECE: usize = 64 << 10;

/// The bytes of a file.
pub(super) struct Source<'a> {
    bytes: Cursor<&'a [u8]>,
    progress: &'a Progress,
}

impl<'a> Source<'a> {
    pub(super) fn new(bytes: &'a [u8], progress: &'a Progress) -> Self {
        Self { bytes: Cursor::new(bytes), progress }
    }

    fn check(&self) -> io::Result<()> {
        if self.progress.is_cancelled() { Err(io::Error::other("cancelled")) } else { Ok(()) }
    }
}

impl Read for Source<'_> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        self.check()?;
        let most = into.len().min(PIECE);
        self.bytes.read(&mut into[..most])
    }
}

impl BufRead for Source<'_> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        self.check()?;
        let rest = self.bytes.fill_buf()?;
        Ok(&rest[..rest.len().min(PIECE)])
    }

    fn consume(&mut self, count: usize) {
        self.bytes.consume(count);
    }
}

impl Seek for Source<'_> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.bytes.seek(to)
    }
}
