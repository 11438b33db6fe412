//! Reading picture files: by content, not by name, and within limits that are checked before anything is decoded.

use std::io::Cursor;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use exr::prelude::{MetaData, ReadChannels, ReadLayers};
use image::{ColorType, DynamicImage, ImageDecoder, ImageFormat, ImageReader};

use crate::files::read_regular_file;
use crate::{Error, Result};

/// Longest side in pixels.
const MAX_SIDE: usize = 16_384;
/// Most bytes of a file, and of the picture it decodes to.
const MAX_BYTES: u64 = 256 << 20;

/// A decoded picture.
pub(super) struct Picture {
    pub(super) width: usize,
    pub(super) height: usize,
    pixels: Pixels,
}

enum Pixels {
    /// PNG, JPEG: straight alpha, sRGB or (HDR) linear.
    Image { image: DynamicImage, linear: bool },
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
                read_exr(path, &bytes)
            } else {
                read_image(path, &bytes)
            }
        }));
        decoded.unwrap_or_else(|_| Err(damaged(path, "the decoder gave up")))
    }

    /// Row `row` from the top as linear light, premultiplied by alpha, into `line`.
    pub(super) fn read_row(&self, row: usize, line: &mut Vec<[f32; 4]>) {
        line.clear();
        match &self.pixels {
            Pixels::Float(pixels) => {
                line.extend_from_slice(&pixels[row * self.width..(row + 1) * self.width]);
            }
            Pixels::Image { image, linear } => {
                let strip = image.crop_imm(0, row as u32, self.width as u32, 1).into_rgba32f();
                line.extend(strip.pixels().map(|pixel| {
                    let [r, g, b, alpha] = pixel.0;
                    let light = |value: f32| alpha * if *linear { value } else { linear_from_srgb(value) };
                    [light(r), light(g), light(b), alpha]
                }));
            }
        }
    }
}

fn read_image(path: &Path, bytes: &[u8]) -> Result<Picture> {
    let reader =
        ImageReader::new(Cursor::new(bytes)).with_guessed_format().map_err(Error::io("read", path))?;
    if !matches!(reader.format(), Some(ImageFormat::Png | ImageFormat::Jpeg | ImageFormat::Hdr)) {
        return Err(Error::format(path, "", "this is not a PNG, JPEG, OpenEXR or Radiance HDR picture"));
    }
    let decoder = reader.into_decoder().map_err(|error| damaged(path, error))?;
    let (width, height) = decoder.dimensions();
    require_size(path, width as usize, height as usize, decoder.total_bytes())?;
    let linear = matches!(decoder.color_type(), ColorType::Rgb32F | ColorType::Rgba32F);
    let image = DynamicImage::from_decoder(decoder).map_err(|error| damaged(path, error))?;
    let pixels = Pixels::Image { image, linear };
    Ok(Picture { width: width as usize, height: height as usize, pixels })
}

fn read_exr(path: &Path, bytes: &[u8]) -> Result<Picture> {
    let meta =
        MetaData::read_from_buffered(Cursor::new(bytes), false).map_err(|error| damaged(path, error))?;
    let mut any_flat = false;
    for header in &meta.headers {
        let (width, height) = (header.layer_size.x(), header.layer_size.y());
        require_size(path, width, height, 16 * width as u64 * height as u64)?;
        any_flat |= !header.deep;
    }
    if !any_flat {
        return Err(Error::format(path, "", "this OpenEXR file holds deep pixels; save it flattened"));
    }
    let image = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .rgba_channels(
            |size, _| (size.x(), vec![[0.0; 4]; size.x() * size.y()]),
            |(width, pixels), at, (r, g, b, a): (f32, f32, f32, f32)| {
                pixels[at.y() * *width + at.x()] = [r, g, b, a];
            },
        )
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(bytes))
        .map_err(|error| Error::format(path, "", format!("no RGB picture can be read from it ({error})")))?;
    let size = image.layer_data.size;
    let pixels = Pixels::Float(image.layer_data.channel_data.pixels.1);
    Ok(Picture { width: size.x(), height: size.y(), pixels })
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
