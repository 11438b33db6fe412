//! Copies of files that never overwrite.

use std::fs::File;
use std::io::{BufReader, Read, Write as _};
use std::path::Path;

use super::{require_regular, temporary_beside};
use crate::{Error, Progress, Result};

/// Bytes that are copied or compared at once.
const CHUNK: usize = 1 << 20;

/// Copies a regular file to a path where nothing stands, in one step: there is never a part of it. Progress counts bytes. Returns
/// the file's size.
///
/// # Errors
/// `Io` where the system refuses or something stands there; `Format` where it is no regular file; cancelled.
pub(crate) fn copy_new(from: &Path, to: &Path, progress: &Progress) -> Result<u64> {
    let mut source = open(from)?;
    let temporary = temporary_beside(to, ".tmp")?;
    let mut file = temporary.as_file();
    let mut chunk = vec![0; CHUNK];
    let mut bytes = 0;
    loop {
        progress.check()?;
        let count = source.read(&mut chunk).map_err(Error::io("read", from))?;
        if count == 0 {
            break;
        }
        file.write_all(&chunk[..count]).map_err(Error::io("write", to))?;
        bytes += count as u64;
        progress.advance(count as u64);
    }
    file.sync_all().map_err(Error::io("write", to))?;
    temporary.persist_noclobber(to).map_err(|failed| Error::io("write", to)(failed.error))?;
    Ok(bytes)
}

/// Whether two paths hold files with the same bytes; what is no regular file holds none.
///
/// # Errors
/// `Io` where the system refuses.
pub(crate) fn is_same_content(a: &Path, b: &Path) -> Result<bool> {
    let size =
        |path: &Path| std::fs::metadata(path).ok().filter(std::fs::Metadata::is_file).map(|file| file.len());
    let (Some(of_a), Some(of_b)) = (size(a), size(b)) else { return Ok(false) };
    if of_a != of_b {
        return Ok(false);
    }
    let (mut left, mut right) = (open(a)?, open(b)?);
    let (mut here, mut there) = (vec![0; CHUNK], vec![0; CHUNK]);
    loop {
        let count = fill(&mut left, &mut here).map_err(Error::io("read", a))?;
        if count != fill(&mut right, &mut there).map_err(Error::io("read", b))?
            || here[..count] != there[..count]
        {
            return Ok(false);
        }
        if count == 0 {
            return Ok(true);
        }
    }
}

fn open(path: &Path) -> Result<BufReader<File>> {
    // Checked before opening: opening a pipe without a writer would block.
    require_regular(path, &std::fs::metadata(path).map_err(Error::io("read", path))?)?;
    Ok(BufReader::new(File::open(path).map_err(Error::io("read", path))?))
}

/// Reads until the chunk is full or the file ends.
fn fill(file: &mut impl Read, chunk: &mut [u8]) -> std::io::Result<usize> {
    let mut count = 0;
    while count < chunk.len() {
        match file.read(&mut chunk[count..]) {
            Ok(0) => break,
            Ok(more) => count += more,
            Err(error) if error.kind() == std::io::ErrorKind::Interrupted => (),
            Err(error) => return Err(error),
        }
    }
    Ok(count)
}
