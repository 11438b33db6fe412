//! The quadratic assignment of landmarks, improved by pairwise swaps.
//!
//! ```text
//! E(p) = (1-b)/M |D_A - P D_B P^T|_F + b sum_i |a_i - b_p(i)|,   b = 0.04
//! ```
//!
//! The first term keeps the distances between landmarks, the second keeps their moves short. D_A and D_B
//! are the M x M distances within the two sets. A swap of two targets changes the first sum in two rows and columns only, so
//! that it is judged in M operations.

use glam::DVec2;

use crate::{Progress, Result};

/// b of the energy.
const NEAR: f64 = 0.04;
/// Share of the energy that a swap must gain: less is rounding.
const GAIN: f64 = 1e-12;
/// Limit of sweeps over all pairs; some ten suffice. Rounding in the sums that are kept could go on for ever.
const MAX_SWEEPS: usize = 1000;

/// Landmarks with their present targets.
pub(super) struct QuadraticAssignment {
    /// Row of the target of each landmark.
    pub(super) target_of: Vec<usize>,
    count: usize,
    /// D_A, by rows.
    within_source: Vec<f64>,
    /// P D_B P^T, by rows: kept in the order of the landmarks, so that a swap reads four rows from end to end.
    within_target: Vec<f64>,
    /// |a_i - b_j|, by rows.
    between: Vec<f64>,
    sums: Sums,
}

/// The sums of which the energy is made.
#[derive(Clone, Copy, Debug)]
struct Sums {
    /// The squared Frobenius norm.
    squares: f64,
    /// Sum of the distances to the targets.
    lengths: f64,
}

impl QuadraticAssignment {
    /// Landmark i goes to target i, as many of both.
    pub(super) fn by_row(source: &[DVec2], target: &[DVec2]) -> Self {
        let distances = |a: &[DVec2], b: &[DVec2]| {
            a.iter().flat_map(|a| b.iter().map(move |b| a.distance(*b))).collect::<Vec<f64>>()
        };
        let mut assignment = Self {
            target_of: (0..source.len()).collect(),
            count: source.len(),
            within_source: distances(source, source),
            within_target: distances(target, target),
            between: distances(source, target),
            sums: Sums { squares: 0.0, lengths: 0.0 },
        };
        assignment.sums = assignment.sums_anew();
        assignment
    }

    /// Swaps as long as any swap of two targets lowers the energy, pair by pair in the order of the rows.
    ///
    /// # Errors
    /// `Cancelled`.
    pub(super) fn improve(&mut self, progress: &Progress) -> Result<()> {
        for _ in 0..MAX_SWEEPS {
            let mut better = false;
            for i in 0..self.count {
                progress.check()?;
                for j in i + 1..self.count {
                    let swapped = self.after_swap(i, j);
                    if self.energy_of(swapped) < self.energy() * (1.0 - GAIN) {
                        self.swap(i, j, swapped);
                        better = true;
                    }
                }
            }
            if !better {
                break;
            }
        }
        Ok(())
    }

    /// E(p).
    pub(super) fn energy(&self) -> f64 {
        self.energy_of(self.sums)
    }

    fn energy_of(&self, sums: Sums) -> f64 {
        (1.0 - NEAR) / self.count.max(1) as f64 * sums.squares.max(0.0).sqrt() + NEAR * sums.lengths
    }

