//! Points drawn from pictures follow their brightness, and no picture file stops the program.

use std::path::{Path, PathBuf};

use exr::prelude::{
    Encoding, Image as ExrImage, Layer, LayerAttributes, SpecificChannels, Vec2 as ExrSize, WritableImage,
};
use glam::{Vec2, Vec3, vec2};
use image::{DynamicImage, GrayImage, ImageBuffer, Luma, LumaA, RgbImage, Rgba, RgbaImage};
use lightloom_core::Error;
use lightloom_core::targets::{Channel, ImageTarget, PictureSampler, Placement, Points, load_points};
use tempfile::TempDir;

/// The full unit square, unless a test places it otherwise.
fn filling() -> ImageTarget {
    let placement = Placement { width: Some(1.0), ..Placement::default() };
    ImageTarget { placement, ..ImageTarget::new("picture") }
}

fn saved(image: impl Into<DynamicImage>) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("picture.png");
    image.into().save(&path).unwrap();
    (folder, path)
}

fn written(bytes: &[u8]) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("picture.png");
    std::fs::write(&path, bytes).unwrap();
    (folder, path)
}

fn saved_exr(
    width: usize,
    height: usize,
    pixel: impl Fn(ExrSize<usize>) -> (f32, f32, f32, f32) + Sync,
) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("picture.exr");
    exr::prelude::write_rgba_file(&path, width, height, |x, y| pixel(ExrSize(x, y))).unwrap();
    (folder, path)
}

fn load(path: &Path, target: &ImageTarget) -> Result<PictureSampler, Error> {
    PictureSampler::load(path, target, Vec2::ONE, "target")
}

fn points_of(image: impl Into<DynamicImage>, target: &ImageTarget, n: usize) -> Points {
    let (_folder, path) = saved(image);
    load(&path, target).unwrap().sample(1, 0, n)
}

fn share(points: &Points, inside: impl Fn(Vec2) -> bool) -> f64 {
    points.positions.iter().filter(|p| inside(**p)).count() as f64 / points.positions.len() as f64
}

fn refusal(path: &Path) -> String {
    let error = load(path, &filling()).unwrap_err();
    assert!(matches!(error, Error::Format { .. } | Error::Limit { .. } | Error::Io { .. }), "{error:?}");
    let message = error.to_string();
    assert!(message.contains(&*path.file_name().unwrap().to_string_lossy()), "{message}");
    message
}

#[test]
fn points_follow_the_brightness_in_linear_light() {
    // Display value 188 is half of 255's light; the columns' light is 1 : 0.5029 : 0 : 0.
    let image = GrayImage::from_fn(64, 64, |x, _| Luma([[255, 188, 0, 0][x as usize / 16]]));
    let points = points_of(image, &filling(), 40_000);
    let left = share(&points, |p| p.x < 0.25);
    // Interpolation moves less than 1/128 of the light over the border between the columns.
    assert!((left - 1.0 / 1.5029).abs() < 0.008, "{left}");
    assert_eq!(points.positions.len(), 40_000);
    assert!(points.colours.is_empty());
    assert!(share(&points, |p| p.x > 0.5 + 1.0 / 64.0) == 0.0);
}

#[test]
fn the_picture_reads_upright() {
    // Only the top left pixel is white.
    let image = GrayImage::from_fn(8, 8, |x, y| Luma([if x + y == 0 { 255 } else { 0 }]));
    let points = points_of(image, &filling(), 100);
    assert_eq!(share(&points, |p| p.x < 0.2 && p.y > 0.8), 1.0);
}

#[test]
fn points_are_spread_more_evenly_than_random_ones() {
    let points = points_of(GrayImage::from_pixel(3, 3, Luma([200])), &filling(), 16_384);
    let mut counts = [0.0; 1024];
    for p in &points.positions {
        let cell = (*p * 32.0).as_uvec2().min(glam::UVec2::splat(31));
        counts[(cell.y * 32 + cell.x) as usize] += 1.0;
    }
    let variance = counts.iter().map(|n: &f64| (n - 16.0).powi(2)).sum::<f64>() / 1024.0;
    // White noise has variance 16.
    assert!(variance < 4.0, "{variance}");
}

