//! Picture files read back.

use std::fs;
use std::path::Path;

use exr::prelude::{FlatSamples, MetaData, read_all_flat_layers_from_file};
use glam::Vec3;
use half::f16;
use lightloom_core::export::{
    Backdrop, Frame, FrameFormat, FrameLayer, FramePattern, Metadata, Overlay, PngDepth, RepairedSamples,
    evenly_chosen, write_contact_sheet, write_frame,
};
use lightloom_core::math::rng::{Purpose, Stream};
use lightloom_core::render::{Image, View, ViewSettings, ViewTransform};

const SIZE: (usize, usize) = (67, 41);

fn noise(index: u64, scale: f32) -> Image {
    let rng = &mut Stream::new(5, Purpose::Background, 0, index);
    let mut image = Image::new(SIZE.0, SIZE.1);
    image.pixels.iter_mut().for_each(|p| *p = Vec3::new(rng.f32(), rng.f32(), rng.f32()) * scale);
    image
}

fn metadata() -> Metadata {
    Metadata {
        frame: 17,
        frames_per_second: (24, 1),
        seed: u64::MAX,
        passes: 8,
        camera: None,
        settings: vec![
            ("gamma".into(), "0.5".into()),
            ("project".into(), "Blüte".into()),
            ("z".into(), "1".into()),
        ],
    }
}

fn frame<'a>(backdrop: &'a Backdrop<'a>, caustic: &'a Image, metadata: &'a Metadata) -> Frame<'a> {
    Frame { backdrop, caustic, caustics: &[], metadata, compressed: true }
}

fn backdrop(background: &Image) -> Backdrop<'_> {
    Backdrop::new(&FrameLayer::DEFAULT, background, None)
}

fn view(transform: ViewTransform) -> View {
    ViewSettings { exposure: 0.0, transform }.view()
}

fn write(
    path: &Path,
    format: FrameFormat,
    background: &Image,
    caustic: &Image,
) -> lightloom_core::Result<RepairedSamples> {
    let metadata = metadata();
    let backdrop = backdrop(background);
    let frame = frame(&backdrop, caustic, &metadata);
    write_frame(path, format, &frame, &view(ViewTransform::Agx), PngDepth::Eight)
}

/// Names and samples.
type Channels = Vec<(String, Vec<f16>)>;

/// Layer by layer: its name and its channels.
fn read_exr(path: &Path) -> Vec<(String, Channels)> {
    let image = read_all_flat_layers_from_file(path).unwrap();
    let layer = |layer: exr::image::Layer<exr::image::AnyChannels<FlatSamples>>| {
        let name = layer.attributes.layer_name.unwrap().to_string();
        let channels = layer.channel_data.list.into_iter().map(|channel| match channel.sample_data {
            FlatSamples::F16(samples) => (channel.name.to_string(), samples),
            other => panic!("{other:?}"),
        });
        (name, channels.collect())
    };
    image.layer_data.into_iter().map(layer).collect()
}

#[test]
fn an_exr_holds_beauty_caustic_and_background_as_half_floats() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.0017.exr");
    let (background, caustic) = (noise(1, 1.0), noise(2, 50.0));
    assert_eq!(write(&path, FrameFormat::Exr, &background, &caustic).unwrap(), RepairedSamples::default());
    let layers = read_exr(&path);
    assert_eq!(layers.iter().map(|l| l.0.as_str()).collect::<Vec<_>>(), ["rgba", "caustic", "background"]);
    let channel = |layer: usize, name: &str| &layers[layer].1.iter().find(|c| c.0 == name).unwrap().1;
    assert!(channel(0, "A").iter().all(|a| *a == f16::ONE));
    for (c, name) in ["R", "G", "B"].into_iter().enumerate() {
        for i in 0..SIZE.0 * SIZE.1 {
            let (b, k) = (background.pixels[i][c], caustic.pixels[i][c]);
            assert_eq!(channel(0, name)[i], f16::from_f32(b + k), "the sum is rounded once");
            assert_eq!(channel(1, &format!("caustic.{name}"))[i], f16::from_f32(k));
            assert_eq!(channel(2, &format!("background.{name}"))[i], f16::from_f32(b));
        }
    }
}

