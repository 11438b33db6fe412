//! The report, at small sizes.
#![allow(missing_docs, clippy::unwrap_used)]

use std::path::Path;

mod costs;
mod gamma;
mod letters;
mod light;
mod stability;

/// The top of the repository.
fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}
