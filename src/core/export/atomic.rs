//! Files that are there whole or not at all.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

use crate::{Error, Result};

/// Writes `path` through a temporary file beside it, which is flushed to the disk and then takes the name. If `fill` or
/// the disk fails, the temporary file is removed and a file that had the name before is as it was.
pub fn write(path: &Path, fill: impl FnOnce(&mut BufWriter<&File>) -> io::Result<()>) -> Result<()> {
    let folder = match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    let mut builder = tempfile::Builder::new();
    builder.prefix(".lightloom-").suffix(".tmp");
    // A temporary file is private by default; a frame is for everyone whom the umask lets in.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    let temporary = builder.tempfile_in(folder).map_err(Error::io("create a file in", folder))?;
    let mut writer = BufWriter::with_capacity(1 << 20, temporary.as_file());
    let filled = fill(&mut writer).and_then(|()| writer.flush());
    drop(writer);
    filled.and_then(|()| temporary.as_file().sync_all()).map_err(Error::io("write", path))?;
    temporary.persist(path).map_err(|failed| Error::io("write", path)(failed.error))?;
    Ok(())
}