#[test]
fn an_exr_says_what_it_is_and_names_neither_date_nor_host() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.0017.exr");
    write(&path, FrameFormat::Exr, &noise(1, 1.0), &noise(2, 1.0)).unwrap();
    let meta = MetaData::read_from_file(&path, true).unwrap();
    for header in &meta.headers {
        let attributes = &header.own_attributes;
        let text = |name: &str| format!("{:?}", attributes.other.get(name.as_bytes()).unwrap());
        assert!(attributes.software_name.as_ref().unwrap().to_string().starts_with("Lightloom "));
        assert_eq!(attributes.frames_per_second, Some((24, 1)));
        assert!(text("colorInteropID").contains("lin_rec709_scene"));
        assert!(text("lightloom:frame").contains("17"));
        assert!(text("lightloom:seed").contains("18446744073709551615"));
        assert!(text("lightloom:passes").contains('8'));
        assert!(text("lightloom:gamma").contains("0.5"));
        assert!(text("lightloom:half_clamped").contains('0'));
        assert_eq!(attributes.capture_date, None);
        assert_eq!(header.shared_attributes.chromaticities.unwrap().red.0, 0.64);
    }
}

#[test]
fn equal_input_gives_equal_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let (background, caustic) = (noise(1, 1.0), noise(2, 1.0));
    for format in FrameFormat::ALL {
        let paths: Vec<_> =
            (0..8).map(|i| folder.path().join(format!("{i}.{}", format.extension()))).collect();
        for path in &paths {
            write(path, format, &background, &caustic).unwrap();
        }
        let first = fs::read(&paths[0]).unwrap();
        assert!(paths.iter().all(|path| fs::read(path).unwrap() == first), "{format:?}");
    }
}

#[test]
fn what_a_half_float_cannot_hold_is_clamped_and_counted() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.exr");
    let (mut background, mut caustic) = (noise(1, 1.0), noise(2, 1.0));
    background.pixels[3] = Vec3::new(f32::NAN, 1.0, 2.0);
    caustic.pixels[3] = Vec3::new(0.25, f32::NEG_INFINITY, 1e6);
    let repairs = write(&path, FrameFormat::Exr, &background, &caustic).unwrap();
    // The blue sample is too large in the caustic and in the beauty.
    assert_eq!(repairs, RepairedSamples { half_clamped: 2, nonfinite_replaced: 2 });
    let layers = read_exr(&path);
    let at = |layer: usize, name: &str| layers[layer].1.iter().find(|c| c.0 == name).unwrap().1[3].to_f32();
    assert_eq!([at(0, "R"), at(0, "G"), at(0, "B")], [0.25, 1.0, 65504.0]);
    assert_eq!([at(1, "caustic.R"), at(1, "caustic.G"), at(1, "caustic.B")], [0.25, 0.0, 65504.0]);
    let meta = MetaData::read_from_file(&path, true).unwrap();
    let count = &meta.headers[0].own_attributes.other["lightloom:nonfinite_replaced".as_bytes()];
    assert!(format!("{count:?}").contains('2'));
}

#[test]
fn a_png_shows_the_view_transform_within_one_step() {
    let folder = tempfile::tempdir().unwrap();
    let (background, caustic) = (noise(1, 0.5), noise(2, 0.5));
    for (depth, most) in [(PngDepth::Eight, 255.0), (PngDepth::Sixteen, 65_535.0)] {
        let path = folder.path().join("a.png");
        let metadata = metadata();
        let backdrop = backdrop(&background);
        let frame = frame(&backdrop, &caustic, &metadata);
        let shown = view(ViewTransform::Standard);
        write_frame(&path, FrameFormat::Png, &frame, &shown, depth).unwrap();
        let read = image::open(&path).unwrap();
        let values: Vec<f32> = match depth {
            PngDepth::Eight => read.as_rgb8().unwrap().as_raw().iter().map(|&v| f32::from(v)).collect(),
            PngDepth::Sixteen => read.as_rgb16().unwrap().as_raw().iter().map(|&v| f32::from(v)).collect(),
        };
        let beauty = background.plus(&caustic);
        for (i, value) in values.iter().enumerate() {
            let expected = shown.encode(beauty.pixels[i / 3])[i % 3] * most;
            assert!((value - expected).abs() <= 1.0, "{value} for {expected}");
        }
        let bytes = fs::read(&path).unwrap();
        assert!(bytes.windows(4).any(|chunk| chunk == b"sRGB"));
    }
}

#[test]
fn the_dither_keeps_black_white_and_grey_and_the_mean_of_a_faint_gradient() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.png");
    let level = 100.3 / 255.0;
    let mut screen = Image::new(256, 64);
    screen.pixels.fill(Vec3::splat(level));
    screen.pixels[0] = Vec3::ZERO;
    screen.pixels[1] = Vec3::ONE;
    lightloom_core::export::png::write(&path, &screen, PngDepth::Eight).unwrap();
    let read = image::open(&path).unwrap().to_rgb8();
    assert_eq!((read.get_pixel(0, 0).0, read.get_pixel(1, 0).0), ([0; 3], [255; 3]));
    assert!(read.pixels().all(|p| p.0[0] == p.0[1] && p.0[1] == p.0[2]));
    let rest: Vec<f64> = read.pixels().skip(2).map(|p| f64::from(p.0[0])).collect();
    // 16 382 pixels of a well-spread threshold: the share of the upper step is right to better than 1 %.
    assert!((rest.iter().sum::<f64>() / rest.len() as f64 - 100.3).abs() < 0.01);
}