#[test]
fn no_pixel_grid_shows() {
    // A grey picture of 4 x 4 pixels: sixteenths of a pixel must hold as many points as any other.
    let points = points_of(GrayImage::from_pixel(4, 4, Luma([90])), &filling(), 65_536);
    let mut phases = [0.0; 16];
    points.positions.iter().for_each(|p| phases[(p.x * 64.0) as usize % 16] += 1.0);
    // 4096 each; stratified, so well within the 64 of white noise.
    assert!(phases.iter().all(|n: &f64| (n - 4096.0).abs() < 32.0), "{phases:?}");
}

#[test]
fn passes_differ_and_the_same_pass_repeats() {
    let (_folder, path) = saved(GrayImage::from_pixel(3, 3, Luma([200])));
    let sampler = load(&path, &filling()).unwrap();
    assert_eq!(sampler.sample(1, 3, 1000), sampler.sample(1, 3, 1000));
    // A power of two once gave every pass the same points.
    assert_ne!(sampler.sample(1, 0, 65_536), sampler.sample(1, 1, 65_536));
    assert_ne!(sampler.sample(1, 3, 1000), sampler.sample(1, 4, 1000));
    assert_ne!(sampler.sample(1, 3, 1000), sampler.sample(2, 3, 1000));
    for n in [0, 1, 17] {
        assert_eq!(sampler.sample(1, 0, n).positions.len(), n);
    }
}

#[test]
fn a_picture_is_placed_turned_and_scaled() {
    let placement = Placement { centre: Some([0.25, 0.5]), width: Some(0.4), rotate: 90.0 };
    let target = ImageTarget { placement, ..ImageTarget::new("picture") };
    // The right half is white; a quarter turn counter-clockwise makes it the upper half.
    let image = GrayImage::from_fn(200, 100, |x, _| Luma([if x < 100 { 0 } else { 255 }]));
    let points = points_of(image, &target, 1000);
    assert_eq!(share(&points, |p| (p.x - 0.25).abs() <= 0.1 && p.y > 0.497 && p.y <= 0.7), 1.0);
    // By default it fits, and keeps its shape.
    let points = points_of(GrayImage::from_pixel(200, 100, Luma([255])), &ImageTarget::new("picture"), 4000);
    let reach = points.positions.iter().fold(Vec2::ZERO, |reach, p| reach.max((*p - 0.5).abs()));
    assert!((reach - vec2(0.45, 0.225)).abs().max_element() < 0.003, "{reach}");
}

#[test]
fn colours_have_mean_luminance_one_and_brightness_is_in_the_density() {
    // Red on the left, white on the right: red has 0.2126 of the luminance.
    let image =
        RgbImage::from_fn(64, 64, |x, _| image::Rgb(if x < 32 { [255, 0, 0] } else { [255, 255, 255] }));
    let points = points_of(image, &ImageTarget { colour: true, ..filling() }, 20_000);
    let left = share(&points, |p| p.x < 0.5);
    assert!((left - 0.2126 / 1.2126).abs() < 0.01, "{left}");
    let luminance = |c: &Vec3| c.dot(Vec3::new(0.2126, 0.7152, 0.0722));
    for (p, colour) in points.positions.iter().zip(&points.colours) {
        assert!((luminance(colour) - 1.0).abs() < 1e-3);
        assert!(p.x > 0.49 || colour.y == 0.0);
    }
}

#[test]
fn a_black_picture_has_no_light() {
    let (_folder, path) = saved(GrayImage::new(16, 16));
    assert!(refusal(&path).contains("no light"));
    let (_folder, path) = saved(RgbaImage::new(16, 16));
    assert!(refusal(&path).contains("no light"));
    let (_folder, path) = saved(GrayImage::from_pixel(4, 4, Luma([100])));
    let error = load(&path, &ImageTarget { threshold: 0.9, ..filling() }).unwrap_err();
    assert!(error.to_string().contains("threshold"), "{error}");
}

#[test]
fn one_lit_pixel_takes_all_points() {
    let image = GrayImage::from_fn(101, 101, |x, y| Luma([if (x, y) == (50, 50) { 1 } else { 0 }]));
    let points = points_of(image, &filling(), 1000);
    assert!(points.positions.iter().all(|p| (*p - 0.5).abs().max_element() <= 1.5 / 101.0));
}

