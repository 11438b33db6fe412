//! Files that one process holds at a time.

use std::fs::{File, TryLockError};

/// Locks a file as long as it is open; false where another process, or another opening, has it. A disk that knows no locks is taken
/// as it is: work that is done or offered twice is better than work that never is.
pub fn try_hold(file: &File) -> bool {
    !matches!(file.try_lock(), Err(TryLockError::WouldBlock))
}
