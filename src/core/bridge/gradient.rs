//! Gradients of values in cells, and the blurred density of photons.

use glam::Vec2;
use rayon::prelude::*;

use super::cells::Cells;
use super::wall_cells::WallCells;

/// Standard deviation of the blur of densities, in cells.
pub(super) const BLUR: f64 = 1.5;
/// Density that one photon spreads over that blur, per cell, and the share of it that counts as none.
const ONE_PHOTON: f64 = 0.07;
const FLOOR: f64 = 0.1;

/// Density, share of the light per cell, below which `photons` photons are none.
pub(super) fn floor(photons: usize) -> f64 {
    FLOOR * ONE_PHOTON / photons.max(1) as f64
}

/// The photons in cells, sum 1.
pub(super) fn gather(cells: &Cells, walls: Option<&WallCells>, photons: &[Vec2]) -> Vec<f64> {
    let mut sums = match walls {
        None => cells.sum(photons, |_, p| cells.around(p)),
        Some(walls) => cells.sum(photons, |_, p| walls.around(p)),
    };
    let total = sums.iter().sum::<f64>().max(f64::MIN_POSITIVE);
    sums.iter_mut().for_each(|sum| *sum /= total);
    sums
}

/// The gradients of values in all cells, plane units; differences to those neighbours alone that a cell sees and that have a
/// value.
pub(super) fn gradients(cells: &Cells, walls: Option<&WallCells>, values: &[f64]) -> Vec<Vec2> {
    let gradient = |cell: usize| gradient(cells, walls, values, cell);
    (0..cells.count()).into_par_iter().with_min_len(1024).map(gradient).collect()
}

fn gradient(cells: &Cells, walls: Option<&WallCells>, values: &[f64], cell: usize) -> Vec2 {
    let [width, height] = cells.size;
    let here = values[cell];
    if !here.is_finite() {
        return Vec2::ZERO;
    }
    let open = |cell: usize, axis: usize| walls.is_none_or(|walls| walls.open(cell, axis));
    let along = |axis: usize, at: usize, count: usize, stride: usize| {
        let next = (at + 1 < count && open(cell, axis)).then(|| values[cell + stride] - here);
        let before = (at > 0 && open(cell - stride, axis)).then(|| here - values[cell - stride]);
        let slope = match [before, next].map(|d| d.filter(|d| d.is_finite())) {
            [Some(a), Some(b)] => 0.5 * (a + b),
            // One-sided at borders and walls.
            [Some(a), None] | [None, Some(a)] => a,
            [None, None] => 0.0,
        };
        (slope / f64::from(cells.side)) as f32
    };
    Vec2::new(along(0, cell % width, width, 1), along(1, cell / width, height, width))
}
