//! Triangles of equal boxes: one box to the tree.

use obvhs::aabb::Aabb;
use rayon::prelude::*;

/// Triangles grouped by equal boxes.
pub(super) struct Groups {
    /// The first triangle of each group, rising.
    first: Vec<u32>,
    /// The next triangle of the same group; itself at the last.
    next: Vec<u32>,
}

impl Groups {
    pub(super) fn new(boxes: &[Aabb]) -> Self {
        let key = |b: &Aabb| [b.min.x, b.min.y, b.min.z, b.max.x, b.max.y, b.max.z].map(f32::to_bits);
        let hash = |b: &Aabb| {
            key(b)
                .into_iter()
                .fold(0_u64, |h, bits| (h ^ u64::from(bits)).wrapping_mul(0x9e37_79b9_7f4a_7c15))
        };
        let mut order: Vec<(u64, u32)> =
            boxes.par_iter().enumerate().map(|(i, b)| (hash(b), i as u32)).collect();
        order.par_sort_unstable();
        let mut next: Vec<u32> = (0..boxes.len() as u32).collect();
        let mut is_first = vec![true; boxes.len()];
        for pair in order.windows(2) {
            let [(of_a, a), (of_b, b)] = [pair[0], pair[1]];
            if of_a == of_b && key(&boxes[a as usize]) == key(&boxes[b as usize]) {
                next[a as usize] = b;
                is_first[b as usize] = false;
            }
        }
        let first = (0..boxes.len() as u32).filter(|triangle| is_first[*triangle as usize]).collect();
        Self { first, next }
    }

    /// The first triangle of each group.
    pub(super) fn firsts(&self) -> &[u32] {
        &self.first
    }

    /// The triangles of a group.
    pub(super) fn members(&self, group: u32) -> impl Iterator<Item = u32> + '_ {
        let next = |triangle: &u32| Some(self.next[*triangle as usize]).filter(|next| next != triangle);
        std::iter::successors(Some(self.first[group as usize]), next)
    }
}
