//! Pictures: orientation, windows and layers, colour tags, formats. All files are built here, byte by byte where it matters.

use std::io::{Cursor, Write as _};

use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, ImageAttributes, IntegerBounds, Layer,
    LayerAttributes, Vec2 as Place, WritableImage as _,
};
use glam::{Vec2, vec2};
use image::codecs::jpeg::JpegEncoder;
use image::codecs::webp::WebPEncoder;
use image::{DynamicImage, ImageBuffer, ImageEncoder as _, ImageFormat, Luma, Rgb, RgbImage};
use lightloom_core::targets::{Brightness, ImageTarget, PictureSampler};

/// The brightness of a file's pixels over that of the brightest, in blocks of a picture's longer side over `side`.
fn brightness(content: &[u8], side: usize) -> Result<Brightness, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("picture");
    std::fs::write(&path, content).unwrap();
    Brightness::load(&path, &ImageTarget::new("picture"), side).map_err(|error| error.to_string())
}

/// The notes on a file.
fn notes(content: &[u8]) -> String {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("picture");
    std::fs::write(&path, content).unwrap();
    PictureSampler::load(&path, &ImageTarget::new("picture"), Vec2::ONE, "target").unwrap().notes().join("\n")
}

fn encoded(image: &DynamicImage, format: ImageFormat) -> Vec<u8> {
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
fn with_chunk(mut png: Vec<u8>, name: &[u8; 4], data: &[u8]) -> Vec<u8> {
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

fn srgb(value: f64) -> f64 {
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

/// An EXR file: its display window, its data window, and channels with their values, left to right, top to bottom.
fn exr_file(display: [i32; 4], data: [i32; 4], aspect: f32, layers: &[(&str, &[(&str, &[f32])])]) -> Vec<u8> {
    let mut attributes = ImageAttributes::new(IntegerBounds::new(
        Place(display[0], display[1]),
        Place(display[2] as usize, display[3] as usize),
    ));
    attributes.pixel_aspect = aspect;
    let layer = |(name, channels): &(&str, &[(&str, &[f32])])| {
        let channel =
            |(name, values): &(&str, &[f32])| AnyChannel::new(*name, FlatSamples::F32(values.to_vec()));
        let mut own = LayerAttributes::named(*name);
        own.layer_position = Place(data[0], data[1]);
        let channels = AnyChannels::sort(channels.iter().map(channel).collect());
        Layer::new((data[2] as usize, data[3] as usize), own, Encoding::UNCOMPRESSED, channels)
    };
    let image = Image::from_layers(attributes, layers.iter().map(layer).collect::<Vec<_>>());
    let mut bytes = Cursor::new(Vec::new());
    image.write().non_parallel().to_buffered(&mut bytes).unwrap();
    bytes.into_inner()
}

#[test]
fn the_display_window_of_an_exr_file_is_shown() {
    let rgb: &[(&str, &[f32])] =
        &[("R", &[1.0, 0.5, 0.25, 0.125]), ("G", &[1.0, 0.5, 0.25, 0.125]), ("B", &[1.0, 0.5, 0.25, 0.125])];
    let (one, half, quarter) = (1.0, 0.5, 0.25);
    let rows: [([i32; 4], [i32; 4], [f32; 2], Vec<f32>); 6] = [
        ([0, 0, 2, 2], [0, 0, 2, 2], [2.0, 2.0], vec![one, half, quarter, 0.125]),
        // A part of it is stored.
        ([0, 0, 3, 3], [1, 0, 2, 2], [3.0, 3.0], vec![0., one, half, 0., quarter, 0.125, 0., 0., 0.]),
        // More than it is stored.
        ([0, 0, 1, 2], [0, 0, 2, 2], [1.0, 2.0], vec![one, quarter]),
        ([0, 0, 2, 2], [-1, 0, 2, 2], [2.0, 2.0], vec![one, 0., quarter, 0.]),
        // An origin of its own.
        ([-5, -7, 3, 2], [-4, -7, 2, 2], [3.0, 2.0], vec![0., one, half, 0., quarter, 0.125]),
        ([10, 10, 2, 3], [9, 12, 2, 2], [2.0, 3.0], vec![0., 0., 0., 0., one, 0.]),
    ];
    for (display, data, size, expected) in rows {
        let shown = brightness(&exr_file(display, data, 1.0, &[("", rgb)]), 3).unwrap();
        assert_eq!(
            (shown.size, shown.values.len()),
            (Vec2::from(size), expected.len()),
            "{display:?} {data:?}"
        );
        let most = expected.iter().copied().fold(0.0, f32::max);
        // Over the brightest: the last row shows 0.5 of the file as 1, so it is compared as a ratio.
        let near = |(a, b): (&f32, &f32)| (a - b / most).abs() < 1e-6 || most < 1.0;
        assert!(shown.values.iter().zip(&expected).all(near), "{display:?} {data:?}: {:?}", shown.values);
        assert_eq!(
            shown.values.iter().map(|v| *v > 0.0).collect::<Vec<_>>(),
            expected.iter().map(|v| *v > 0.0).collect::<Vec<_>>()
        );
    }
    let outside = brightness(&exr_file([0, 0, 2, 2], [5, 5, 2, 2], 1.0, &[("", rgb)]), 3).unwrap_err();
    assert!(outside.contains("display window"), "{outside}");
    let huge = brightness(&exr_file([0, 0, 60_000, 60_000], [0, 0, 2, 2], 1.0, &[("", rgb)]), 3).unwrap_err();
    assert!(huge.contains("the limits are"), "{huge}");
}

#[test]
fn the_pixels_of_an_anamorphic_picture_are_wide() {
    let rgb: &[(&str, &[f32])] = &[("R", &[1.0; 8]), ("G", &[1.0; 8]), ("B", &[1.0; 8])];
    for (aspect, width) in [(1.0, 4.0), (2.0, 8.0), (0.5, 2.0)] {
        let file = exr_file([0, 0, 4, 2], [0, 0, 4, 2], aspect, &[("", rgb)]);
        assert_eq!(brightness(&file, 4).unwrap().size, vec2(width, 2.0), "{aspect}");
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("t.exr");
        std::fs::write(&path, file).unwrap();
        let sampler =
            PictureSampler::load(&path, &ImageTarget::new("t.exr"), vec2(1.0, 1.0), "target").unwrap();
        let points = sampler.sample(1, 0, 4000).positions;
        let reach = points.iter().fold(Vec2::ZERO, |reach, p| reach.max((*p - 0.5).abs())) * 2.0;
        // Nine tenths of the receiver; 4000 points come within a hundredth of the border.
        let shown = vec2(width, 2.0) * 0.9 / width.max(2.0);
        assert!((reach - shown).abs().max_element() < 0.01, "{aspect}: {reach} for {shown}");
    }
}

#[test]
fn the_layer_of_an_exr_file_that_is_the_picture_is_shown() {
    const A: &[f32] = &[1.0, 0.5];
    const B: &[f32] = &[0.1, 0.5];
    const Z: &[f32] = &[7.0, 9.0];
    type Layers<'a> = &'a [(&'a str, &'a [(&'a str, &'a [f32])])];
    // All have 1 and 0.5 in the layer that counts; words of the note.
    let rows: [(&str, Layers<'_>, &str); 12] = [
        ("grey", &[("", &[("Y", A)])], ""),
        ("grey with alpha", &[("", &[("A", &[1.0, 1.0]), ("Y", A)])], ""),
        ("grey in a layer", &[("", &[("mask.Y", A)])], ""),
        ("one layer", &[("", &[("rgba.R", A), ("rgba.G", A), ("rgba.B", A), ("rgba.A", &[1.0, 1.0])])], ""),
        (
            "Blender, Emit before Combined in the file",
            &[(
                "",
                &[
                    ("ViewLayer.AO.R", B),
                    ("ViewLayer.AO.G", B),
                    ("ViewLayer.AO.B", B),
                    ("ViewLayer.Combined.R", A),
                    ("ViewLayer.Combined.G", A),
                    ("ViewLayer.Combined.B", A),
                    ("ViewLayer.Depth.Z", Z),
                    ("ViewLayer.Emit.R", B),
                    ("ViewLayer.Emit.G", B),
                    ("ViewLayer.Emit.B", B),
                ],
            )],
            "'ViewLayer.Combined' is shown, not 'ViewLayer.AO', 'ViewLayer.Emit'",
        ),
        (
            "no layer before others",
            &[("", &[("R", A), ("G", A), ("B", A), ("diffuse.R", B), ("diffuse.G", B), ("diffuse.B", B)])],
            "not 'diffuse'",
        ),
        (
            "beauty before others",
            &[(
                "",
                &[
                    ("albedo.R", B),
                    ("albedo.G", B),
                    ("albedo.B", B),
                    ("beauty.R", A),
                    ("beauty.G", A),
                    ("beauty.B", A),
                ],
            )],
            "'beauty' is shown",
        ),
        (
            "colour before grey",
            &[("", &[("a.Y", B), ("b.R", A), ("b.G", A), ("b.B", A)])],
            "'b' is shown, not 'a'",
        ),
        (
            "normals are no grey",
            &[("", &[("N.X", B), ("N.Y", B), ("N.Z", B), ("c.R", A), ("c.G", A), ("c.B", A)])],
            "",
        ),
        ("depth beside colours", &[("", &[("R", A), ("G", A), ("B", A), ("Z", Z)])], ""),
        ("small letters", &[("", &[("r", A), ("g", A), ("b", A)])], ""),
        (
            "parts",
            &[
                ("depth", &[("Z", Z)]),
                ("Combined", &[("Combined.R", A), ("Combined.G", A), ("Combined.B", A)]),
            ],
            "",
        ),
    ];
    for (name, layers, words) in rows {
        let file = exr_file([0, 0, 2, 1], [0, 0, 2, 1], 1.0, layers);
        let shown = brightness(&file, 2).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!(shown.values, [1.0, 0.5], "{name}");
        let notes = notes(&file);
        assert!(notes.contains(words) && (notes.is_empty() == words.is_empty()), "{name}: {notes}");
    }
    let file = exr_file(
        [0, 0, 2, 1],
        [0, 0, 2, 1],
        1.0,
        &[("", &[("N.X", B), ("N.Y", B), ("N.Z", B), ("Z", Z), ("u.R", A)])],
    );
    let error = brightness(&file, 2).unwrap_err();
    assert!(error.contains("N.X, N.Y, N.Z, Z, u.R"), "{error}");
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
        assert!((f64::from(shown.values[2]) - srgb(128.0 / 255.0)).abs() < 1e-5, "{format:?}");
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
