//! Exit codes, listed in the README.

use std::io::ErrorKind;

use lightloom_core::Error;

use crate::editor::device::TRY_AGAIN;

/// Exit code where all frames are there, but some hold values that had to be replaced.
pub(super) const BAD_FRAMES: u8 = 4;
/// Exit code where there is no screen, or nothing that draws on it.
pub(super) const NO_WINDOW: u8 = 1;

/// Exit code of a fault of the program.
pub(super) const INTERNAL: u8 = 70;

/// One code per cause, so that a render farm can tell a bad project from a full disk.
pub(super) fn exit_code(error: &Error) -> u8 {
    match error {
        Error::Value { place, .. } if place.starts_with("--") => 2,
        Error::Format { .. } | Error::Value { .. } => 3,
        Error::Io { source, .. } if is_temporary(source.kind()) => TRY_AGAIN,
        Error::Io { action: "read" | "find the folder", .. } => 3,
        Error::Io { .. } => 5,
        Error::Limit { .. } => 6,
        Error::Numeric { .. } => 7,
        Error::Cancelled => 130,
        Error::Noted { error, .. } => exit_code(error),
    }
}

/// Whether what the system refused may go by itself: a network drive that is away, a machine that has no more threads.
fn is_temporary(kind: ErrorKind) -> bool {
    use ErrorKind as Kind;
    let network = [Kind::NetworkDown, Kind::NetworkUnreachable, Kind::HostUnreachable, Kind::ConnectionReset];
    let drive = [Kind::StaleNetworkFileHandle, Kind::TimedOut, Kind::NotConnected, Kind::ConnectionAborted];
    let busy = [Kind::WouldBlock, Kind::ResourceBusy, Kind::Interrupted, Kind::ExecutableFileBusy];
    network.contains(&kind) || drive.contains(&kind) || busy.contains(&kind)
}

#[cfg(test)]
mod tests {
    use std::io;

    use super::*;

    /// The numbers of errors are those of Linux.
    #[cfg(target_os = "linux")]
    #[test]
    fn a_network_drive_that_is_away_is_tried_again_and_a_full_disk_is_not() {
        let [eagain, ebusy, enospc, etimedout, ehostunreach, estale, eio] = [11, 16, 28, 110, 113, 116, 5];
        let code = |number: i32, action| {
            let error = Error::io(action, "frame.exr")(io::Error::from_raw_os_error(number));
            exit_code(&error)
        };
        for number in [eagain, ebusy, etimedout, ehostunreach, estale] {
            assert_eq!([code(number, "write"), code(number, "read")], [75, 75], "{number}");
        }
        assert_eq!([code(enospc, "write"), code(eio, "write"), code(eio, "read")], [5, 5, 3]);
    }
}
