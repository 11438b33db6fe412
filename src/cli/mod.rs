//! The commands and their arguments.

use std::process::ExitCode;

/// Parses the arguments, runs the command, returns its exit code.
pub fn main() -> ExitCode {
    ExitCode::SUCCESS
}