#[test]
fn values_that_are_no_light_count_as_none_and_are_told() {
    let bad = [f32::NAN, f32::INFINITY, -5.0];
    let (_folder, path) = saved_exr(64, 64, |at| {
        let value = if at.x() < 32 { bad[at.y() % 3] } else { 3.0 };
        (value, value, value, 1.0)
    });
    let sampler = load(&path, &filling()).unwrap();
    assert!(sampler.notes()[0].contains("2048 pixels"), "{:?}", sampler.notes());
    let points = sampler.sample(1, 0, 5000);
    assert!(points.positions.iter().all(|p| p.is_finite() && p.x > 0.5 - 1.0 / 64.0));
}

#[test]
fn every_usual_kind_of_png_is_read() {
    let sixteen = ImageBuffer::<Luma<u16>, _>::from_fn(8, 8, |x, _| Luma([if x < 4 { 65_535 } else { 0 }]));
    let grey_alpha = ImageBuffer::from_fn(8, 8, |x, _| LumaA([255_u8, if x < 4 { 255 } else { 0 }]));
    let rgba16 =
        ImageBuffer::<Rgba<u16>, _>::from_fn(8, 8, |x, _| Rgba([9, 9, 9, if x < 4 { 65_535 } else { 0 }]));
    for image in [DynamicImage::from(sixteen), grey_alpha.into(), rgba16.into()] {
        // A pixel's width of interpolation beyond the middle.
        assert_eq!(share(&points_of(image, &filling(), 500), |p| p.x < 0.57), 1.0);
    }
    assert_eq!(points_of(GrayImage::from_pixel(1, 1, Luma([7])), &filling(), 500).positions.len(), 500);
    let thin = ImageTarget::new("picture");
    assert_eq!(points_of(GrayImage::from_pixel(1, 16_384, Luma([7])), &thin, 500).positions.len(), 500);
}

#[test]
fn a_cmyk_jpeg_is_read_whatever_its_name() {
    // ITU T.81: one block of mean value in each of four components, with Adobe's marker for CMYK.
    let mut bytes = b"\xff\xd8\xff\xee\0\x0eAdobe\0\x64\0\0\0\0\0\xff\xdb\0\x43\0".to_vec();
    bytes.extend([1; 64]);
    bytes.extend(b"\xff\xc0\0\x14\x08\0\x08\0\x08\x04\x01\x11\0\x02\x11\0\x03\x11\0\x04\x11\0");
    for table in [0x00, 0x10] {
        // A single code of one bit: difference 0, or end of block.
        bytes.extend([0xff, 0xc4, 0, 20, table, 1]);
        bytes.extend([0; 16]);
    }
    bytes.extend(b"\xff\xda\0\x0e\x04\x01\0\x02\0\x03\0\x04\0\0\x3f\0\0\xff\xd9");
    let (_folder, path) = written(&bytes);
    assert_eq!(load(&path, &filling()).unwrap().sample(1, 0, 100).positions.len(), 100);
}

#[test]
fn a_palette_picture_is_read() {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 4, 1);
    encoder.set_color(png::ColorType::Indexed);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_palette(vec![0, 0, 0, 255, 255, 255]);
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(&[0, 0, 1, 1]).unwrap();
    writer.finish().unwrap();
    let (_folder, path) = written(&bytes);
    let points = load(&path, &filling()).unwrap().sample(1, 0, 100);
    assert!(points.positions.iter().all(|p| p.x > 0.37));
}

#[test]
fn a_black_shape_on_a_transparent_ground_is_its_opacity() {
    let image = RgbaImage::from_fn(32, 32, |x, _| Rgba([0, 0, 0, if x < 16 { 255 } else { 0 }]));
    let (_folder, path) = saved(image);
    let sampler = load(&path, &filling()).unwrap();
    assert!(sampler.notes()[0].contains("opacity"));
    assert_eq!(share(&sampler.sample(1, 0, 500), |p| p.x < 0.54), 1.0);
    // Inverted, black attracts, and what is transparent still does not.
    let points = load(&path, &ImageTarget { invert: true, ..filling() }).unwrap().sample(1, 0, 500);
    assert_eq!(share(&points, |p| p.x < 0.54), 1.0);
    let points =
        load(&path, &ImageTarget { channel: Channel::Alpha, ..filling() }).unwrap().sample(1, 0, 500);
    assert_eq!(share(&points, |p| p.x < 0.54), 1.0);
}

