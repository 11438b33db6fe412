//! Picture files.

use std::io::Cursor;

use glam::Vec2;
use image::{DynamicImage, GrayImage, ImageFormat, Luma, LumaA, Rgb, Rgba};
use lightloom_core::targets::{ImageTarget, PictureSampler};

use super::seeds::{crc_corrected, encoded, exr, png};
use super::{Row, told};

/// Reads a picture and draws points of it; its notes.
fn read(bytes: &[u8]) -> Result<Vec<String>, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("picture.png");
    std::fs::write(&path, bytes).unwrap();
    let target = ImageTarget::new("picture.png");
    let sampler = PictureSampler::load(&path, &target, Vec2::ONE, "keys[0].shows.image")
        .map_err(|error| told(error, folder.path()))?;
    let points = sampler.sample(1, 0, 64);
    assert!(points.positions.iter().all(|point| point.is_finite()), "a point that is not finite");
    Ok(sampler.notes().iter().map(|note| super::without(note, folder.path())).collect())
}

/// A PNG file that claims to be of another size.
fn sized(width: u32, height: u32) -> Vec<u8> {
    let mut file = png();
    file[16..20].copy_from_slice(&width.to_be_bytes());
    file[20..24].copy_from_slice(&height.to_be_bytes());
    crc_corrected(file)
}

fn grey(width: u32, height: u32, value: impl Fn(u32, u32) -> u8) -> Vec<u8> {
    encoded(&GrayImage::from_fn(width, height, |x, y| Luma([value(x, y)])).into(), ImageFormat::Png)
}

/// A CMYK file of one block, made by hand: four components in the frame header.
fn cmyk() -> Vec<u8> {
    let mut jpeg = encoded(&DynamicImage::new_rgb8(8, 8), ImageFormat::Jpeg);
    let frame = jpeg.windows(2).position(|marker| marker == [0xff, 0xc0]).unwrap();
    jpeg[frame + 9] = 4;
    jpeg
}

/// A PNG file of several pictures: `acTL` says so.
fn animated() -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 4, 4);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_animated(2, 0).unwrap();
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(&[255; 16]).unwrap();
    writer.write_image_data(&[9; 16]).unwrap();
    writer.finish().unwrap();
    bytes
}

pub(super) fn rows() -> Vec<Row> {
    let good = png();
    let lit = |x, y| if x == y { 255 } else { 40 };
    let mut exr_huge = exr(&[1.0; 4]);
    // The data window's last column.
    let window = exr_huge.windows(10).position(|name| name == b"dataWindow").unwrap() + 10 + 1 + 6 + 4 + 8;
    exr_huge[window..window + 4].copy_from_slice(&i32::MAX.to_le_bytes());
    let refused: Vec<(&str, Vec<u8>, &str)> = vec![
        ("an empty file", Vec::new(), "picture.png … empty file … save it as PNG"),
        ("a PNG of 200000 x 200000", sized(200_000, 200_000), "200000 x 200000 … limits are 16384"),
        ("a PNG of 2^31 - 1 x 1", sized(i32::MAX as u32, 1), "picture.png … limit"),
        ("a PNG of 0 x 4", sized(0, 4), "picture.png … damaged"),
        ("an EXR of 2^31 - 1 columns", exr_huge, "picture.png"),
        ("a PNG cut off", good[..good.len() / 2].to_vec(), "picture.png … damaged"),
        ("a PNG cut off in its header", good[..20].to_vec(), "picture.png … damaged"),
        ("an EXR cut off", exr(&[1.0; 4])[..200].to_vec(), "picture.png … damaged"),
        ("a picture that is all black", grey(8, 8, |_, _| 0), "no light"),
        (
            "a picture that is all transparent",
            encoded(&image::RgbaImage::from_pixel(4, 4, Rgba([255, 255, 255, 0])).into(), ImageFormat::Png),
            "no light",
        ),
        ("an EXR of nothing but NaN", exr(&[f32::NAN; 4]), "no light"),
        ("CMYK in a JPEG named .png", cmyk(), "picture.png … damaged"),
        ("a text", b"hello".to_vec(), "no picture that is read"),
    ];
    let read_rows: Vec<(&str, Vec<u8>, &str)> = vec![
        ("NaN, infinite and negative pixels", exr(&[f32::NAN, f32::INFINITY, -1.0, 1.0]), "pixels"),
        ("an EXR that says falsely that it is deep", deep_exr(), ""),
        ("one lit pixel", grey(8, 8, |x, y| if (x, y) == (3, 5) { 255 } else { 0 }), ""),
        ("1 x 1", grey(1, 1, |_, _| 255), ""),
        ("1 x 16384", grey(1, 16_384, |_, _| 255), ""),
        (
            "16 bits a channel",
            encoded(&image::ImageBuffer::from_pixel(4, 4, Rgb([40_000_u16; 3])).into(), ImageFormat::Png),
            "",
        ),
        ("a palette", palette(), ""),
        ("grey", grey(8, 8, lit), ""),
        (
            "grey with alpha",
            encoded(&image::GrayAlphaImage::from_pixel(4, 4, LumaA([200, 128])).into(), ImageFormat::Png),
            "",
        ),
        ("an animated PNG: its first picture", animated(), ""),
        (
            "a JPEG named .png",
            encoded(&image::RgbImage::from_pixel(8, 8, Rgb([255; 3])).into(), ImageFormat::Jpeg),
            "",
        ),
    ];
    let refused =
        refused.into_iter().map(|(input, bytes, words)| Row::refused(input, words, || read(&bytes)));
    let read_rows =
        read_rows.into_iter().map(|(input, bytes, words)| Row::read(input, words, || read(&bytes)));
    refused.chain(read_rows).collect()
}

fn palette() -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 4, 4);
    encoder.set_color(png::ColorType::Indexed);
    encoder.set_palette(vec![0, 0, 0, 255, 255, 255]);
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(&[1; 16]).unwrap();
    writer.finish().unwrap();
    bytes
}

/// The version field says that the pixels are deep, and the header that they are scan lines.
fn deep_exr() -> Vec<u8> {
    let mut file = exr(&[1.0; 4]);
    file[5] |= 0x08;
    file
}

/// Bytes of any picture that the package `image` writes.
pub(super) fn any(image: &DynamicImage, format: ImageFormat) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    image.write_to(&mut bytes, format).unwrap();
    bytes.into_inner()
}