#[test]
fn a_folder_that_cannot_be_written_is_named_and_nothing_is_left() {
    let folder = tempfile::tempdir().unwrap();
    let missing = folder.path().join("missing");
    for format in FrameFormat::ALL {
        let error = write(&missing.join("a.0001.exr"), format, &noise(1, 1.0), &noise(2, 1.0)).unwrap_err();
        assert!(error.to_string().contains(&missing.display().to_string()), "{error}");
    }
    // A folder stands where the file should go: the write itself works, the last step fails.
    let blocked = folder.path().join("b.0001.png");
    fs::create_dir_all(blocked.join("inside")).unwrap();
    let error = write(&blocked, FrameFormat::Png, &noise(1, 1.0), &noise(2, 1.0)).unwrap_err();
    assert!(error.to_string().contains("b.0001.png"), "{error}");
    let left: Vec<_> = folder.path().read_dir().unwrap().map(|e| e.unwrap().file_name()).collect();
    assert_eq!(left, ["b.0001.png"], "no temporary file");
}

#[test]
fn a_failed_write_keeps_the_file_that_was_there() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.txt");
    fs::write(&path, "before").unwrap();
    let full = || std::io::Error::other("disk full");
    let error = lightloom_core::files::write_atomic(&path, |file| {
        std::io::Write::write_all(file, b"half")?;
        Err(full())
    });
    assert!(error.unwrap_err().to_string().contains("disk full"));
    assert_eq!(fs::read_to_string(&path).unwrap(), "before");
    assert_eq!(folder.path().read_dir().unwrap().count(), 1);
}

#[test]
fn frames_are_named_by_the_pattern() {
    let name = |pattern: &str, frame| {
        let pattern = FramePattern::parse(pattern, "output.name").unwrap();
        pattern.path(Path::new("out"), frame, FrameFormat::Exr).display().to_string()
    };
    assert_eq!(name("glass.####", 7), "out/glass.0007.exr");
    assert_eq!(name("glass.%04d.png", 7), "out/glass.0007.exr");
    assert_eq!(name("glass.#", 1234), "out/glass.1234.exr");
    assert_eq!(name("glass_v001.%d", 12), "out/glass_v001.12.exr");
    assert_eq!(name("a.####.left", -3), "out/a.-003.left.exr");
}

#[test]
fn a_pattern_without_a_number_is_refused_with_a_way_out() {
    for (pattern, says) in [
        ("glass", "glass.####"),
        ("glass.exr", "glass.####"),
        ("glass####", "'name.####'"),
        (".####", "'name.####'"),
        ("a.####.##", "two places"),
        ("../glass.####", "without folders"),
        ("a.%99d", "1 to 10 digits"),
        ("", "no place for the frame number"),
    ] {
        let error = FramePattern::parse(pattern, "output.name").unwrap_err().to_string();
        assert!(error.starts_with("output.name: ") && error.contains(says), "{error}");
    }
}

#[test]
fn the_contact_sheet_chooses_evenly_and_keeps_first_and_last() {
    let frames: Vec<i32> = (1..=100).collect();
    let chosen = evenly_chosen(&frames, 12);
    assert_eq!((chosen.len(), chosen[0], chosen[11]), (12, 1, 100));
    assert!(chosen.windows(2).all(|pair| pair[1] - pair[0] == 9), "{chosen:?}");
    assert_eq!(evenly_chosen(&frames[..3], 12), [1, 2, 3]);
    assert_eq!(evenly_chosen(&frames, 1), [1]);
    assert!(evenly_chosen(&[], 5).is_empty() && evenly_chosen(&frames, 0).is_empty());
}

#[test]
fn the_contact_sheet_holds_every_picture() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("sheet.png");
    let pictures: Vec<(i32, Image)> = (0..5)
        .map(|i| {
            let mut image = Image::new(40, 30);
            image.pixels.fill(Vec3::new(0.0, 0.2 * i as f32, 1.0));
            (90 + 5 * i, image)
        })
        .collect();
    write_contact_sheet(&path, &pictures, 3, Overlay::NONE, &[]).unwrap();
    let read = image::open(&path).unwrap().to_rgb8();
    for i in 0..5_u8 {
        let shown = read.pixels().filter(|p| p.0[2] == 255 && p.0[1] == 51 * i).count();
        assert_eq!(shown, 40 * 30, "picture {i}");
    }
    write_contact_sheet(&path, &[], 3, Overlay::NONE, &[]).unwrap();
}
