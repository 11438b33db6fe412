//! Pictures: orientation and formats. All files are built here, byte by byte where it matters.

use std::io::Cursor;

use glam::{Vec2, vec2};
use image::{DynamicImage, ImageBuffer, ImageFormat, Rgb, RgbImage};
use lightloom_core::targets::{Brightness, ImageTarget, PictureSampler, Placement};

use super::picture_colours;

/// The brightness of a file's pixels over that of the brightest, in blocks of a picture's longer side over `side`.
pub(super) fn brightness(content: &[u8], side: usize) -> Result<Brightness, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("picture");
    std::fs::write(&path, content).unwrap();
    Brightness::load(&path, &ImageTarget::new("picture"), side).map_err(|error| error.to_string())
}

/// The notes on a file.
pub(super) fn notes(content: &[u8]) -> String {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("picture");
    std::fs::write(&path, content).unwrap();
    PictureSampler::load(&path, &ImageTarget::new("picture"), Vec2::ONE, "target").unwrap().notes().join("\n")
}

pub(super) fn encoded(image: &DynamicImage, format: ImageFormat) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    image.write_to(&mut bytes, format).unwrap();
    bytes.into_inner()
}

/// Columns and rows of blocks, which JPEG keeps apart.
const BLOCKS: [u32; 2] = [3, 2];

/// A white block at the upper left, a grey one beside it.
fn oriented() -> DynamicImage {
    let pixel = |x, y| {
        Rgb(match (x / 8, y / 8) {
            (0, 0) => [255; 3],
            (1, 0) => [160; 3],
            _ => [0; 3],
        })
    };
    RgbImage::from_fn(8 * BLOCKS[0], 8 * BLOCKS[1], pixel).into()
}

/// EXIF data with nothing but an orientation (TIFF 6, IFD 0, tag 274).
fn exif(orientation: u8, little_endian: bool) -> Vec<u8> {
    let two = |value: u16| if little_endian { value.to_le_bytes() } else { value.to_be_bytes() };
    let four = |value: u32| if little_endian { value.to_le_bytes() } else { value.to_be_bytes() };
    let mut data = if little_endian { b"II".to_vec() } else { b"MM".to_vec() };
    for part in [
        &two(42)[..],
        &four(8),
        &two(1),
        &two(274),
        &two(3),
        &four(1),
        &two(orientation.into()),
        &two(0),
        &four(0),
    ] {
        data.extend_from_slice(part);
    }
    data
}

/// The file with an APP1 segment behind its first marker.
fn jpeg_with_exif(orientation: u8, little_endian: bool) -> Vec<u8> {
    let mut jpeg = encoded(&oriented(), ImageFormat::Jpeg);
    let data = [b"Exif\0\0", &*exif(orientation, little_endian)].concat();
    let length = (data.len() as u16 + 2).to_be_bytes();
    jpeg.splice(2..2, [&[0xff, 0xe1][..], &length, &data].concat());
    jpeg
}

/// The PNG file with a chunk behind its header.
pub(super) fn with_chunk(mut png: Vec<u8>, name: &[u8; 4], data: &[u8]) -> Vec<u8> {
    let typed = [&name[..], data].concat();
    let chunk =
        [&(data.len() as u32).to_be_bytes()[..], &typed, &crc32fast::hash(&typed).to_be_bytes()].concat();
    let after_header = 8 + 25;
    png.splice(after_header..after_header, chunk);
    png
}

#[test]
fn pictures_are_turned_as_their_cameras_say() {
    // Where column x and row y of three by two blocks come to lie (EXIF 2.32, 4.6.4).
    let [w, h] = BLOCKS.map(|n| n as usize - 1);
    type Turn = fn(usize, usize, usize, usize) -> [usize; 2];
    let turns: [Turn; 8] = [
        |x, y, _, _| [x, y],
        |x, y, w, _| [w - x, y],
        |x, y, w, h| [w - x, h - y],
        |x, y, _, h| [x, h - y],
        |x, y, _, _| [y, x],
        |x, y, _, h| [h - y, x],
        |x, y, w, h| [h - y, w - x],
        |x, y, w, _| [y, w - x],
    ];
    for (orientation, turn) in (1..).zip(turns) {
        let png = encoded(&oriented(), ImageFormat::Png);
        for file in [
            jpeg_with_exif(orientation, true),
            jpeg_with_exif(orientation, false),
            with_chunk(png, b"eXIf", &exif(orientation, true)),
        ] {
            let shown = brightness(&file, 3).unwrap();
            let size = if orientation > 4 { vec2(16.0, 24.0) } else { vec2(24.0, 16.0) };
            assert_eq!(shown.size, size, "{orientation}");
            let at = |[x, y]: [usize; 2]| shown.values[y * shown.width + x];
            // 160 is 0.35 of white in linear light; JPEG rounds by a few of 255.
            assert_eq!(at(turn(0, 0, w, h)), 1.0, "{orientation}");
            assert!((at(turn(1, 0, w, h)) - 0.352).abs() < 0.02, "{orientation}");
            assert!(at(turn(2, 1, w, h)) < 0.01, "{orientation}");
        }
    }
    // An orientation that does not exist, and none at all.
    for file in [jpeg_with_exif(9, true), encoded(&oriented(), ImageFormat::Jpeg)] {
        assert_eq!(brightness(&file, 3).unwrap().values[0], 1.0);
    }
}

