//! The report, at small sizes.
#![allow(missing_docs, clippy::unwrap_used)]

use std::path::Path;

mod costs;
mod gamma;
#[path = "../letters/mod.rs"]
mod letters;
mod light;
mod stability;
mod text;

/// The top of the repository.
fn root() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."))
}
