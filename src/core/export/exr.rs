//! OpenEXR: a part for each layer, half float but for the depth.
//!
//! The part `rgba` is the beauty with the channels `R`, `G`, `B`, `A`; those of the others bear the name of their layer
//! before a dot, which Nuke, OpenImageIO and Blender take for the layer's name: `caustic.R`. Beauty is background +
//! caustic, summed in f32 before each is rounded to half. The files hold no date and no host name, and their attributes
//! are sorted: equal input gives equal bytes.

mod channels;
mod part;
pub(super) mod shared;

use std::collections::HashMap;
use std::io::Cursor;
use std::path::Path;

use exr::meta::attribute::{AttributeValue, Chromaticities, IntegerBounds};
use exr::prelude::{
    AnyChannel, FlatSamples, ImageAttributes, LayerAttributes, ReadChannels as _, ReadLayers as _, Text, Vec2,
};
use glam::Vec3;

use self::channels::{alpha, colours, finite};
use self::part::Part;
use super::frame::{Frame, Metadata};
use super::layer::FrameLayer;
use super::projection;
use super::repairs::RepairedSamples;
use super::time_code::time_code;
use crate::render::image::Image;
use crate::{Error, Result};

/// The bytes of a frame's file, which errors name, and the repaired samples, which the metadata counts too.
///
/// # Panics
/// If the layers differ in size.
pub(super) fn encode(path: &Path, frame: &Frame) -> Result<(Vec<u8>, RepairedSamples)> {
    let backdrop = frame.backdrop;
    let size = (backdrop.background.width, backdrop.background.height);
    assert_eq!(size, (frame.caustic.width, frame.caustic.height), "layers of one size");
    let shared = backdrop.shared().as_ref().map_err(|error| unmade(path, error))?;
    let mut repairs = shared.repairs;
    let caustic = finite(frame.caustic, &mut repairs);
    let single: Vec<(&str, Vec<Vec3>)> =
        frame.caustics.iter().map(|(name, image)| (name.as_str(), finite(image, &mut repairs))).collect();
    let beauty: Vec<Vec3> = shared.light.iter().zip(&caustic).map(|(b, c)| b + c).collect();
    let mut parts: Vec<(&str, Part)> = Vec::new();
    for layer in FrameLayer::ALL.into_iter().filter(|layer| backdrop.layers.contains(layer)) {
        let mut colours = |of: &str, values: &[Vec3]| colours(of, values, &mut repairs.half_clamped);
        match layer {
            FrameLayer::Beauty => {
                let mut channels = colours("", &beauty);
                channels.push(alpha("", size, backdrop.first_hits));
                parts.push(("rgba", Part::Fresh(channels)));
            }
            FrameLayer::Caustic => parts.push(("caustic", Part::Fresh(colours("caustic.", &caustic)))),
            FrameLayer::Caustics => {
                parts.extend(
                    single
                        .iter()
                        .map(|(name, values)| (*name, Part::Fresh(colours(&format!("{name}."), values)))),
                );
            }
            FrameLayer::Background => {
                parts.extend(shared.background.iter().map(|part| ("background", Part::Kept(part))));
            }
            FrameLayer::Depth => {
                parts.extend(shared.depth.iter().map(|part| ("depth", Part::Kept(part))));
            }
            FrameLayer::Plane => (),
        }
    }
    Ok((bytes(path, (parts, frame.compressed), size, frame.metadata, repairs)?, repairs))
}

/// The bytes of the file of the light on the plane in 32-bit floats, `R`, `G` and `B`, and the repaired samples.
///
/// # Errors
/// A picture that is too large.
pub fn encode_plane(
    path: &Path,
    irradiance: &Image,
    metadata: &Metadata,
) -> Result<(Vec<u8>, RepairedSamples)> {
    let bad = |v: &Vec3| v.to_array().iter().filter(|v| !v.is_finite()).count() as u64;
    let repairs =
        RepairedSamples { half_clamped: 0, nonfinite_replaced: irradiance.pixels.iter().map(bad).sum() };
    let channel = |(i, name)| {
        let values = irradiance.pixels.iter().map(|v| if v[i].is_finite() { v[i] } else { 0.0 });
        AnyChannel::new(name, FlatSamples::F32(values.collect()))
    };
    let channels = ["R", "G", "B"].into_iter().enumerate().map(channel).collect();
    let (parts, size) = (vec![("plane", Part::Fresh(channels))], (irradiance.width, irradiance.height));
    Ok((bytes(path, (parts, true), size, metadata, repairs)?, repairs))
}

/// The bytes of a file of parts of one size; whether fresh ones are compressed.
fn bytes(
    path: &Path,
    (parts, compressed): (Vec<(&str, Part)>, bool),
    size: (usize, usize),
    metadata: &Metadata,
    repairs: RepairedSamples,
) -> Result<Vec<u8>> {
    let count = parts.len();
    let mut shared = ImageAttributes::new(IntegerBounds::from_dimensions(size));
    shared.chromaticities = Some(REC709);
    shared.time_code = time_code(metadata.frame, metadata.frames_per_second);
    let with_attributes = |(name, part)| (attributes(name, metadata, size, repairs), part);
    let parts = parts.into_iter().map(with_attributes).collect();
    let mut bytes = part::bytes((parts, compressed), size, &shared).map_err(|error| unmade(path, &error))?;
    sort_attributes(&mut bytes, count);
    Ok(bytes)
}

fn unmade(path: &Path, error: &exr::error::Error) -> Error {
    Error::format(path, "", format!("cannot be made: {error}"))
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