#[test]
fn radiance_files_of_any_program_are_read() {
    let pixel = |x: u32, _| Rgb([[1.0_f32, 0.5][x as usize]; 3]);
    let hdr = encoded(&DynamicImage::ImageRgb32F(ImageBuffer::from_fn(2, 1, pixel)), ImageFormat::Hdr);
    let body = hdr.strip_prefix(b"#?RADIANCE").unwrap();
    for (head, width) in [
        ("#?RADIANCE", 2.0),
        ("#?RGBE", 2.0),
        ("#?AUTOPANO\n# made by hand", 2.0),
        ("#?RGBE\nPIXASPECT=0.5", 4.0),
    ] {
        let shown = brightness(&[head.as_bytes(), body].concat(), 2)
            .unwrap_or_else(|error| panic!("{head}: {error}"));
        assert_eq!((shown.size, &*shown.values), (vec2(width, 1.0), &[1.0, 0.5][..]), "{head}");
    }
}

#[test]
fn webp_and_tiff_are_read() {
    let pixel = |x: u32, _| Rgb([[255_u8, 128][x as usize / 2]; 3]);
    let image: DynamicImage = RgbImage::from_fn(4, 2, pixel).into();
    for format in [ImageFormat::WebP, ImageFormat::Tiff] {
        let shown = brightness(&encoded(&image, format), 4).unwrap();
        assert!(
            (f64::from(shown.values[2]) - picture_colours::srgb(128.0 / 255.0)).abs() < 1e-5,
            "{format:?}"
        );
    }
    let linear =
        DynamicImage::ImageRgb32F(ImageBuffer::from_fn(2, 1, |x, _| Rgb([[1.0_f32, 0.25][x as usize]; 3])));
    assert_eq!(brightness(&encoded(&linear, ImageFormat::Tiff), 2).unwrap().values, [1.0, 0.25]);
}

#[test]
fn what_is_not_read_is_named_with_the_way_out() {
    for (head, name) in [
        (&b"8BPS\0\x01"[..], "Photoshop"),
        (b"GIF89a", "GIF"),
        (b"BM\x36\0\0\0", "BMP"),
        (b"\0\0\0\x1cftypheic\0\0\0\0", "HEIC"),
        (b"\0\0\0\x1cftypheix\0\0\0\0", "HEIC"),
        (b"\0\0\0\x1cftypavif\0\0\0\0", "AVIF"),
        (b"\0\0\0\x1cftypmif1\0\0\0\0", "HEIF"),
        (b"\0\0\0\x1cftypqt  \0\0\0\0", "a film"),
        (b"\0\0\0\x0cJXL \r\n\x87\n", "JPEG XL"),
        (b"\xff\x0a\0", "JPEG XL"),
        (b"\0\0\0\x0cjP  \r\n\x87\n", "JPEG 2000"),
        (b"DDS |\0\0\0", "DDS"),
        (b"qoif\0\0", "QOI"),
        (b"SDPX\0", "DPX"),
        (b"gimp xcf v011", "GIMP"),
        (b"%PDF-1.7", "PDF"),
        (b"PK\x03\x04", "archive"),
        (b"P6\n2 2\n255\n", "PPM"),
        (b"<?xml version=\"1.0\"?>\n<svg xmlns=", "SVG"),
        (b"\n<!DOCTYPE html><html>", "web page"),
        (b"", "empty file"),
        (b"hello", "no picture that is read"),
    ] {
        let error = brightness(head, 2).unwrap_err();
        assert!(error.contains(name) && error.contains("save it as PNG"), "{name}: {error}");
    }
    let error =
        brightness(b"version https://git-lfs.github.com/spec/v1\noid sha256:1\nsize 9\n", 2).unwrap_err();
    assert!(error.contains("git lfs pull"), "{error}");
}

#[test]
fn a_picture_beyond_the_edge_is_named_with_its_share() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("white.png");
    RgbImage::from_pixel(8, 8, Rgb([255; 3])).save(&path).unwrap();
    let notes = |centre: [f32; 2]| {
        let placement = Placement { centre: Some(centre), width: Some(0.4), rotate: 0.0 };
        let target = ImageTarget { placement, ..ImageTarget::new("white.png") };
        PictureSampler::load(&path, &target, Vec2::ONE, "keys[1].shows.image").unwrap().notes().join("\n")
    };
    assert_eq!(notes([0.2, 0.8]), "", "it touches two edges");
    // A quarter of the square, and the half of it.
    for (centre, share) in [([0.9, 0.5], "25 %"), ([0.5, 0.0], "50 %")] {
        let text = notes(centre);
        assert!(text.contains(share) && text.contains("(keys[1].shows.image.placement.centre)"), "{text}");
    }
}
