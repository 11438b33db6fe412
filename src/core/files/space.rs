//! Free space of a disk.

use std::path::Path;

/// Bytes that are free for this user in a folder; none where the system does not tell.
#[cfg(unix)]
pub fn free_bytes(folder: &Path) -> Option<u64> {
    let seen = rustix::fs::statvfs(folder).ok()?;
    seen.f_bavail.checked_mul(seen.f_frsize)
}

/// Bytes that are free for this user in a folder; this system is not asked.
#[cfg(not(unix))]
pub fn free_bytes(_: &Path) -> Option<u64> {
    None
}
