//! Reading files that a project names: regular files only, and never more than was asked for.

use std::fs::File;
use std::io::Read as _;
use std::path::Path;

use crate::{Error, Result};

/// The whole content of the regular file at `path`.
///
/// Folders, devices, pipes and sockets are refused (a pipe would wait for ever, `/dev/zero` never ends), and so is
/// a file of more than `max_bytes`, before it is read.
///
/// # Errors
/// `Io` when the system refuses, `Format` when it is not a regular file, `Limit` when it is too large.
pub fn read_regular_file(path: &Path, max_bytes: u64) -> Result<Vec<u8>> {
    // Asked before opening: opening a pipe that nobody writes to would block.
    require_regular(path, &std::fs::metadata(path).map_err(Error::io("read", path))?)?;
    let file = File::open(path).map_err(Error::io("read", path))?;
    let metadata = file.metadata().map_err(Error::io("read", path))?;
    require_regular(path, &metadata)?;
    require_size(path, metadata.len(), max_bytes)?;
    let mut bytes = Vec::with_capacity(metadata.len() as usize);
    // A file may grow while it is read, and some system files give no size.
    file.take(max_bytes.saturating_add(1)).read_to_end(&mut bytes).map_err(Error::io("read", path))?;
    require_size(path, bytes.len() as u64, max_bytes)?;
    Ok(bytes)
}

fn require_regular(path: &Path, metadata: &std::fs::Metadata) -> Result<()> {
    if metadata.is_file() {
        return Ok(());
    }
    let kind = if metadata.is_dir() { "a folder" } else { "a device, pipe or socket" };
    Err(Error::format(path, "", format!("this is {kind}; name a regular file")))
}

fn require_size(path: &Path, bytes: u64, max_bytes: u64) -> Result<()> {
    if bytes <= max_bytes {
        return Ok(());
    }
    Err(Error::Limit {
        place: format!("'{}'", path.display()),
        what: format!("the file has {bytes} bytes or more, the limit is {max_bytes}; use a smaller file"),
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn a_file_is_read_up_to_the_limit_and_not_beyond() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("five");
        std::fs::write(&path, b"12345").unwrap();
        assert_eq!(read_regular_file(&path, 5).unwrap(), b"12345");
        assert!(matches!(read_regular_file(&path, 4), Err(Error::Limit { .. })));
    }

    #[test]
    fn folders_devices_and_missing_files_are_refused_by_name() {
        let folder = tempfile::tempdir().unwrap();
        assert!(matches!(read_regular_file(folder.path(), 9), Err(Error::Format { .. })));
        assert!(matches!(read_regular_file(&folder.path().join("none"), 9), Err(Error::Io { .. })));
        #[cfg(unix)]
        assert!(matches!(read_regular_file(Path::new("/dev/zero"), 9), Err(Error::Format { .. })));
    }
}