#[test]
fn alpha_is_straight_in_png_and_premultiplied_in_exr() {
    let half = |left: bool, full: f32| if left { full } else { 1.0 };
    // Left: white, half transparent. Its light is half of the right's in both files.
    let png = RgbaImage::from_fn(64, 64, |x, _| Rgba([255, 255, 255, if x < 32 { 128 } else { 255 }]));
    let (_folder_0, png) = saved(png);
    let (_folder_1, exr) = saved_exr(64, 64, |at| {
        let value = half(at.x() < 32, 0.5);
        (value, value, value, value)
    });
    for path in [png, exr] {
        let left = share(&load(&path, &filling()).unwrap().sample(1, 0, 20_000), |p| p.x < 0.5);
        assert!((left - 1.0 / 3.0).abs() < 0.01, "{left}");
    }
}

#[test]
fn pictures_beyond_the_limits_are_refused_by_their_header() {
    let header = |width: u32, height: u32| {
        let mut bytes = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR".to_vec();
        bytes.extend(width.to_be_bytes());
        bytes.extend(height.to_be_bytes());
        bytes.extend([8, 6, 0, 0, 0]);
        let crc = crc32(&bytes[12..]);
        bytes.extend(crc.to_be_bytes());
        bytes.extend(b"\0\0\0\0IDAT\x35\xaf\x06\x1e");
        bytes
    };
    for (width, height) in
        [(200_000, 200_000), (i32::MAX as u32, i32::MAX as u32), (1, 65_535), (16_000, 16_000)]
    {
        let (_folder, path) = written(&header(width, height));
        let message = refusal(&path);
        assert!(message.contains("limit") || width > 1 << 20, "{message}");
    }
}

/// As PNG asks for (ISO 3309).
fn crc32(bytes: &[u8]) -> u32 {
    let bit = |crc: u32| if crc & 1 == 1 { 0xedb8_8320 ^ (crc >> 1) } else { crc >> 1 };
    !bytes.iter().fold(!0, |crc, byte| (0..8).fold(crc ^ u32::from(*byte), |crc, _| bit(crc)))
}

#[test]
fn damaged_files_are_refused_at_any_length() {
    let (_folder_0, png) = saved(RgbImage::from_fn(24, 24, |x, y| image::Rgb([x as u8, y as u8, 9])));
    let (_folder_1, exr) = saved_exr(24, 24, |at| (at.x() as f32, 1.0, 2.0, 1.0));
    for file in [png, exr] {
        let bytes = std::fs::read(file).unwrap();
        for length in (0..bytes.len() - 16).step_by(7) {
            let (_folder, path) = written(&bytes[..length]);
            // A cut may leave all pixels whole; whatever is read must be usable.
            if let Ok(sampler) = load(&path, &filling()) {
                assert!(sampler.sample(1, 0, 10).positions.iter().all(|p| p.is_finite()));
            } else {
                refusal(&path);
            }
        }
        for place in (8..bytes.len()).step_by(3) {
            let mut bytes = bytes.clone();
            bytes[place] ^= 0x41;
            let (_folder, path) = written(&bytes);
            if let Ok(sampler) = load(&path, &filling()) {
                assert!(sampler.sample(1, 0, 10).positions.iter().all(|p| p.is_finite()));
            }
        }
    }
    for bytes in [&b""[..], b"GIF89a", b"\x76\x2f\x31\x01", b"hello", b"\xff\xd8\xff\xe0"] {
        let (_folder, path) = written(bytes);
        refusal(&path);
    }
}

#[test]
fn an_exr_without_rgb_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("depth.exr");
    let channels = SpecificChannels::build().with_channel("Z").with_pixel_fn(|_| (1.0_f32,));
    let layer = Layer::new((8, 8), LayerAttributes::named("depth"), Encoding::FAST_LOSSLESS, channels);
    ExrImage::from_layer(layer).write().to_file(&path).unwrap();
    assert!(refusal(&path).contains("RGB"));
}

#[test]
fn only_regular_files_are_opened() {
    let folder = tempfile::tempdir().unwrap();
    refusal(folder.path());
    refusal(&folder.path().join("missing.png"));
    #[cfg(unix)]
    {
        refusal(Path::new("/dev/zero"));
        let pipe = folder.path().join("pipe");
        if std::process::Command::new("mkfifo").arg(&pipe).status().is_ok_and(|status| status.success()) {
            refusal(&pipe);
        }
    }
}

