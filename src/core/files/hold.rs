//! Files that one process holds at a time.

use std::fs::{File, TryLockError};
use std::path::Path;

/// Locks a file as long as it is open; false where another process, or another opening, has it. A disk that knows no locks is taken
/// as it is: work that is done or offered twice is better than work that never is.
pub fn try_hold(file: &File) -> bool {
    !matches!(file.try_lock(), Err(TryLockError::WouldBlock))
}

/// Whether an open file is still the one at its path.
#[cfg(unix)]
pub fn is_at(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt as _;
    let (Ok(open), Ok(there)) = (file.metadata(), std::fs::metadata(path)) else { return false };
    (open.dev(), open.ino()) == (there.dev(), there.ino())
}

/// Whether there is a file at the path of an open one, which cannot be replaced on this system.
#[cfg(not(unix))]
pub fn is_at(_: &File, path: &Path) -> bool {
    path.exists()
}
