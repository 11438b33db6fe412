//! Poisson's equation on the lattice, exactly, by cosine transforms.

use std::f64::consts::PI;
use std::sync::Arc;

use rayon::prelude::*;
use rustdct::{DctPlanner, TransformType2And3};

use super::lattice::Lattice;
use crate::math::tasks::rows_per_task;

/// Operations for each value of a cosine transform, and of a transposition.
const TRANSFORM: usize = 40;
const TRANSPOSE: usize = 4;

/// Solves -Laplace p = f with zero normal derivative on the border (five-point stencil, cell units).
pub(super) struct Poisson {
    size: [usize; 2],
    /// Transforms along rows and along columns.
    transforms: [Arc<dyn TransformType2And3<f64>>; 2],
    /// 1 / eigenvalue with the transforms' scale, transposed; 0 for the constant.
    inverse: Vec<f64>,
}

impl Poisson {
    pub(super) fn new(lattice: &Lattice) -> Self {
        let [width, height] = lattice.size;
        let mut planner = DctPlanner::new();
        let eigenvalue = |k: usize, n: usize| 2.0 - 2.0 * (PI * k as f64 / n as f64).cos();
        // DCT-III undoes DCT-II up to n/2 in each direction.
        let scale = 4.0 / (width * height) as f64;
        let mut inverse: Vec<f64> = (0..width * height)
            .map(|i| scale / (eigenvalue(i / height, width) + eigenvalue(i % height, height)))
            .collect();
        inverse[0] = 0.0;
        Self {
            size: lattice.size,
            transforms: [planner.plan_dct2(width), planner.plan_dct2(height)],
            inverse,
        }
    }

    /// The solution of mean 0 for the right side `f`, whose mean does not count; and the integral of f p, which is
    /// the squared H^-1 norm of f (cell units).
    pub(super) fn solve(&self, f: &[f64]) -> (Vec<f64>, f64) {
        let [width, height] = self.size;
        let mut rows = f.to_vec();
        self.each_row(&mut rows, 0, |transform, row, scratch| {
            transform.process_dct2_with_scratch(row, scratch);
        });
        let mut columns = transpose(&rows, width);
        self.each_row(&mut columns, 1, |transform, row, scratch| {
            transform.process_dct2_with_scratch(row, scratch);
        });
        columns.iter_mut().zip(&self.inverse).for_each(|(value, inverse)| *value *= inverse);
        self.each_row(&mut columns, 1, |transform, row, scratch| {
            transform.process_dct3_with_scratch(row, scratch);
        });
        let mut solution = transpose(&columns, height);
        self.each_row(&mut solution, 0, |transform, row, scratch| {
            transform.process_dct3_with_scratch(row, scratch);
        });
        let norm = solution.iter().zip(f).map(|(p, f)| p * f).sum();
        (solution, norm)
    }

    fn each_row(
        &self,
        values: &mut [f64],
        direction: usize,
        process: impl Fn(&dyn TransformType2And3<f64>, &mut [f64], &mut [f64]) + Sync,
    ) {
        let transform = &*self.transforms[direction];
        let width = self.size[direction];
        values.par_chunks_mut(width * rows_per_task(width, TRANSFORM)).for_each(|rows| {
            let mut scratch = vec![0.0; transform.get_scratch_len()];
            rows.chunks_exact_mut(width).for_each(|row| process(transform, row, &mut scratch));
        });
    }
}

/// Rows of `width` become columns.
pub(super) fn transpose(values: &[f64], width: usize) -> Vec<f64> {
    let height = values.len() / width;
    let mut transposed = vec![0.0; values.len()];
    let per_task = rows_per_task(height, TRANSPOSE);
    transposed.par_chunks_mut(height * per_task).enumerate().for_each(|(task, columns)| {
        for row in 0..height {
            let line = &values[row * width..(row + 1) * width];
            for (column, out) in columns.chunks_exact_mut(height).enumerate() {
                out[row] = line[task * per_task + column];
            }
        }
    });
    transposed
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::rng::{Purpose, Stream};

    #[test]
    fn the_stencil_gives_the_right_side_back() {
        let lattice = Lattice { size: [32, 16], origin: glam::DVec2::ZERO, cell: 1.0 };
        let mut stream = Stream::new(2, Purpose::Match, 0, 0);
        let mut f: Vec<f64> = (0..lattice.len()).map(|_| stream.f64()).collect();
        let mean = f.iter().sum::<f64>() / f.len() as f64;
        f.iter_mut().for_each(|value| *value -= mean);
        let (p, norm) = Poisson::new(&lattice).solve(&f);
        assert!(norm > 0.0);
        for y in 0..16_usize {
            for x in 0..32_usize {
                // A mirrored neighbour beyond the border is the cell itself.
                let at = |x: usize, y: usize| p[y.min(15) * 32 + x.min(31)];
                let around =
                    at(x.saturating_sub(1), y) + at(x + 1, y) + at(x, y.saturating_sub(1)) + at(x, y + 1);
                let laplacian = around - 4.0 * at(x, y);
                // 512 numbers of order 1, potentials of order 100: rounding only.
                assert!((laplacian + f[y * 32 + x]).abs() < 1e-11);
            }
        }
    }
}
