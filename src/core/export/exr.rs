//! OpenEXR: a part for each layer, half float but for the depth.
//!
//! The part `rgba` is the beauty with the channels `R`, `G`, `B`, `A`; those of the others bear the name of their layer
//! before a dot, which Nuke, OpenImageIO and Blender take for the layer's name: `caustic.R`. Beauty is background +
//! caustic, summed in f32 before each is rounded to half. The files hold no date and no host name, and their attributes
//! are sorted: equal input gives equal bytes.

use std::collections::HashMap;
use std::io::{Cursor, Write};
use std::path::Path;

use exr::meta::attribute::{AttributeValue, Chromaticities, IntegerBounds};
use exr::prelude::{
    AnyChannel, AnyChannels, Blocks, Compression, Encoding, FlatSamples, Image as ExrImage, ImageAttributes,
    Layer, LayerAttributes, LineOrder, ReadChannels as _, ReadLayers as _, Text, Vec2, WritableImage,
};
use glam::Vec3;
use half::f16;

use super::frame::{Frame, Metadata, RepairedSamples};
use super::layer::FrameLayer;
use super::projection;
use super::time_code::time_code;
use crate::render::image::Image;
use crate::{Error, Result};

/// Writes a frame; returns the repaired samples, which the metadata counts too.
pub fn write<'a>(path: &Path, frame: &Frame<'a>) -> Result<RepairedSamples> {
    let size = (frame.background.width, frame.background.height);
    assert_eq!(size, (frame.caustic.width, frame.caustic.height), "layers of one size");
    let mut repairs = RepairedSamples::default();
    let mut finite = |v: Vec3| {
        let fixed = v.to_array().map(|v| if v.is_finite() { v } else { 0.0 });
        repairs.nonfinite_replaced += v.to_array().iter().filter(|v| !v.is_finite()).count() as u64;
        Vec3::from(fixed)
    };
    let mut layer = |image: &Image| -> Vec<Vec3> { image.pixels.iter().map(|&v| finite(v)).collect() };
    let caustic = layer(frame.caustic);
    let background = layer(frame.background);
    let single: Vec<(&str, Vec<Vec3>)> =
        frame.caustics.iter().map(|(name, image)| (name.as_str(), layer(image))).collect();
    let beauty: Vec<Vec3> = background.iter().zip(&caustic).map(|(b, c)| b + c).collect();
    let covered = vec![1.0; caustic.len()];
    let alpha = frame.first_hits.map_or(&covered, |hits| &hits.coverage);
    let mut parts: Vec<(&str, Vec<AnyChannel<FlatSamples>>)> = Vec::new();
    for layer in FrameLayer::ALL.into_iter().filter(|layer| frame.layers.contains(layer)) {
        let mut colours = |of: &str, values: &[Vec3]| colours(of, values, &mut repairs.half_clamped);
        let mut with_alpha = |of: &str, values: &[Vec3]| {
            let mut channels = colours(of, values);
            channels.push(halves(format!("{of}A"), alpha.iter().copied(), &mut 0));
            channels
        };
        match layer {
            FrameLayer::Beauty => parts.push(("rgba", with_alpha("", &beauty))),
            FrameLayer::Caustic => parts.push(("caustic", colours("caustic.", &caustic))),
            FrameLayer::Caustics => {
                let part =
                    |(name, values): &(&'a str, Vec<Vec3>)| (*name, colours(&format!("{name}."), values));
                parts.extend(single.iter().map(part));
            }
            FrameLayer::Background => parts.push(("background", with_alpha("background.", &background))),
            FrameLayer::Depth => parts.extend(frame.first_hits.map(|hits| {
                ("depth", vec![AnyChannel::new("depth.Z", FlatSamples::F32(hits.depth.clone()))])
            })),
            FrameLayer::Plane => (),
        }
    }
    save(path, parts, size, frame.metadata, repairs)?;
    Ok(repairs)
}

/// Writes the light on the plane in 32-bit floats, `R`, `G` and `B`; returns the repaired samples.
pub fn write_plane(path: &Path, irradiance: &Image, metadata: &Metadata) -> Result<RepairedSamples> {
    let bad = |v: &Vec3| v.to_array().iter().filter(|v| !v.is_finite()).count() as u64;
    let repairs =
        RepairedSamples { half_clamped: 0, nonfinite_replaced: irradiance.pixels.iter().map(bad).sum() };
    let channel = |(i, name)| {
        let values = irradiance.pixels.iter().map(|v| if v[i].is_finite() { v[i] } else { 0.0 });
        AnyChannel::new(name, FlatSamples::F32(values.collect()))
    };
    let channels = ["R", "G", "B"].into_iter().enumerate().map(channel).collect();
    save(path, vec![("plane", channels)], (irradiance.width, irradiance.height), metadata, repairs)?;
    Ok(repairs)
}

/// Writes parts of one size atomically.
fn save(
    path: &Path,
    parts: Vec<(&str, Vec<AnyChannel<FlatSamples>>)>,
    size: (usize, usize),
    metadata: &Metadata,
    repairs: RepairedSamples,
) -> Result<()> {
    let count = parts.len();
    let layers: Vec<_> = parts
        .into_iter()
        .map(|(name, channels)| {
            let attributes = attributes(name, metadata, size, repairs);
            Layer::new(size, attributes, encoding(metadata.is_finished), AnyChannels::sort(channels.into()))
        })
        .collect();
    let mut shared = ImageAttributes::new(IntegerBounds::from_dimensions(size));
    shared.chromaticities = Some(REC709);
    shared.time_code = time_code(metadata.frame, metadata.frames_per_second);
    let image = ExrImage::from_layers(shared, layers);
    let mut bytes = Vec::new();
    image
        .write()
        .non_parallel()
        .to_buffered(Cursor::new(&mut bytes))
        .map_err(|error| Error::format(path, "", format!("cannot be made: {error}")))?;
    sort_attributes(&mut bytes, count);
    crate::files::write_atomic(path, |file| file.write_all(&bytes))
}

/// The picture of a frame, linear light: its beauty, or the caustics where it has none; none where it has neither.
///
/// # Errors
/// A file that cannot be read.
pub fn read_beauty(path: &Path) -> Result<Option<Image>> {
    let bytes = crate::files::read_regular_file(path, 8 << 30)?;
    let picture = exr::prelude::read().no_deep_data().largest_resolution_level().all_channels();
    let file = picture
        .all_layers()
        .all_attributes()
        .from_buffered(Cursor::new(bytes))
        .map_err(|error| Error::format(path, "", format!("cannot be read: {error}")))?;
    let named = |prefix: &str| {
        file.layer_data.iter().find_map(|layer| {
            let channel = |name: &str| {
                layer.channel_data.list.iter().find(|of| of.name.to_string() == format!("{prefix}{name}"))
            };
            let planes = [channel("R")?, channel("G")?, channel("B")?];
            let planes = planes.map(|channel| channel.sample_data.values_as_f32().collect::<Vec<f32>>());
            let [r, g, b] = &planes;
            let pixels = r.iter().zip(g).zip(b).map(|((r, g), b)| Vec3::new(*r, *g, *b)).collect();
            Some(Image { width: layer.size.0, height: layer.size.1, pixels })
        })
    };
    Ok(named("").or_else(|| named("caustic.")))
}

/// The primaries of Rec.709 and D65.
const REC709: Chromaticities = Chromaticities {
    red: Vec2(0.64, 0.33),
    green: Vec2(0.30, 0.60),
    blue: Vec2(0.15, 0.06),
    white: Vec2(0.3127, 0.3290),
};

/// PIZ is the smallest for noise, and half of the work of writing. A farm that ends a task gives it seconds to write all
/// frames: those that are not finished are written fast.
fn encoding(is_finished: bool) -> Encoding {
    let compression = if is_finished { Compression::PIZ } else { Compression::RLE };
    Encoding { compression, blocks: Blocks::ScanLines, line_order: LineOrder::Increasing }
}

fn attributes(
    name: &str,
    metadata: &Metadata,
    (width, height): (usize, usize),
    repairs: RepairedSamples,
) -> LayerAttributes {
    let mut attributes = LayerAttributes::named(name);
    if let Some(camera) = &metadata.camera {
        attributes.world_to_camera = Some(projection::world_to_camera(camera));
        attributes.world_to_normalized_device =
            Some(projection::world_to_ndc(camera, width as f32 / height as f32));
    }
    attributes.software_name = Some(Text::from(concat!("Lightloom ", env!("CARGO_PKG_VERSION"))));
    attributes.frames_per_second = Some(metadata.frames_per_second);
    // UTF-8; the crate's conversion refuses anything but Latin-1.
    let utf8 = |text: &str| Text::from_slice_unchecked(text.as_bytes());
    let text = |value: &str| AttributeValue::Text(utf8(value));
    let mut other = HashMap::new();
    other.insert(Text::from("colorInteropID"), text("lin_rec709_scene"));
    other.insert(Text::from("lightloom:frame"), AttributeValue::I32(metadata.frame));
    for (name, value) in metadata.texts(repairs) {
        other.insert(utf8(&format!("lightloom:{name}")), text(&value));
    }
    attributes.other = other;
    attributes
}

/// The channels R, G and B of a picture in half floats, behind `prefix`.
fn colours(prefix: &str, values: &[Vec3], clamped: &mut u64) -> Vec<AnyChannel<FlatSamples>> {
    let plane = |(i, name)| halves(format!("{prefix}{name}"), values.iter().map(|v| v[i]), clamped);
    ["R", "G", "B"].into_iter().enumerate().map(plane).collect()
}

/// A channel of half floats; values that are too large are clamped and counted.
fn halves(name: String, values: impl Iterator<Item = f32>, clamped: &mut u64) -> AnyChannel<FlatSamples> {
    let largest = f16::MAX.to_f32();
    let half = |value: f32| {
        *clamped += u64::from(value.abs() > largest);
        f16::from_f32(value.clamp(-largest, largest))
    };
    AnyChannel::new(name.as_str(), FlatSamples::F16(values.map(half).collect()))
}

/// Sorts the attributes of each of the `headers` by name. The `exr` crate keeps free attributes in a hash map, whose
/// order changes from run to run; their length does not, so all offsets stay right.
fn sort_attributes(bytes: &mut [u8], headers: usize) {
    let mut at = 8; // Magic number and version.
    for _ in 0..headers {
        let start = at;
        let mut attributes = Vec::new();
        while bytes[at] != 0 {
            let name_end = after_zero(bytes, at);
            let kind_end = after_zero(bytes, name_end);
            let size = bytes[kind_end..kind_end + 4].try_into().map_or(0, u32::from_le_bytes) as usize;
            let end = kind_end + 4 + size;
            attributes.push(bytes[at..end].to_vec());
            at = end;
        }
        // The name comes first and ends with a zero: comparing the bytes compares the names.
        attributes.sort();
        bytes[start..at].copy_from_slice(&attributes.concat());
        at += 1;
    }
}

/// The position after the next zero byte.
fn after_zero(bytes: &[u8], from: usize) -> usize {
    bytes[from..].iter().position(|b| *b == 0).map_or(bytes.len(), |length| from + length + 1)
}
