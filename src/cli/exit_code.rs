//! Exit codes, listed in the README.

use lightloom_core::Error;

/// Exit code where all frames are there, but some hold values that had to be replaced.
pub(super) const BAD_FRAMES: u8 = 4;
/// Exit code where there is no screen, or nothing that draws on it.
pub(super) const NO_WINDOW: u8 = 1;

/// One code per cause, so that a render farm can tell a bad project from a full disk.
pub(super) fn exit_code(error: &Error) -> u8 {
    match error {
        Error::Value { place, .. } if place.starts_with("--") => 2,
        Error::Format { .. } | Error::Value { .. } => 3,
        Error::Io { action: "read" | "find the folder", .. } => 3,
        Error::Io { .. } => 5,
        Error::Limit { .. } => 6,
        Error::Numeric { .. } => 7,
        Error::Cancelled => 130,
        Error::Noted { error, .. } => exit_code(error),
    }
}
