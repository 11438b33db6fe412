//! Small good files, from which bad ones are made.

use std::io::Cursor;

use exr::prelude::{
    Encoding, Image as ExrImage, Layer, LayerAttributes, SpecificChannels, WritableImage as _,
};
use glam::vec3;
use image::{DynamicImage, ImageFormat, Rgba, RgbaImage};
use lightloom_core::files::npy::NpyWriter;

use crate::scenes::sphere_obj;

/// The material file `a.mtl` of the ball.
pub(super) const BALL_MATERIAL: &str = "# a\nnewmtl Glass\nNi 1.5\nd 0.1\nillum 7\nKd 0.8 0.8 0.8\nnewmtl M #2\nKd 0.5\n\
    Tf 0.5 0.5 0.5\nd -halo 0.2\nTr 0.8\nNi 1.5\nmap_Kd a.png\n";

/// A ball of glass of 80 triangles.
pub(super) fn ball() -> String {
    sphere_obj(1, vec3(0.0, 0.2, 0.0), 0.12)
}

pub(super) fn encoded(image: &DynamicImage, format: ImageFormat) -> Vec<u8> {
    super::pictures::any(image, format)
}

/// Colours and transparency.
pub(super) fn picture() -> DynamicImage {
    RgbaImage::from_fn(8, 6, |x, y| Rgba([30 * x as u8, 40 * y as u8, 200, 255 - 20 * x as u8])).into()
}

pub(super) fn png() -> Vec<u8> {
    encoded(&picture(), ImageFormat::Png)
}

/// A square OpenEXR picture of grey pixels.
pub(super) fn exr(values: &[f32]) -> Vec<u8> {
    exr_packed(values, Encoding::UNCOMPRESSED)
}

pub(super) fn exr_packed(values: &[f32], encoding: Encoding) -> Vec<u8> {
    let side = values.len().isqrt();
    let pixels = |at: exr::prelude::Vec2<usize>| {
        let value = values[at.y() * side + at.x()];
        (value, value, value)
    };
    let layer = Layer::new((side, side), LayerAttributes::default(), encoding, SpecificChannels::rgb(pixels));
    let mut bytes = Cursor::new(Vec::new());
    ExrImage::from_layer(layer).write().non_parallel().to_buffered(&mut bytes).unwrap();
    bytes.into_inner()
}

pub(super) fn npy(shape: &[u64], values: &[f32]) -> Vec<u8> {
    let mut file = Vec::new();
    let mut writer = NpyWriter::new(&mut file, shape).unwrap();
    writer.extend(values.iter().copied()).unwrap();
    writer.finish().unwrap();
    file
}

/// The PNG file with the sums of its chunks as its data wants them, as far as its chunks are whole.
pub(super) fn crc_corrected(mut file: Vec<u8>) -> Vec<u8> {
    let mut at = 8;
    while let Some(length) = file.get(at..at + 4).map(|word| u32::from_be_bytes(word.try_into().unwrap())) {
        let end = at + 8 + length as usize;
        if end + 4 > file.len() {
            break;
        }
        let sum = crc32fast::hash(&file[at + 4..end]);
        file[end..end + 4].copy_from_slice(&sum.to_be_bytes());
        at = end + 4;
    }
    file
}
