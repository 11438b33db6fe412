//! A greedy bijection from a map: points farthest from any target choose first, each takes the nearest free target.

use std::cmp::Reverse;
use std::ops::Range;

use glam::Vec2;
use rayon::prelude::*;

use crate::{Progress, Result};

/// Limit of points in a leaf of the tree.
const LEAF: usize = 8;
/// Choices between two progress updates.
const REPORT: usize = 1024;

/// The target row of each point of `warped`, as many as `target`: points in falling order of the distance to their nearest
/// target each take the nearest target still free. Equal distances go by rows.
///
/// # Errors
/// `Cancelled`.
pub(super) fn farthest_first(warped: &[Vec2], target: &[Vec2], progress: &Progress) -> Result<Vec<u32>> {
    let mut free = FreePoints::new(target);
    progress.check()?;
    // A distance is no negative number, so that its bits are in its order.
    let far = |(row, &p): (usize, &Vec2)| (Reverse(free.nearest(p).1.to_bits()), row as u32);
    let mut order: Vec<(Reverse<u32>, u32)> =
        warped.par_iter().enumerate().with_min_len(REPORT).map(far).collect();
    progress.check()?;
    order.par_sort_unstable();
    let mut target_of = vec![0; warped.len()];
    for (i, (_, row)) in order.into_iter().enumerate() {
        if i % REPORT == 0 {
            progress.check()?;
            progress.advance(REPORT as u64);
        }
        let (slot, _) = free.nearest(warped[row as usize]);
        target_of[row as usize] = free.take(slot);
    }
    Ok(target_of)
}

/// Free points, searchable for the nearest and removable: a balanced tree of bounding boxes.
struct FreePoints {
    /// In the order of the leaves; at infinity once taken.
    points: Vec<Vec2>,
    rows: Vec<u32>,
    /// Boxes in heap order from 1.
    boxes: Vec<Bounds>,
}

/// The smallest box around some points; inside out where there are none.
#[derive(Clone, Copy, Debug)]
struct Bounds {
    low: Vec2,
    high: Vec2,
}

impl Bounds {
    const NOTHING: Self = Self { low: Vec2::INFINITY, high: Vec2::NEG_INFINITY };

    fn around(points: &[Vec2]) -> Self {
        let free = points.iter().filter(|p| p.is_finite());
        free.fold(Self::NOTHING, |b, &p| Self { low: b.low.min(p), high: b.high.max(p) })
    }

    fn with(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// Squared distance of `p` from the box; infinite where it is empty.
    fn distance(&self, p: Vec2) -> f32 {
        (self.low - p).max(p - self.high).max(Vec2::ZERO).length_squared()
    }
}

impl FreePoints {
    fn new(points: &[Vec2]) -> Self {
        let mut items: Vec<(Vec2, u32)> = points.iter().copied().zip(0..).collect();
        let leaves = points.len().div_ceil(LEAF).next_power_of_two();
        let mut boxes = vec![Bounds::NOTHING; 2 * leaves];
        build(&mut items, &mut boxes, 1);
        let (points, rows) = items.into_iter().unzip();
        Self { points, rows, boxes }
    }

    /// The place in the tree of the nearest free point, and its squared distance; infinite where none is free.
    fn nearest(&self, p: Vec2) -> (usize, f32) {
        let mut best = (0, f32::INFINITY);
        self.visit(1, self.boxes[1].distance(p), 0..self.points.len(), p, &mut best);
        best
    }

    fn visit(&self, node: usize, bound: f32, range: Range<usize>, p: Vec2, best: &mut (usize, f32)) {
        if bound >= best.1 {
            return;
        }
        if is_leaf(node, &self.boxes) {
            for slot in range {
                let distance = self.points[slot].distance_squared(p);
                if distance < best.1 {
                    *best = (slot, distance);
                }
            }
            return;
        }
        let middle = range.start + range.len() / 2;
        let low = (2 * node, self.boxes[2 * node].distance(p), range.start..middle);
        let high = (2 * node + 1, self.boxes[2 * node + 1].distance(p), middle..range.end);
        let (near, far) = if low.1 <= high.1 { (low, high) } else { (high, low) };
        self.visit(near.0, near.1, near.2, p, best);
        self.visit(far.0, far.1, far.2, p, best);
    }