    /// The sums after landmarks `i` and `j` have swapped their targets.
    ///
    /// With A = D_A and B = P D_B P^T the squares of B cancel, and the change of the squared norm is
    /// 4 sum_k (A_ik - A_jk) (B_ik - B_jk) over all k but i and j.
    fn after_swap(&self, i: usize, j: usize) -> Sums {
        let n = self.count;
        let (a_i, a_j) = (&self.within_source[i * n..][..n], &self.within_source[j * n..][..n]);
        let (b_i, b_j) = (&self.within_target[i * n..][..n], &self.within_target[j * n..][..n]);
        let mut lanes = [0.0; 8];
        let whole = n - n % 8;
        for k in (0..whole).step_by(8) {
            for lane in 0..8 {
                let k = k + lane;
                lanes[lane] += (a_i[k] - a_j[k]) * (b_i[k] - b_j[k]);
            }
        }
        let rest: f64 = (whole..n).map(|k| (a_i[k] - a_j[k]) * (b_i[k] - b_j[k])).sum();
        // k = i and k = j came along above; each has added A_ij B_ij.
        let change = lanes.iter().sum::<f64>() + rest - 2.0 * a_i[j] * b_i[j];
        let length = |i: usize, j: usize| self.between[i * n + self.target_of[j]];
        Sums {
            squares: self.sums.squares + 4.0 * change,
            lengths: self.sums.lengths + length(i, j) + length(j, i) - length(i, i) - length(j, j),
        }
    }

    fn swap(&mut self, i: usize, j: usize, sums: Sums) {
        let n = self.count;
        let (low, high) = self.within_target.split_at_mut(j * n);
        low[i * n..][..n].swap_with_slice(&mut high[..n]);
        for row in self.within_target.chunks_exact_mut(n) {
            row.swap(i, j);
        }
        self.target_of.swap(i, j);
        self.sums = sums;
    }

    fn sums_anew(&self) -> Sums {
        let pairs = self.within_source.iter().zip(&self.within_target);
        let squares = pairs.map(|(a, b)| (a - b) * (a - b)).sum();
        let lengths = self.target_of.iter().enumerate().map(|(i, &j)| self.between[i * self.count + j]).sum();
        Sums { squares, lengths }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::math::rng::{Purpose, Stream};
    use glam::dvec2;

    fn points(count: usize, pass: u64) -> Vec<DVec2> {
        let mut random = Stream::new(5, Purpose::Match, pass, 0);
        (0..count).map(|_| dvec2(random.f64(), random.f64())).collect()
    }

    #[test]
    fn the_change_of_a_swap_is_that_of_the_whole_energy() {
        for count in [2, 3, 8, 29] {
            let mut assignment = QuadraticAssignment::by_row(&points(count, 0), &points(count, 1));
            let mut random = Stream::new(6, Purpose::Match, 0, 0);
            for _ in 0..200 {
                let (i, j) = (random.u32() as usize % count, random.u32() as usize % count);
                let (i, j) = (i.min(j), i.max(j));
                if i == j {
                    continue;
                }
                let swapped = assignment.after_swap(i, j);
                assignment.swap(i, j, swapped);
                let anew = assignment.sums_anew();
                // Sums of up to 900 numbers below 2, gathered over 200 swaps: rounding stays below 1e-10.
                assert!((swapped.squares - anew.squares).abs() < 1e-10, "{swapped:?} {anew:?}");
                assert!((swapped.lengths - anew.lengths).abs() < 1e-10, "{swapped:?} {anew:?}");
            }
        }
    }

    #[test]
    fn improvement_never_worsens_and_ends_where_no_swap_helps() {
        let mut assignment = QuadraticAssignment::by_row(&points(60, 2), &points(60, 3));
        let before = assignment.energy();
        assignment.improve(&Progress::new()).unwrap();
        assert!(assignment.energy() < before);
        let mut taken = assignment.target_of.clone();
        taken.sort_unstable();
        assert!(taken.into_iter().eq(0..60), "every target is taken once");
        let least = assignment.energy() * (1.0 - 2.0 * GAIN);
        for i in 0..60 {
            for j in i + 1..60 {
                assert!(assignment.energy_of(assignment.after_swap(i, j)) >= least);
            }
        }
    }

    #[test]
    fn equal_sets_find_each_other() {
        let source = points(40, 4);
        let mut target = source.clone();
        target.reverse();
        let mut assignment = QuadraticAssignment::by_row(&source, &target);
        assignment.improve(&Progress::new()).unwrap();
        let stay = (0..40).filter(|&i| source[i] == target[assignment.target_of[i]]).count();
        // Swaps of two may end before the best assignment, but near it.
        assert!(stay >= 30, "{stay} of 40 stay");
    }
}
