//! Reading picture files: by content, not by name, and within limits that are checked before anything is decoded.

mod colour;
mod exr;
mod formats;
mod image;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use ::image::DynamicImage;
use glam::Vec2;

use self::colour::Encoding;
use crate::files::read_regular_file;
use crate::{Error, Result};

/// Longest side in pixels.
const MAX_SIDE: usize = 16_384;
/// Most bytes of a file, and of the picture it decodes to.
const MAX_BYTES: u64 = 256 << 20;

/// A decoded picture, upright.
pub(super) struct Picture {
    pub(super) width: usize,
    pub(super) height: usize,
    /// Width of a pixel over its height.
    pub(super) aspect: f32,
    /// What was chosen or left out.
    pub(super) notes: Vec<String>,
    pixels: Pixels,
}

enum Pixels {
    /// Straight alpha.
    Image { image: DynamicImage, encoding: Encoding },
    /// OpenEXR: RGBA, linear, premultiplied.
    Float(Vec<[f32; 4]>),
}

impl Picture {
    /// # Errors
    /// `Io`, `Format` or `Limit`, each naming the file.
    pub(super) fn read(path: &Path) -> Result<Self> {
        let bytes = read_regular_file(path, MAX_BYTES)?;
        // Decoders have had panics on hostile files; such a file is only another bad file.
        let decoded = catch_unwind(AssertUnwindSafe(|| {
            if bytes.starts_with(&[0x76, 0x2f, 0x31, 0x01]) {
                exr::read(path, &bytes)
            } else {
                image::read(path, &bytes)
            }
        }));
        decoded.unwrap_or_else(|_| Err(damaged(path, "the decoder gave up")))
    }

    /// Width and height as shown, in heights of a pixel.
    pub(super) fn shown_size(&self) -> Vec2 {
        Vec2::new(self.width as f32 * self.aspect, self.height as f32)
    }

    /// Row `row` from the top as linear light, premultiplied by alpha, into `line`.
    pub(super) fn read_row(&self, row: usize, line: &mut Vec<[f32; 4]>) {
        line.clear();
        match &self.pixels {
            Pixels::Float(pixels) => {
                line.extend_from_slice(&pixels[row * self.width..(row + 1) * self.width]);
            }
            Pixels::Image { image, encoding } => {
                let strip = image.crop_imm(0, row as u32, self.width as u32, 1).into_rgba32f();
                line.extend(strip.pixels().map(|pixel| pixel.0));
                encoding.decode(line);
                for [r, g, b, alpha] in line {
                    [r, g, b].into_iter().for_each(|channel| *channel *= *alpha);
                }
            }
        }
    }
}

fn require_size(path: &Path, width: usize, height: usize, bytes: u64) -> Result<()> {
    if width == 0 || height == 0 {
        return Err(damaged(path, "it has no pixels"));
    }
    if width.max(height) <= MAX_SIDE && bytes <= MAX_BYTES {
        return Ok(());
    }
    Err(Error::Limit {
        place: format!("'{}'", path.display()),
        what: format!(
            "a picture of {width} x {height} pixels would take {} MiB; the limits are {MAX_SIDE} pixels a side and {} MiB: scale it down",
            bytes >> 20,
            MAX_BYTES >> 20
        ),
    })
}

fn damaged(path: &Path, why: impl std::fmt::Display) -> Error {
    Error::format(
        path,
        "",
        format!("the picture is damaged or of a kind that cannot be read ({why}); save it anew as PNG"),
    )
}

/// IEC 61966-2-1.
pub(super) fn linear_from_srgb(value: f32) -> f32 {
    if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
}
