//! Reading picture files: by content, not by name, and within limits that are checked before anything is decoded.

mod colour;
mod decoded;
mod exr;
mod formats;
mod image;
mod source;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use self::decoded::{MAX_BYTES, damaged};
use crate::files::read_regular_file;
use crate::{Progress, Result};

pub(super) use self::colour::linear_from_srgb;
pub(super) use self::decoded::Picture;

/// The picture of a file.
///
/// # Errors
/// `Io`, `Format` or `Limit`, each naming the file; `Cancelled`.
pub(super) fn read(path: &Path, progress: &Progress) -> Result<Picture> {
    progress.check()?;
    let bytes = read_regular_file(path, MAX_BYTES)?;
    // Decoders have had panics on hostile files; such a file is only another bad file.
    let decoded = catch_unwind(AssertUnwindSafe(|| {
        if bytes.starts_with(&[0x76, 0x2f, 0x31, 0x01]) {
            exr::read(path, &bytes, progress)
        } else {
            image::read(path, &bytes, progress)
        }
    }));
    // A decoder takes it for a file that cannot be read.
    progress.check()?;
    decoded.unwrap_or_else(|_| Err(damaged(path, "the decoder gave up")))
}
