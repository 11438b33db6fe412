//! The program itself, started as a script or a hand starts it.
#![allow(missing_docs, clippy::unwrap_used)]

use std::path::Path;

mod claim;
mod cli;
mod collect;
mod compare;
mod import;
#[path = "../letters/mod.rs"]
mod letters;
mod log;
mod real_window;
mod report;
mod resume;
#[path = "../scenes/mod.rs"]
mod scenes;
mod small;
#[path = "../window/mod.rs"]
mod window;

/// The top of the repository.
fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}
