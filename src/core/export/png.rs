//! PNG, 8 or 16 bit, with the sRGB chunk: for viewing, not for compositing.

use std::io;
use std::path::Path;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::render::image::Image;
use crate::{Error, Result};

/// Bits per channel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum PngDepth {
    /// 256 steps, dithered.
    #[default]
    #[serde(rename = "8")]
    Eight,
    /// 65536 steps.
    #[serde(rename = "16")]
    Sixteen,
}

/// Writes screen values (0..=1, after the view transform), dithered against banding. The dither depends on the pixel alone:
/// it does not flicker, and grey stays grey.
pub fn write(path: &Path, encoded: &Image, depth: PngDepth) -> Result<()> {
    write_with_texts(path, encoded, depth, &[])
}

/// As [`write()`], with texts by their names, each of which is prefixed with `lightloom:`.
pub(super) fn write_with_texts(
    path: &Path,
    encoded: &Image,
    depth: PngDepth,
    texts: &[(&str, String)],
) -> Result<()> {
    crate::files::write_atomic(path, |writer| write_to(writer, encoded, depth, texts))
}

/// As [`write_with_texts`], into memory.
pub(super) fn encode_with_texts(
    encoded: &Image,
    depth: PngDepth,
    texts: &[(&str, String)],
) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    write_to(&mut bytes, encoded, depth, texts)?;
    Ok(bytes)
}

/// As [`write()`], 8 bit, into memory.
///
/// # Errors
/// A picture without pixels, or larger than PNG allows.
pub fn encode(encoded: &Image) -> Result<Vec<u8>> {
    encode_with_texts(encoded, PngDepth::Eight, &[])
        .map_err(|error| Error::Numeric { stage: "png", what: error.to_string() })
}

fn write_to(
    writer: impl io::Write,
    encoded: &Image,
    depth: PngDepth,
    texts: &[(&str, String)],
) -> io::Result<()> {
    let (bits, data) = match depth {
        PngDepth::Eight => (png::BitDepth::Eight, bytes(encoded)),
        PngDepth::Sixteen => {
            let push = |v: u32, out: &mut Vec<u8>| out.extend_from_slice(&(v as u16).to_be_bytes());
            (png::BitDepth::Sixteen, quantize(encoded, 65_535.0, push))
        }
    };
    let mut encoder = png::Encoder::new(writer, encoded.width as u32, encoded.height as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(bits);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    encoder.set_compression(png::Compression::Fast);
    for (name, text) in texts {
        encoder.add_itxt_chunk(format!("lightloom:{name}"), text.clone()).map_err(io::Error::other)?;
    }
    let mut writer = encoder.write_header().map_err(io::Error::other)?;
    writer.write_image_data(&data).map_err(io::Error::other)?;
    writer.finish().map_err(io::Error::other)
}

/// The bytes R, G, B of a picture of screen values, as in a PNG of 8 bits.
pub(super) fn bytes(encoded: &Image) -> Vec<u8> {
    quantize(encoded, 255.0, |v, out| out.push(v as u8))
}

fn quantize(image: &Image, most: f32, push: impl Fn(u32, &mut Vec<u8>)) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(image.pixels.len() * 6);
    for (y, row) in image.pixels.chunks_exact(image.width.max(1)).enumerate() {
        for (x, pixel) in row.iter().enumerate() {
            let lift = dither(x, y);
            for value in pixel.to_array() {
                // A whole value is unchanged: the lift is below 1. NaN becomes 0.
                push((value.clamp(0.0, 1.0) * most + lift) as u32, &mut bytes);
            }
        }
    }
    bytes
}

/// A dither threshold in (0, 1) of low discrepancy: the R2 sequence folded to a triangle wave (Roberts 2018, *The unreasonable effectiveness of quasirandom sequences*).
pub(super) fn dither(x: usize, y: usize) -> f32 {
    let v = (x as f64 * 0.754_877_666_246_693 + y as f64 * 0.569_840_290_998_053).fract();
    let triangle = if v < 0.5 { 2.0 * v } else { 2.0 - 2.0 * v };
    (triangle * 0.998 + 0.001) as f32
}
