//! `lightloom`: see `lightloom --help`.

use std::process::ExitCode;

fn main() -> ExitCode {
    lightloom::cli::main()
}
