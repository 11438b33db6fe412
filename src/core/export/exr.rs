//! OpenEXR, half float: part `rgba` is the beauty, followed by the parts `caustic` and `background`.
//!
//! Beauty is background + caustic, summed in f32 before each is rounded to half. The files hold no date and no host
//! name, and their attributes are sorted: equal input gives equal bytes.

use std::collections::HashMap;
use std::io::{Cursor, Write};
use std::path::Path;

use exr::meta::attribute::{AttributeValue, Chromaticities, IntegerBounds};
use exr::prelude::{
    AnyChannel, AnyChannels, Blocks, Compression, Encoding, FlatSamples, Image as ExrImage, ImageAttributes,
    Layer, LayerAttributes, LineOrder, Text, Vec2, WritableImage,
};
use glam::Vec3;
use half::f16;

use super::frame::{Frame, Metadata, RepairedSamples};
use crate::{Error, Result};

/// Writes a frame; returns the repaired samples, which the metadata counts too.
pub fn write(path: &Path, frame: &Frame<'_>) -> Result<RepairedSamples> {
    let size = (frame.background.width, frame.background.height);
    assert_eq!(size, (frame.caustic.width, frame.caustic.height), "layers of one size");
    let mut repairs = RepairedSamples::default();
    let mut finite = |v: Vec3| {
        let fixed = v.to_array().map(|v| if v.is_finite() { v } else { 0.0 });
        repairs.nonfinite_replaced += v.to_array().iter().filter(|v| !v.is_finite()).count() as u64;
        Vec3::from(fixed)
    };
    let caustic: Vec<Vec3> = frame.caustic.pixels.iter().map(|&v| finite(v)).collect();
    let background: Vec<Vec3> = frame.background.pixels.iter().map(|&v| finite(v)).collect();
    let beauty: Vec<Vec3> = background.iter().zip(&caustic).map(|(b, c)| b + c).collect();
    let mut halves = |values: &[Vec3], alpha: bool| channels(values, alpha, &mut repairs.half_clamped);
    let parts = [
        ("rgba", halves(&beauty, true)),
        ("caustic", halves(&caustic, false)),
        ("background", halves(&background, false)),
    ];
    let layers = parts.map(|(name, channels)| {
        Layer::new(size, attributes(name, frame.metadata, repairs), encoding(), channels)
    });
    let mut shared = ImageAttributes::new(IntegerBounds::from_dimensions(size));
    shared.chromaticities = Some(REC709);
    let image = ExrImage::from_layers(shared, layers.into_iter().collect::<Vec<_>>());
    let mut bytes = Vec::new();
    image
        .write()
        .non_parallel()
        .to_buffered(Cursor::new(&mut bytes))
        .map_err(|error| Error::format(path, "", format!("cannot be made: {error}")))?;
    sort_attributes(&mut bytes, 3);
    crate::files::write_atomic(path, |file| file.write_all(&bytes))?;
    Ok(repairs)
}

/// The primaries of Rec.709 and D65.
const REC709: Chromaticities = Chromaticities {
    red: Vec2(0.64, 0.33),
    green: Vec2(0.30, 0.60),
    blue: Vec2(0.15, 0.06),
    white: Vec2(0.3127, 0.3290),
};

fn encoding() -> Encoding {
    Encoding { compression: Compression::PIZ, blocks: Blocks::ScanLines, line_order: LineOrder::Increasing }
}

fn attributes(name: &str, metadata: &Metadata, repairs: RepairedSamples) -> LayerAttributes {
    let mut attributes = LayerAttributes::named(name);
    attributes.software_name = Some(Text::from(concat!("Lightloom ", env!("CARGO_PKG_VERSION"))));
    attributes.frames_per_second = Some(metadata.frames_per_second);
    // UTF-8; the crate's conversion refuses anything but Latin-1.
    let utf8 = |text: &str| Text::from_slice_unchecked(text.as_bytes());
    let text = |value: &str| AttributeValue::Text(utf8(value));
    let mut other = HashMap::new();
    other.insert(Text::from("colorInteropID"), text("lin_rec709_scene"));
    other.insert(Text::from("lightloom:frame"), AttributeValue::I32(metadata.frame));
    other.insert(Text::from("lightloom:seed"), text(&metadata.seed.to_string()));
    other.insert(Text::from("lightloom:passes"), text(&metadata.passes.to_string()));
    other.insert(Text::from("lightloom:half_clamped"), text(&repairs.half_clamped.to_string()));
    other.insert(Text::from("lightloom:nonfinite_replaced"), text(&repairs.nonfinite_replaced.to_string()));
    for (name, value) in &metadata.settings {
        other.insert(utf8(&format!("lightloom:{name}")), text(value));
    }
    attributes.other = other;
    attributes
}

/// Planes of half floats; alpha is 1 everywhere.
fn channels(values: &[Vec3], alpha: bool, clamped: &mut u64) -> AnyChannels<FlatSamples> {
    let largest = f16::MAX.to_f32();
    let mut plane = |name: &str, channel: usize| {
        let samples = values
            .iter()
            .map(|v| {
                let value = v[channel];
                *clamped += u64::from(value.abs() > largest);
                f16::from_f32(value.clamp(-largest, largest))
            })
            .collect();
        AnyChannel::new(name, FlatSamples::F16(samples))
    };
    let mut list = vec![plane("R", 0), plane("G", 1), plane("B", 2)];
    if alpha {
        list.push(AnyChannel::new("A", FlatSamples::F16(vec![f16::ONE; values.len()])));
    }
    AnyChannels::sort(list.into())
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
