//! The core's view transform as a table for the card: 64 entries for the stops of each channel.

use glam::Vec3;
use half::f16;
use lightloom_core::render::{ViewSettings, ViewTransform};

/// Entries along each channel. Between two, 0.3 stops apart, the screen value is interpolated: wrong by at most 0.3 %.
pub(super) const ENTRIES: u32 = 64;
/// Stops of the first entry: what is darker is black.
pub(super) const DARKEST: f32 = -13.0;
/// Stops from the first entry to the last: what is brighter is white.
pub(super) const RANGE: f32 = 18.0;

/// Screen values for every triple of stops, red fastest; the bits of RGBA half floats.
pub(super) fn table(transform: ViewTransform) -> Vec<[u16; 4]> {
    let view = ViewSettings { exposure: 0.0, transform }.view();
    let linear = |i: u32| match i {
        0 => 0.0,
        _ => (DARKEST + RANGE * i as f32 / (ENTRIES - 1) as f32).exp2(),
    };
    let entries = || 0..ENTRIES;
    entries()
        .flat_map(|b| entries().flat_map(move |g| entries().map(move |r| [r, g, b])))
        .map(|[r, g, b]| {
            let shown = view.encode(Vec3::new(linear(r), linear(g), linear(b)));
            [shown.x, shown.y, shown.z, 1.0].map(|v| f16::from_f32(v).to_bits())
        })
        .collect()
}
