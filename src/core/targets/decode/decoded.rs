//! A picture as it was decoded, and the limits on it.

use std::path::Path;

use glam::Vec2;
use image::DynamicImage;

use super::colour::Encoding;
use crate::{Error, Result};

/// Longest side in pixels.
const MAX_SIDE: usize = 16_384;
/// Most bytes of a file, and of the picture it decodes to.
pub(super) const MAX_BYTES: u64 = 256 << 20;

/// A decoded picture, upright.
pub(in crate::targets) struct Picture {
    pub(in crate::targets) width: usize,
    pub(in crate::targets) height: usize,
    /// Width of a pixel over its height.
    pub(in crate::targets) aspect: f32,
    /// What was chosen or left out.
    pub(in crate::targets) notes: Vec<String>,
    pub(super) pixels: Pixels,
}

pub(super) enum Pixels {
    /// Straight alpha.
    Image { image: DynamicImage, encoding: Encoding },
    /// OpenEXR: RGBA, linear, premultiplied.
    Float(Vec<[f32; 4]>),
}

impl Picture {
    /// Width and height as shown, in heights of a pixel.
    pub(in crate::targets) fn shown_size(&self) -> Vec2 {
        Vec2::new(self.width as f32 * self.aspect, self.height as f32)
    }

    /// Row `row` from the top as linear light, premultiplied by alpha, into `line`.
    pub(in crate::targets) fn read_row(&self, row: usize, line: &mut Vec<[f32; 4]>) {
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

pub(super) fn require_size(path: &Path, width: usize, height: usize, bytes: u64) -> Result<()> {
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

pub(super) fn damaged(path: &Path, why: impl std::fmt::Display) -> Error {
    Error::format(
        path,
        "",
        format!("the picture is damaged or of a kind that cannot be read ({why}); save it anew as PNG"),
    )
}
