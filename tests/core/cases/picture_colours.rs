//! Colour tags of pictures: what their numbers mean as light.

use std::io::Write as _;

use image::codecs::jpeg::JpegEncoder;
use image::codecs::webp::WebPEncoder;
use image::{ImageBuffer, ImageEncoder as _, ImageFormat, Luma, Rgb, RgbImage};

use super::pictures::{brightness, encoded, notes, with_chunk};

/// Values of a PNG file's left and right half.
const HALVES: [f64; 2] = [0.25, 0.5];

fn halves() -> Vec<u8> {
    let pixel = |x: u32, _| Luma([(HALVES[x as usize / 2] * 65535.0) as u16]);
    encoded(&ImageBuffer::from_fn(4, 2, pixel).into(), ImageFormat::Png)
}

fn halves_in_colour() -> Vec<u8> {
    let pixel = |x: u32, _| Rgb([(HALVES[x as usize / 2] * 65535.0) as u16; 3]);
    encoded(&ImageBuffer::<Rgb<u16>, _>::from_fn(4, 2, pixel).into(), ImageFormat::Png)
}

/// A profile of the ICC, version 2.1: `RGB ` with the colorants of sRGB, or `GRAY`; all its curves are `curve`.
fn icc(space: &[u8; 4], curve: &[u8]) -> Vec<u8> {
    let fixed = |values: [f64; 3]| -> Vec<u8> {
        let number = |value: f64| ((value * 65536.0).round() as i32).to_be_bytes();
        [&b"XYZ \0\0\0\0"[..], &values.map(number).concat()].concat()
    };
    let white = [0.9642, 1.0, 0.8249];
    let mut tags: Vec<(&[u8; 4], Vec<u8>)> = vec![(b"wtpt", fixed(white))];
    if space == b"GRAY" {
        tags.push((b"kTRC", curve.to_vec()));
    } else {
        tags.extend([
            (b"rXYZ", fixed([0.43607, 0.22249, 0.01392])),
            (b"gXYZ", fixed([0.38515, 0.71687, 0.09708])),
        ]);
        tags.push((b"bXYZ", fixed([0.14307, 0.06061, 0.71410])));
        tags.extend([b"rTRC", b"gTRC", b"bTRC"].map(|name| (name, curve.to_vec())));
    }
    let mut table = (tags.len() as u32).to_be_bytes().to_vec();
    let mut data = Vec::new();
    for (name, tag) in &tags {
        let at = 128 + 4 + 12 * tags.len() + data.len();
        table.extend([&name[..], &(at as u32).to_be_bytes(), &(tag.len() as u32).to_be_bytes()].concat());
        data.extend_from_slice(tag);
        data.resize(data.len().next_multiple_of(4), 0);
    }
    let size = 128 + table.len() + data.len();
    let mut header = vec![0; 128];
    header[..4].copy_from_slice(&(size as u32).to_be_bytes());
    header[8] = 2;
    header[9] = 0x10;
    header[12..24].copy_from_slice(&[&b"mntr"[..], space, b"XYZ "].concat());
    header[36..40].copy_from_slice(b"acsp");
    header[68..80].copy_from_slice(&fixed(white)[8..]);
    [header, table, data].concat()
}

/// A curve of the ICC: a straight line, a power, or samples.
fn curve(values: &[u16]) -> Vec<u8> {
    let mut tag = b"curv\0\0\0\0".to_vec();
    tag.extend((values.len() as u32).to_be_bytes());
    tag.extend(values.iter().flat_map(|value| value.to_be_bytes()));
    tag
}

fn with_icc(png: Vec<u8>, profile: &[u8]) -> Vec<u8> {
    let mut packed = flate2::write::ZlibEncoder::new(b"own\0\0".to_vec(), flate2::Compression::default());
    packed.write_all(profile).unwrap();
    with_chunk(png, b"iCCP", &packed.finish().unwrap())
}

pub(super) fn srgb(value: f64) -> f64 {
    ((value + 0.055) / 1.055).powf(2.4)
}

