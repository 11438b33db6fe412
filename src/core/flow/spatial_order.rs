//! Rows ordered by place, for memory locality.

use glam::Vec2;

/// The rows in Morton order, in which neighbours in the plane are mostly neighbours in memory; equal places keep their order.
pub fn spatial_order(points: &[Vec2]) -> Vec<u32> {
    let mut keyed: Vec<(u32, u32)> = points.iter().zip(0..).map(|(&p, i)| (morton(p), i)).collect();
    keyed.sort_unstable();
    keyed.into_iter().map(|(_, i)| i).collect()
}

/// Interleaved bits of the cell in x and y, 1024 each; clipped to the unit square.
fn morton(p: Vec2) -> u32 {
    let spread = |x: f32| {
        let mut bits = (x * 1024.0).clamp(0.0, 1023.0) as u32;
        bits = (bits | bits << 8) & 0x00ff_00ff;
        bits = (bits | bits << 4) & 0x0f0f_0f0f;
        bits = (bits | bits << 2) & 0x3333_3333;
        (bits | bits << 1) & 0x5555_5555
    };
    spread(p.x) | spread(p.y) << 1
}
