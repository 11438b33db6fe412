//! The Gaussian kernel of free motion: separable, two products with Toeplitz matrices.

use rayon::prelude::*;

use crate::math::tasks::rows_per_task;

/// Kernel values below this are zero: their products would be denormal.
const LEAST: f64 = 1e-290;

/// exp(-|x - y|^2 / 2 v) between the centres of cells, not normalized.
pub(super) struct Gaussian {
    size: [usize; 2],
    /// By the difference of columns, from -(width - 1) on.
    along_x: Vec<f64>,
    /// By the distance of rows.
    along_y: Vec<f64>,
    rows: Vec<f64>,
}

impl Gaussian {
    /// The kernel of variance `variance` in squared cells along each axis.
    pub(super) fn new(size: [usize; 2], variance: f64) -> Self {
        let value = |distance: usize| {
            let value = (-(distance as f64).powi(2) / (2.0 * variance)).exp();
            if value < LEAST { 0.0 } else { value }
        };
        let [width, height] = size;
        let along_x = (0..2 * width - 1).map(|i| value(i.abs_diff(width - 1))).collect();
        Self { size, along_x, along_y: (0..height).map(value).collect(), rows: vec![0.0; width * height] }
    }

    /// `out` = K `density`.
    pub(super) fn spread(&mut self, density: &[f64], out: &mut [f64]) {
        let [width, height] = self.size;
        let Self { along_x, along_y, rows, .. } = self;
        let chunk = width * rows_per_task(width, width);
        rows.par_chunks_mut(chunk).zip(density.par_chunks(chunk)).for_each(|(rows, density)| {
            for (out, row) in rows.chunks_exact_mut(width).zip(density.chunks_exact(width)) {
                out.fill(0.0);
                add_row(out, row, along_x);
            }
        });
        let rows = &*rows;
        let lit: Vec<usize> = (0..height)
            .filter(|&y| density[y * width..(y + 1) * width].iter().any(|value| *value != 0.0))
            .collect();
        let per_task = rows_per_task(width, height);
        out.par_chunks_mut(per_task * width).enumerate().for_each(|(task, out)| {
            for (y, out) in (task * per_task..).zip(out.chunks_exact_mut(width)) {
                out.fill(0.0);
                let row = |from: usize| &rows[from * width..][..width];
                let weight = |from: usize| along_y[y.abs_diff(from)];
                let groups = lit.chunks_exact(4);
                for &from in groups.remainder() {
                    let k = weight(from);
                    out.iter_mut().zip(row(from)).for_each(|(out, value)| *out += k * value);
                }
                for group in groups {
                    let [a, b, c, d] = [0, 1, 2, 3].map(|k| row(group[k]));
                    let k = [0, 1, 2, 3].map(|k| weight(group[k]));
                    for x in 0..width {
                        out[x] += (k[0] * a[x] + k[1] * b[x]) + (k[2] * c[x] + k[3] * d[x]);
                    }
                }
            }
        });
    }
}

/// Adds the kernel, once for each lit cell of `row`, times its value.
fn add_row(out: &mut [f64], row: &[f64], along_x: &[f64]) {
    let width = out.len();
    let mut lit = row.iter().enumerate().filter(|(_, value)| **value != 0.0);
    let shifted = |x: usize| &along_x[width - 1 - x..][..width];
    loop {
        match (lit.next(), lit.next()) {
            (Some((xa, &a)), Some((xb, &b))) => {
                let (ka, kb) = (shifted(xa), shifted(xb));
                for x in 0..width {
                    out[x] += a * ka[x] + b * kb[x];
                }
            }
            (Some((xa, &a)), None) => {
                out.iter_mut().zip(shifted(xa)).for_each(|(out, k)| *out += a * k);
            }
            (None, _) => return,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_product_is_that_of_the_full_matrix() {
        let size = [13, 9];
        let density: Vec<f64> =
            (0..117).map(|i| if i % 3 == 0 { (f64::from(i) * 0.7).sin().abs() } else { 0.0 }).collect();
        let mut out = vec![0.0; 117];
        Gaussian::new(size, 2.5).spread(&density, &mut out);
        for (i, value) in out.iter().enumerate() {
            let full: f64 = (0..117)
                .map(|j| {
                    let (dx, dy) = ((i % 13).abs_diff(j % 13) as f64, (i / 13).abs_diff(j / 13) as f64);
                    density[j] * (-(dx * dx + dy * dy) / 5.0).exp()
                })
                .sum();
            assert!((value - full).abs() < 1e-12 * full, "cell {i}: {value} for {full}");
        }
    }
}