/// SMPTE ST 2084.
fn pq(value: f64) -> f64 {
    let v = value.powf(1.0 / 78.84375);
    ((v - 0.8359375).max(0.0) / (18.8515625 - 18.6875 * v)).powf(1.0 / 0.1593017578125)
}

/// ITU-R BT.709.
fn rec709(value: f64) -> f64 {
    ((value + 0.099) / 1.099).powf(1.0 / 0.45)
}

#[test]
fn colours_of_png_are_read_by_their_tags() {
    let gamma = |value: u32| value.to_be_bytes();
    let chromaticities: Vec<u8> =
        [31270_u32, 32900, 64000, 33000, 30000, 60000, 15000, 6000].map(u32::to_be_bytes).concat();
    let line = |x: f64| x;
    let table: Vec<u16> = (0..256).map(|i| ((f64::from(i) / 255.0).powf(1.5) * 65535.0) as u16).collect();
    type Curve = fn(f64) -> f64;
    let rows: [(&str, Vec<u8>, Curve); 20] = [
        ("no tag", halves(), srgb),
        ("gAMA 1", with_chunk(halves(), b"gAMA", &gamma(100_000)), line),
        ("gAMA 1, in colour", with_chunk(halves_in_colour(), b"gAMA", &gamma(100_000)), line),
        ("gAMA 1/1.8", with_chunk(halves(), b"gAMA", &gamma(55_556)), |x| x.powf(1.8)),
        ("gAMA 1/2.2 of sRGB", with_chunk(halves(), b"gAMA", &gamma(45_455)), srgb),
        (
            "gAMA of sRGB with its primaries",
            with_chunk(with_chunk(halves(), b"cHRM", &chromaticities), b"gAMA", &gamma(45_455)),
            srgb,
        ),
        (
            "gAMA 1 with primaries",
            with_chunk(with_chunk(halves(), b"cHRM", &chromaticities), b"gAMA", &gamma(100_000)),
            line,
        ),
        (
            "sRGB counts before gAMA",
            with_chunk(with_chunk(halves(), b"gAMA", &gamma(100_000)), b"sRGB", &[0]),
            srgb,
        ),
        ("gAMA 0 means nothing", with_chunk(halves(), b"gAMA", &gamma(0)), srgb),
        ("iCCP, a line", with_icc(halves_in_colour(), &icc(b"RGB ", &curve(&[]))), line),
        ("iCCP, a power of 2.2", with_icc(halves_in_colour(), &icc(b"RGB ", &curve(&[563]))), |x| {
            x.powf(563.0 / 256.0)
        }),
        ("iCCP, samples", with_icc(halves_in_colour(), &icc(b"RGB ", &curve(&table))), |x| x.powf(1.5)),
        ("iCCP of grey, a line", with_icc(halves(), &icc(b"GRAY", &curve(&[]))), line),
        ("iCCP of grey, a power of 1.8", with_icc(halves(), &icc(b"GRAY", &curve(&[461]))), |x| {
            x.powf(461.0 / 256.0)
        }),
        ("iCCP of RGB for a grey picture", with_icc(halves(), &icc(b"RGB ", &curve(&[]))), line),
        (
            "iCCP counts before gAMA",
            with_chunk(with_icc(halves(), &icc(b"RGB ", &curve(&[]))), b"gAMA", &gamma(45_455)),
            line,
        ),
        ("cICP, linear", with_chunk(halves_in_colour(), b"cICP", &[1, 8, 0, 1]), line),
        (
            "cICP, sRGB, before gAMA",
            with_chunk(with_chunk(halves(), b"gAMA", &gamma(100_000)), b"cICP", &[1, 13, 0, 1]),
            srgb,
        ),
        ("cICP, PQ", with_chunk(halves_in_colour(), b"cICP", &[9, 16, 0, 1]), pq),
        ("cICP, Rec.709", with_chunk(halves_in_colour(), b"cICP", &[1, 1, 0, 1]), rec709),
    ];
    for (name, file, curve) in rows {
        let shown = brightness(&file, 4).unwrap();
        let expected = curve(HALVES[0]) / curve(HALVES[1]);
        // Curves of a profile are tables, of 14 bits or more.
        assert!(
            (f64::from(shown.values[0]) / expected - 1.0).abs() < 2e-3,
            "{name}: {} for {expected}",
            shown.values[0]
        );
        assert_eq!(shown.values[3], 1.0, "{name}");
    }
}

