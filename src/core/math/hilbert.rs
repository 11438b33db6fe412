//! Hilbert's space-filling curve: points that are near on the curve are near in the plane.

use glam::Vec2;
use rayon::prelude::*;

/// The rows of `points` in the order of the curve through their bounding box. Rows of equal cells keep their order.
///
/// `shift` (0 to 1 in each direction) moves the curve by that share of the box, which parts other neighbours.
pub fn order(points: &[Vec2], shift: Vec2) -> Vec<u32> {
    let (low, high) = points
        .iter()
        .fold((Vec2::INFINITY, Vec2::NEG_INFINITY), |(low, high), point| (low.min(*point), high.max(*point)));
    let side = (high - low).max_element().max(f32::MIN_POSITIVE);
    // The curve's square is twice as large as the box, which leaves room to shift it.
    let scale = 65535.0 / (2.0 * side);
    let mut keys: Vec<u64> = points
        .par_iter()
        .enumerate()
        .with_min_len(4096)
        .map(|(row, point)| {
            let cell = (*point - low + shift * side) * scale;
            u64::from(index(cell.x as u32, cell.y as u32)) << 32 | row as u64
        })
        .collect();
    keys.par_sort_unstable();
    keys.into_iter().map(|key| key as u32).collect()
}

/// The place of cell (x, y), each below 2^16, on the curve through 2^16 x 2^16 cells.
pub fn index(x: u32, y: u32) -> u32 {
    let (mut x, mut y) = (x & 0xffff, y & 0xffff);
    let mut index = 0;
    let mut side = 1 << 15;
    while side > 0 {
        let right = u32::from(x & side != 0);
        let upper = u32::from(y & side != 0);
        index = index << 2 | ((3 * right) ^ upper);
        if upper == 0 {
            if right == 1 {
                (x, y) = (!x, !y);
            }
            (x, y) = (y, x);
        }
        side >>= 1;
    }
    index
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn followers_on_the_curve_are_neighbours_in_the_plane() {
        // The first 16 x 16 cells of the plane are the first 256 of the curve.
        let mut cells: Vec<(u32, u32, u32)> =
            (0..256).map(|i| (index(i % 16, i / 16), i % 16, i / 16)).collect();
        cells.sort_unstable();
        for (place, pair) in cells.windows(2).enumerate() {
            let ((place_0, x0, y0), (_, x1, y1)) = (pair[0], pair[1]);
            assert_eq!(place_0, place as u32);
            assert_eq!(x0.abs_diff(x1) + y0.abs_diff(y1), 1);
        }
    }
}
