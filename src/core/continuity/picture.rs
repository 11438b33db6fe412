//! Photons counted in square cells.

use glam::Vec2;

use crate::math::mirror::mirrored;

/// Standard deviation of the blur, cells.
const BLUR: f32 = 1.6;
/// Reach of the blur: four standard deviations.
const REACH: usize = 6;

/// A number per cell, row by row.
#[derive(Clone)]
pub(super) struct Picture {
    pub(super) columns: usize,
    pub(super) rows: usize,
    pub(super) cells: Vec<f32>,
}

impl Picture {
    /// The number of photons in each cell of a plane of this extent, `per_unit` cells to a plane unit. Photons outside are
    /// left out.
    pub(super) fn counted(positions: &[Vec2], extent: Vec2, per_unit: f32) -> Self {
        let [columns, rows] = (extent * per_unit).ceil().to_array().map(|n| (n as usize).max(1));
        let mut cells = vec![0.0; columns * rows];
        let seen = positions.iter().filter(|p| p.cmpge(Vec2::ZERO).all() && p.cmple(extent).all());
        for p in seen {
            let [x, y] = (p * per_unit).to_array().map(|n| n as usize);
            cells[y.min(rows - 1) * columns + x.min(columns - 1)] += 1.0;
        }
        Self { columns, rows, cells }
    }

    /// The fullest cell.
    pub(super) fn max(&self) -> f32 {
        self.cells.iter().copied().fold(0.0, f32::max)
    }

    /// The sum over all cells.
    pub(super) fn sum(&self) -> f64 {
        self.cells.iter().map(|&n| f64::from(n)).sum()
    }

    /// Blurred by a Gaussian, mirrored at the border.
    pub(super) fn blurred(&self) -> Self {
        let (columns, weights) = (self.columns, weights());
        let mut along = Vec::with_capacity(self.cells.len());
        let mut padded = vec![0.0; columns + 2 * REACH];
        for row in self.cells.chunks_exact(columns) {
            for (i, out) in padded.iter_mut().enumerate() {
                *out = row[mirrored(i as isize - REACH as isize, columns)];
            }
            along.extend((0..columns).map(|x| weighted(&weights, |i| padded[x + i])));
        }
        let mut cells = vec![0.0; self.cells.len()];
        for (y, out) in cells.chunks_exact_mut(columns).enumerate() {
            for (i, weight) in weights.iter().enumerate() {
                let from = mirrored((y + i) as isize - REACH as isize, self.rows) * columns;
                out.iter_mut().zip(&along[from..from + columns]).for_each(|(out, n)| *out += weight * n);
            }
        }
        Self { cells, ..*self }
    }
}

type Weights = [f32; 2 * REACH + 1];

fn weights() -> Weights {
    let weight = |i: usize| (-0.5 * ((i as f32 - REACH as f32) / BLUR).powi(2)).exp();
    let weights: Weights = std::array::from_fn(weight);
    let sum: f32 = weights.iter().sum();
    weights.map(|weight| weight / sum)
}

fn weighted(weights: &Weights, value: impl Fn(usize) -> f32) -> f32 {
    weights.iter().enumerate().map(|(i, weight)| weight * value(i)).sum()
}
