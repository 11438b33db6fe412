//! A bijection between two point sets of equal size by recursive bisection.
//!
//! Genest, Bonneel, Nivoliers, Coeurjolly, *BSP-OT: Sparse transport plans between discrete measures in loglinear
//! time*, 2025: cut both sets at their median along the same direction, match half with half.

use glam::Vec2;

use crate::Progress;
use crate::math::rng::{Purpose, Stream};

/// Sets of fewer points are cut on the same thread.
const PARALLEL: usize = 1 << 13;

/// A point and its row.
#[derive(Clone, Copy, Debug)]
pub(super) struct Item {
    pub(super) position: Vec2,
    pub(super) row: u32,
}

/// Orders both sets so that item k of one belongs to item k of the other.
///
/// Directions are drawn from (seed, pass, node): the same on any number of threads. Once cancelled, it returns early
/// with the sets in some order.
pub(super) fn bisect(a: &mut [Item], b: &mut [Item], seed: u64, pass: u64, progress: &Progress) {
    assert_eq!(a.len(), b.len());
    Bisection { seed, pass, progress }.node(a, b, 1);
}

struct Bisection<'a> {
    seed: u64,
    pass: u64,
    progress: &'a Progress,
}

impl Bisection<'_> {
    /// Bisects both sets of one node of the tree, and recurses.
    fn node(&self, a: &mut [Item], b: &mut [Item], number: u64) {
        let middle = a.len() / 2;
        if middle == 0 || (a.len() > PARALLEL && self.progress.is_cancelled()) {
            return;
        }
        let angle = std::f32::consts::TAU * Stream::new(self.seed, Purpose::Match, self.pass, number).f32();
        let direction = Vec2::from_angle(angle);
        cut(a, middle, direction);
        cut(b, middle, direction);
        let (a_low, a_high) = a.split_at_mut(middle);
        let (b_low, b_high) = b.split_at_mut(middle);
        if a_low.len() > PARALLEL {
            rayon::join(|| self.node(a_low, b_low, 2 * number), || self.node(a_high, b_high, 2 * number + 1));
        } else {
            self.node(a_low, b_low, 2 * number);
            self.node(a_high, b_high, 2 * number + 1);
        }
    }
}

/// The `middle` items of least projection first.
fn cut(items: &mut [Item], middle: usize, direction: Vec2) {
    items.select_nth_unstable_by(middle, |a, b| {
        a.position.dot(direction).total_cmp(&b.position.dot(direction))
    });
}
