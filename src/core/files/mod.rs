//! File access: bounded reads of regular files, atomic writes; array files ([`npy`], [`npz`]).

mod copy;
mod hold;
pub mod npy;
pub mod npz;
mod space;

pub(crate) use copy::{copy_new, is_same_content};
pub use hold::{is_at, try_hold};
pub use space::{free_bytes, reserve};

use std::fs::File;
use std::io::{self, BufWriter, Read as _, Write as _};
use std::path::Path;

use tempfile::NamedTempFile;

use crate::{Error, Result};

/// The content of the regular file at `path`.
///
/// Folders, devices, pipes and sockets are refused (a pipe would block for ever, `/dev/zero` never ends), as is a file of
/// more than `max_bytes`, before it is read.
///
/// # Errors
/// `Io` when the system refuses, `Format` when it is not a regular file or a pointer of Git LFS, `Limit` when it is too large.
pub fn read_regular_file(path: &Path, max_bytes: u64) -> Result<Vec<u8>> {
    // Checked before opening: opening a pipe without a writer would block.
    require_regular(path, &std::fs::metadata(path).map_err(Error::io("read", path))?)?;
    let file = File::open(path).map_err(Error::io("read", path))?;
    let metadata = file.metadata().map_err(Error::io("read", path))?;
    require_regular(path, &metadata)?;
    require_size(path, metadata.len(), max_bytes)?;
    let mut bytes = Vec::with_capacity(metadata.len() as usize);
    // A file may grow while it is read, and some system files give no size.
    file.take(max_bytes.saturating_add(1)).read_to_end(&mut bytes).map_err(Error::io("read", path))?;
    require_size(path, bytes.len() as u64, max_bytes)?;
    if bytes.starts_with(b"version https://git-lfs.github.com/") {
        let what = "is only a pointer of Git LFS, not the file itself; fetch it with `git lfs pull`";
        return Err(Error::format(path, "", what));
    }
    Ok(bytes)
}

/// Writes `path` atomically: to a temporary file beside it, which is flushed to the disk and then renamed. If `fill` or the
/// disk fails, the temporary file is removed and an old file of that name is unchanged.
pub fn write_atomic(path: &Path, fill: impl FnOnce(&mut BufWriter<&File>) -> io::Result<()>) -> Result<()> {
    let temporary = temporary_beside(path, ".tmp")?;
    let mut writer = BufWriter::with_capacity(1 << 20, temporary.as_file());
    let filled = fill(&mut writer).and_then(|()| writer.flush());
    drop(writer);
    filled.map_err(Error::io("write", path))?;
    keep(temporary, path)
}

/// A temporary file in the folder of `path`, whose name ends in `suffix`; it is removed unless it is kept.
pub(crate) fn temporary_beside(path: &Path, suffix: &str) -> Result<NamedTempFile> {
    let folder = folder_of(path);
    let mut builder = tempfile::Builder::new();
    builder.prefix(".lightloom-").suffix(suffix);
    // Temporary files are private by default; permissions are left to the umask.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder).map_err(Error::io("create a file in", folder))
}

/// Makes a complete temporary file that at `path`, in one step.
pub(crate) fn keep(temporary: NamedTempFile, path: &Path) -> Result<()> {
    // The new file keeps the permissions of the old one.
    #[cfg(unix)]
    if let Some(old) = std::fs::metadata(path).ok().filter(std::fs::Metadata::is_file) {
        temporary.as_file().set_permissions(old.permissions()).map_err(Error::io("write", path))?;
    }
    temporary.as_file().sync_all().map_err(Error::io("write", path))?;
    temporary.persist(path).map_err(|failed| Error::io("write", path)(failed.error))?;
    Ok(())
}

/// Flushes the folder of `path` to the disk, so that a rename in it survives a power cut. Does nothing on systems without
/// such a call.
pub fn sync_folder_of(path: &Path) -> Result<()> {
    let folder = folder_of(path);
    #[cfg(unix)]
    File::open(folder).and_then(|folder| folder.sync_all()).map_err(Error::io("write", folder))?;
    #[cfg(not(unix))]
    let _ = folder;
    Ok(())
}

fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}

/// Creates a folder and its parents, accessible to this user only; existing folders stay as they are.
///
/// # Errors
/// `Io` when the system refuses.
pub fn make_private(folder: &Path) -> Result<()> {
    let mut builder = std::fs::DirBuilder::new();
    builder.recursive(true);
    #[cfg(unix)]
    std::os::unix::fs::DirBuilderExt::mode(&mut builder, 0o700);
    builder.create(folder).map_err(Error::io("create", folder))
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

    #[cfg(unix)]
    #[test]
    fn who_may_read_the_old_file_may_read_the_new_one() {
        use std::os::unix::fs::PermissionsExt as _;
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("shared");
        std::fs::write(&path, b"old").unwrap();
        for mode in [0o664, 0o600] {
            std::fs::set_permissions(&path, std::fs::Permissions::from_mode(mode)).unwrap();
            write_atomic(&path, |file| file.write_all(b"new")).unwrap();
            assert_eq!(std::fs::metadata(&path).unwrap().permissions().mode() & 0o777, mode);
        }
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