#[test]
fn profiles_of_other_formats_count_too() {
    let pixel = |x: u32, _| Rgb([(HALVES[x as usize / 8] * 255.0).round() as u8; 3]);
    let image = RgbImage::from_fn(16, 8, pixel);
    let profile = icc(b"RGB ", &curve(&[]));
    let mut jpeg = Vec::new();
    let mut encoder = JpegEncoder::new_with_quality(&mut jpeg, 100);
    encoder.set_icc_profile(profile.clone()).unwrap();
    encoder.encode_image(&image).unwrap();
    let mut webp = Vec::new();
    let mut encoder = WebPEncoder::new_lossless(&mut webp);
    encoder.set_icc_profile(profile).unwrap();
    encoder.encode(&image, 16, 8, image::ExtendedColorType::Rgb8).unwrap();
    for file in [jpeg, webp] {
        let shown = brightness(&file, 2).unwrap();
        // A step of 255, and those of JPEG.
        assert!((shown.values[0] - 0.5).abs() < 0.02, "{}", shown.values[0]);
    }
}

#[test]
fn dark_linear_light_keeps_its_digits() {
    let pixel = |x: u32, _| Luma([[20_u16, 40, 200, 65535][x as usize]]);
    let png = encoded(&ImageBuffer::from_fn(4, 1, pixel).into(), ImageFormat::Png);
    let shown = brightness(&with_chunk(png, b"gAMA", &100_000_u32.to_be_bytes()), 4).unwrap();
    for (value, stored) in shown.values.iter().zip([20.0, 40.0, 200.0, 65535.0]) {
        assert!((value * 65535.0 / stored - 1.0).abs() < 0.02, "{value} for {stored}");
    }
}

#[test]
fn profiles_that_cannot_be_used_are_told() {
    for (file, words) in [
        (with_icc(halves(), b"no profile"), "ICC profile"),
        (with_icc(halves_in_colour(), &icc(b"CMYK", &curve(&[]))), "ICC profile"),
        (with_chunk(halves(), b"cICP", &[1, 250, 0, 1]), "cICP"),
    ] {
        let notes = notes(&file);
        assert!(notes.contains(words) && notes.contains("read as sRGB"), "{words}: {notes}");
    }
    assert_eq!(notes(&halves()), "");
}

#[test]
fn primaries_are_those_of_the_tag() {
    // Pure red and pure green of Display P3 in Rec.709 (SMPTE EG 432-1), what is negative left out, times luminance.
    let expected = 0.2126 * 1.2249 / (0.7152 * 1.0420);
    let pixel = |x: u32, _| Rgb([[255_u8, 0, 0], [0, 255, 0]][x as usize]);
    let png = encoded(&RgbImage::from_fn(2, 1, pixel).into(), ImageFormat::Png);
    let points: Vec<u8> =
        [31270_u32, 32900, 68000, 32000, 26500, 69000, 15000, 6000].map(u32::to_be_bytes).concat();
    for file in [
        with_chunk(png.clone(), b"cICP", &[12, 13, 0, 1]),
        with_chunk(with_chunk(png.clone(), b"cHRM", &points), b"gAMA", &45_455_u32.to_be_bytes()),
    ] {
        let shown = brightness(&file, 2).unwrap();
        // Four digits of the matrix.
        assert!((shown.values[0] / expected - 1.0).abs() < 2e-3, "{} for {expected}", shown.values[0]);
    }
    let plain = brightness(&png, 2).unwrap();
    assert!((plain.values[0] - 0.2126 / 0.7152).abs() < 1e-3);
}
