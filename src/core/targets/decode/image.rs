//! PNG, JPEG, WebP, TIFF and Radiance HDR, read by the package `image`.

use std::path::Path;

use image::codecs::hdr::HdrDecoder;
use image::{ColorType, DynamicImage, ImageDecoder, ImageFormat, ImageReader};

use super::colour::{self, Encoding};
use super::decoded::{Picture, Pixels, damaged, require_size};
use super::formats;
use super::source::Source;
use crate::{Error, Progress, Result};

/// Formats that are read.
const READ: [ImageFormat; 5] =
    [ImageFormat::Png, ImageFormat::Jpeg, ImageFormat::WebP, ImageFormat::Tiff, ImageFormat::Hdr];

pub(super) fn read(path: &Path, bytes: &[u8], progress: &Progress) -> Result<Picture> {
    let source = Source::new(bytes, progress);
    // Radiance files begin with the name of the program that wrote them.
    if bytes.starts_with(b"#?") {
        let decoder = HdrDecoder::new_nonstrict(source).map_err(|error| damaged(path, error))?;
        let aspect = decoder.metadata().pixel_aspect_ratio.unwrap_or(1.0);
        // The format gives the height of a pixel over its width.
        return decode(path, decoder, Encoding::Linear, 1.0 / aspect);
    }
    let reader = ImageReader::new(source).with_guessed_format().map_err(Error::io("read", path))?;
    let Some(format) = reader.format().filter(|format| READ.contains(format)) else {
        return Err(Error::format(path, "", formats::unread(bytes)));
    };
    let mut decoder = reader.into_decoder().map_err(|error| damaged(path, error))?;
    let mut notes = Vec::new();
    let encoding = match decoder.color_type() {
        ColorType::Rgb32F | ColorType::Rgba32F => Encoding::Linear,
        _ => {
            let profile = decoder.icc_profile().unwrap_or_default();
            let tagged = if format == ImageFormat::Png { colour::of_png(bytes) } else { Ok(None) };
            let encoding = match (tagged, profile) {
                (Ok(Some(encoding)), _) => Ok(encoding),
                (Ok(None), Some(profile)) => Encoding::of_profile(&profile),
                (Ok(None), None) => Ok(Encoding::Srgb),
                (Err(why), _) => Err(why),
            };
            encoding.unwrap_or_else(|why| {
                notes.push(format!("'{}': its colours are read as sRGB: {why}", path.display()));
                Encoding::Srgb
            })
        }
    };
    let mut picture = decode(path, decoder, encoding, 1.0)?;
    picture.notes = notes;
    Ok(picture)
}

fn decode(path: &Path, mut decoder: impl ImageDecoder, encoding: Encoding, aspect: f32) -> Result<Picture> {
    let (width, height) = decoder.dimensions();
    require_size(path, width as usize, height as usize, decoder.total_bytes())?;
    // A picture whose orientation cannot be read is shown as stored.
    let orientation = decoder.orientation().ok();
    let mut image = DynamicImage::from_decoder(decoder).map_err(|error| damaged(path, error))?;
    orientation.into_iter().for_each(|orientation| image.apply_orientation(orientation));
    let (width, height) = (image.width() as usize, image.height() as usize);
    let aspect = if (0.01..100.0).contains(&aspect) { aspect } else { 1.0 };
    Ok(Picture { width, height, aspect, notes: Vec::new(), pixels: Pixels::Image { image, encoding } })
}
