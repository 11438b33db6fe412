//! OpenEXR pictures: windows, pixels that are not square, layers.

use std::io::Cursor;

use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, ImageAttributes, IntegerBounds, Layer,
    LayerAttributes, Vec2 as Place, WritableImage as _,
};
use glam::{Vec2, vec2};
use lightloom_core::targets::{ImageTarget, PictureSampler};

use super::pictures::{brightness, notes};

/// A channel of an EXR file, with its values.
type Channel<'a> = (&'a str, &'a [f32]);
/// The parts of an EXR file, with their channels.
type Layers<'a> = &'a [(&'a str, &'a [Channel<'a>])];
/// Corner, width and height.
type Window = [i32; 4];

/// An EXR file: its display window, its data window, and channels with their values, left to right, top to bottom.
fn exr_file(display: Window, data: Window, aspect: f32, layers: Layers<'_>) -> Vec<u8> {
    let mut attributes = ImageAttributes::new(IntegerBounds::new(
        Place(display[0], display[1]),
        Place(display[2] as usize, display[3] as usize),
    ));
    attributes.pixel_aspect = aspect;
    let layer = |(name, channels): &(&str, &[Channel<'_>])| {
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
    let rows: [(Window, Window, [f32; 2], Vec<f32>); 6] = [
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
    // All have 1 and 0.5 in the layer that counts; words of the note.
    let rows: [(&str, Layers<'_>, &str); 13] = [
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
        (
            "a layer without name",
            &[("", &[("R", A), ("G", A), ("B", A), ("x.R", B), ("x.G", B), ("x.B", B)])],
            "the one without name is shown, not 'x'",
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
