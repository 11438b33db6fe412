//! The photons that walk along walls in a step.

use glam::Vec2;

use crate::flow::walls::SUBSTEPS;

const WORD: usize = u64::BITS as usize;

/// The photons that walk along walls in one step of a half, with where they are after each substep.
#[derive(Clone, Debug, Default)]
pub(super) struct Walks {
    /// One bit for each photon; empty where no wall stands.
    bits: Vec<u64>,
    /// Bits before each word.
    before: Vec<u32>,
    /// By rising row.
    places: Vec<[Vec2; SUBSTEPS]>,
}

impl Walks {
    /// Those of `count` photons, by rising row.
    pub(super) fn new(count: usize, walks: impl Iterator<Item = (usize, [Vec2; SUBSTEPS])>) -> Self {
        let mut bits = vec![0u64; count.div_ceil(WORD)];
        let mark = |(row, places): (usize, [Vec2; SUBSTEPS])| {
            bits[row / WORD] |= 1 << (row % WORD);
            places
        };
        let places = walks.map(mark).collect();
        let ones = |sum: &mut u32, word: &u64| {
            let before = *sum;
            *sum += word.count_ones();
            Some(before)
        };
        let before = bits.iter().scan(0, ones).collect();
        Self { bits, before, places }
    }

    /// Where a photon is after each substep; none for one that does not walk.
    #[inline]
    pub(super) fn of(&self, row: usize) -> Option<&[Vec2; SUBSTEPS]> {
        let (word, bit) = (*self.bits.get(row / WORD)?, row % WORD);
        if word >> bit & 1 == 0 {
            return None;
        }
        let rank = self.before[row / WORD] + (word & ((1 << bit) - 1)).count_ones();
        self.places.get(rank as usize)
    }

    /// The photons in another order: row k of the result is row `order[k]` of this.
    pub(super) fn permuted(&self, order: &[u32]) -> Self {
        if self.bits.is_empty() {
            return Self::default();
        }
        let walks = order.iter().enumerate().filter_map(|(k, &row)| Some((k, *self.of(row as usize)?)));
        Self::new(order.len(), walks)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_walk_is_found_by_its_row_in_any_order() {
        let walk = |row: usize| [Vec2::splat(row as f32); SUBSTEPS];
        let rows = [0, 5, 63, 64, 129, 199];
        let walks = Walks::new(200, rows.iter().map(|&row| (row, walk(row))));
        let order: Vec<u32> = (0..200).rev().collect();
        let reversed = walks.permuted(&order);
        for row in 0..200 {
            let expected = rows.contains(&row).then(|| walk(row));
            assert_eq!(walks.of(row).copied(), expected);
            assert_eq!(reversed.of(199 - row).copied(), expected);
        }
        assert_eq!(Walks::default().of(7), None, "no walls");
    }
}