    /// Takes the point at a place in the tree away and returns its row.
    fn take(&mut self, slot: usize) -> u32 {
        self.points[slot] = Vec2::INFINITY;
        self.shrink(1, 0..self.points.len(), slot);
        self.rows[slot]
    }

    /// Fits the boxes from the root to the leaf of `slot` to what is left in them.
    fn shrink(&mut self, node: usize, range: Range<usize>, slot: usize) {
        if is_leaf(node, &self.boxes) {
            self.boxes[node] = Bounds::around(&self.points[range]);
            return;
        }
        let middle = range.start + range.len() / 2;
        if slot < middle {
            self.shrink(2 * node, range.start..middle, slot);
        } else {
            self.shrink(2 * node + 1, middle..range.end, slot);
        }
        self.boxes[node] = self.boxes[2 * node].with(self.boxes[2 * node + 1]);
    }
}

fn is_leaf(node: usize, boxes: &[Bounds]) -> bool {
    2 * node >= boxes.len()
}

/// Splits at the median of the longer side of the box.
fn build(items: &mut [(Vec2, u32)], boxes: &mut [Bounds], node: usize) {
    let bounds =
        items.iter().fold(Bounds::NOTHING, |b, &(p, _)| Bounds { low: b.low.min(p), high: b.high.max(p) });
    boxes[node] = bounds;
    if is_leaf(node, boxes) {
        return;
    }
    let middle = items.len() / 2;
    let side = bounds.high - bounds.low;
    if middle > 0 && side.x > side.y {
        items.select_nth_unstable_by(middle, |a, b| a.0.x.total_cmp(&b.0.x));
    } else if middle > 0 {
        items.select_nth_unstable_by(middle, |a, b| a.0.y.total_cmp(&b.0.y));
    }
    let (low, high) = items.split_at_mut(middle);
    build(low, boxes, 2 * node);
    build(high, boxes, 2 * node + 1);
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::math::rng::{Purpose, Stream};

    /// The same choices, looking at every free target.
    fn by_looking_at_all(warped: &[Vec2], target: &[Vec2]) -> Vec<f32> {
        let nearest = |p: Vec2, free: &[Vec2]| {
            free.iter().map(|b| b.distance_squared(p)).enumerate().min_by(|a, b| a.1.total_cmp(&b.1)).unwrap()
        };
        let mut order: Vec<usize> = (0..warped.len()).collect();
        order.sort_by(|&i, &j| nearest(warped[j], target).1.total_cmp(&nearest(warped[i], target).1));
        let mut free = target.to_vec();
        let mut distances = vec![0.0; warped.len()];
        for row in order {
            let (slot, distance) = nearest(warped[row], &free);
            free.swap_remove(slot);
            distances[row] = distance;
        }
        distances
    }

    #[test]
    fn the_nearest_free_target_is_found_however_many_are_taken() {
        for count in (1..40).chain([100, 700]) {
            let mut random = Stream::new(2, Purpose::Match, 0, count);
            let mut point = || Vec2::new(random.f32(), random.f32());
            // Half of the targets lie far off, so that the last photons search long.
            let warped: Vec<Vec2> = (0..count).map(|_| point()).collect();
            let target: Vec<Vec2> = (0..count).map(|i| point() + Vec2::X * (i % 2) as f32).collect();
            let chosen = farthest_first(&warped, &target, &Progress::new()).unwrap();
            let distance = |(&row, p): (&u32, &Vec2)| target[row as usize].distance_squared(*p);
            let distances: Vec<f32> = chosen.iter().zip(&warped).map(distance).collect();
            assert_eq!(distances, by_looking_at_all(&warped, &target), "{count} points");
        }
    }

    #[test]
    fn targets_in_one_place_are_all_taken() {
        let mut chosen = farthest_first(&[Vec2::ONE; 50], &[Vec2::ZERO; 50], &Progress::new()).unwrap();
        chosen.sort_unstable();
        assert!(chosen.into_iter().eq(0..50));
    }
}
