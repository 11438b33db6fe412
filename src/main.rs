//! `lightloom`: see `lightloom --help`.

use std::io::Write;
use std::process::ExitCode;

fn main() -> ExitCode {
    let Some(what) = lightloom::processor::missing() else { return lightloom::cli::main() };
    // Formatting is compiled for newer processors, too.
    let mut out = std::io::stderr();
    for part in ["lightloom: this processor has no ", what, "; the program needs them\n"] {
        let _ = out.write_all(part.as_bytes());
    }
    ExitCode::FAILURE
}
