//! Pictures as channels of a file.

use exr::prelude::{AnyChannel, FlatSamples};
use glam::Vec3;
use half::f16;
use half::slice::HalfFloatSliceExt as _;

use crate::export::repairs::RepairedSamples;
use crate::render::first_hits::FirstHits;
use crate::render::image::Image;

/// The colours of a picture; what is not finite is replaced by 0 and counted.
pub(super) fn finite(image: &Image, repairs: &mut RepairedSamples) -> Vec<Vec3> {
    let mut finite = |v: &Vec3| {
        if v.is_finite() {
            return *v;
        }
        let values = v.to_array();
        repairs.nonfinite_replaced += values.iter().filter(|v| !v.is_finite()).count() as u64;
        Vec3::from(values.map(|v| if v.is_finite() { v } else { 0.0 }))
    };
    image.pixels.iter().map(&mut finite).collect()
}

/// The channels R, G and B of a picture in half floats, behind `prefix`.
pub(super) fn colours(prefix: &str, values: &[Vec3], clamped: &mut u64) -> Vec<AnyChannel<FlatSamples>> {
    let plane = |(i, name)| halves(format!("{prefix}{name}"), values.iter().map(|v| v[i]), clamped);
    ["R", "G", "B"].into_iter().enumerate().map(plane).collect()
}

/// The coverage of the surfaces in a picture of this size as alpha, behind `prefix`.
pub(super) fn alpha(
    prefix: &str,
    (width, height): (usize, usize),
    hits: Option<&FirstHits>,
) -> AnyChannel<FlatSamples> {
    let name = format!("{prefix}A");
    match hits {
        Some(hits) => halves(name, hits.coverage.iter().copied(), &mut 0),
        None => AnyChannel::new(name.as_str(), FlatSamples::F16(vec![f16::ONE; width * height])),
    }
}

/// A channel of half floats; values that are too large are clamped and counted.
fn halves(
    name: String,
    values: impl ExactSizeIterator<Item = f32>,
    clamped: &mut u64,
) -> AnyChannel<FlatSamples> {
    let largest = f16::MAX.to_f32();
    let within = |value: f32| {
        *clamped += u64::from(value.abs() > largest);
        value.clamp(-largest, largest)
    };
    let values: Vec<f32> = values.map(within).collect();
    // Several at once, where the processor can.
    let mut halves = vec![f16::ZERO; values.len()];
    halves.convert_from_f32_slice(&values);
    AnyChannel::new(name.as_str(), FlatSamples::F16(halves))
}