#[test]
fn settings_out_of_range_are_named() {
    let placed = |placement| ImageTarget { placement, ..filling() };
    let cases = [
        (ImageTarget { threshold: f32::NAN, ..filling() }, "target.threshold"),
        (placed(Placement { width: Some(0.0), ..Placement::default() }), "target.placement.width"),
        (placed(Placement { width: Some(f32::INFINITY), ..Placement::default() }), "target.placement.width"),
        (
            placed(Placement { centre: Some([0.0, f32::NAN]), ..Placement::default() }),
            "target.placement.centre",
        ),
        (placed(Placement { rotate: 1e9, ..Placement::default() }), "target.placement.rotate"),
        (ImageTarget::new(""), "target.file"),
    ];
    for (target, field) in cases {
        let message = target.check("target").unwrap_err().to_string();
        assert!(message.starts_with(field), "{message}");
    }
}

fn points_from(text: &[u8]) -> Result<Points, Error> {
    let (_folder, path) = written(text);
    load_points(&path)
}

#[test]
fn point_files_are_read_with_any_usual_separator() {
    let plain = vec![vec2(0.25, 0.5), vec2(1e-3, -2.0)];
    for text in
        ["0.25,0.5\n.001,-2\n", "x; y\r\n0.25; 0.5\r\n\r\n1e-3;-2", "\u{feff}# dots\n0.25 0.5\n0.001\t-2.0"]
    {
        let (_folder, path) = written(text.as_bytes());
        assert_eq!(load_points(&path).unwrap().positions, plain, "{text}");
    }
    let (_folder, path) = written(b"x,y,r,g,b\n0,0,1,1,1\n1,1,3,3,3\n");
    assert_eq!(load_points(&path).unwrap().colours, [Vec3::splat(0.5), Vec3::splat(1.5)]);
}

#[test]
fn npy_arrays_are_read() {
    // As NumPy 2.4 writes it: 118 bytes of header.
    let header = "{'descr': '<f8', 'fortran_order': False, 'shape': (3, 2), }";
    let mut bytes = b"\x93NUMPY\x01\x00\x76\x00".to_vec();
    bytes.extend(format!("{header:117}\n").bytes());
    bytes.extend([0.0, 0.5, 1.0, 0.25, 0.125, 0.75_f64].map(f64::to_le_bytes).concat());
    let (_folder, path) = written(&bytes);
    assert_eq!(load_points(&path).unwrap().positions, [vec2(0.0, 0.5), vec2(1.0, 0.25), vec2(0.125, 0.75)]);
    for length in 0..bytes.len() {
        let (_folder, path) = written(&bytes[..length]);
        assert!(load_points(&path).is_err());
    }
    bytes.extend([0; 4]);
    let at = bytes.len() - 12;
    bytes[at..at + 8].copy_from_slice(&f64::NAN.to_le_bytes());
    let (_folder, path) = written(&bytes);
    assert!(load_points(&path).unwrap_err().to_string().contains("row 2"));
}

#[test]
fn point_files_name_the_line_that_is_wrong() {
    let cases = [
        ("0,0\n1,nan\n", "line 2"),
        ("x,y\n0,0\n1,1e39\n", "line 3"),
        ("0,0\n1\n", "line 2"),
        ("0,0\n1,2,3\n", "line 2"),
        ("0,0\n\n1,two\n", "line 3"),
        ("x,y,r,g,b\n0,0,1,1,-1\n", "line 2"),
        ("0,0\n1,1,1,1,1\n", "line 2"),
        ("x,y\n", "no points"),
        ("", "no points"),
        ("0,0,0,0,0\n", "black"),
        ("\u{0}\u{0}", "no points"),
    ];
    for (text, place) in cases {
        let message = points_from(text.as_bytes()).unwrap_err().to_string();
        assert!(message.contains(place), "{text:?}: {message}");
    }
    assert!(points_from(&[0xff, 0xfe, 0x31]).is_err());
}

#[test]
fn points_are_resampled_to_any_number() {
    let positions: Vec<Vec2> = (0..1000).map(|i| vec2((i % 40) as f32, (i / 40) as f32)).collect();
    let points = Points { positions: positions.clone(), colours: vec![Vec3::ONE; 1000] };
    assert_eq!(points.resampled(1000, 1, 0), points);
    let count = |n: usize| {
        let resampled = points.resampled(n, 1, 0);
        assert_eq!((resampled.positions.len(), resampled.colours.len()), (n, n));
        positions.iter().map(|p| resampled.positions.iter().filter(|q| *q == p).count()).collect::<Vec<_>>()
    };
    assert!(count(300).iter().all(|n| *n <= 1));
    assert!(count(2500).iter().all(|n| (2..=3).contains(n)));
}
