//! The square cells on which densities and potentials of the matching live.

use glam::{DVec2, Vec2};
use rayon::prelude::*;

use crate::Progress;
use crate::Result;

/// Points beyond this many plane units around the rectangle are counted at the edge: a stray point must not coarsen
/// the lattice for all others.
const REACH: f32 = 1.0;
/// Points per parallel task of a histogram; fixed, so that sums come out the same on any number of threads.
const CHUNK: usize = 1 << 17;

/// `size[0]` x `size[1]` square cells. Row-major, x first; "cell units" have their origin at the lattice's corner.
#[derive(Clone, Copy, Debug, PartialEq, serde::Deserialize, serde::Serialize)]
pub(super) struct Lattice {
    pub(super) size: [usize; 2],
    /// The corner of least x and y, in the plane.
    pub(super) origin: DVec2,
    /// Side of a cell, in the plane.
    pub(super) cell: f64,
}

impl Lattice {
    /// Covers the rectangle and both point sets; `finest` cells along the longer side, a multiple of 16.
    pub(super) fn covering(source: &[Vec2], target: &[Vec2], extent: Vec2, finest: usize) -> Self {
        let reach = Vec2::splat(REACH);
        let (mut low, mut high) = (Vec2::ZERO, extent);
        for point in source.iter().chain(target) {
            low = low.min(*point);
            high = high.max(*point);
        }
        let (low, high) = (low.max(-reach).as_dvec2(), high.min(extent + reach).as_dvec2());
        // One cell of margin: the outermost points keep clear of the border, where the map cannot move inwards.
        let longest = (high - low).max_element();
        let cell = longest / (finest - 2) as f64;
        let cells = |length: f64| ((length / cell + 2.0 - 1e-6).ceil() as usize).next_multiple_of(16);
        let size = [cells(high.x - low.x), cells(high.y - low.y)];
        let middle = (low + high) / 2.0;
        Self { size, origin: middle - DVec2::new(size[0] as f64, size[1] as f64) * cell / 2.0, cell }
    }

    /// The same area in cells of twice the side.
    pub(super) fn coarser(&self) -> Self {
        Self { size: self.size.map(|n| n / 2), cell: self.cell * 2.0, ..*self }
    }

    pub(super) fn len(&self) -> usize {
        self.size[0] * self.size[1]
    }

    /// Plane to cell units, brought inside.
    pub(super) fn cells_from_plane(&self, point: Vec2) -> DVec2 {
        let upper = DVec2::new(self.size[0] as f64, self.size[1] as f64);
        ((point.as_dvec2() - self.origin) / self.cell).clamp(DVec2::ZERO, upper)
    }

    /// The points' density with mean 1, mixed with `floor` parts of the uniform density.
    ///
    /// Each point is shared among the four nearest cells ("cloud in cell").
    pub(super) fn density(&self, points: &[Vec2], floor: f64, progress: &Progress) -> Result<Vec<f64>> {
        let mut density = vec![0.0; self.len()];
        // Two chunks at a time hold memory down; the order of addition is the order of the points.
        for pair in points.chunks(2 * CHUNK) {
            progress.check()?;
            let parts: Vec<Vec<f64>> = pair.par_chunks(CHUNK).map(|chunk| self.count(chunk)).collect();
            for part in parts {
                density.iter_mut().zip(part).for_each(|(sum, count)| *sum += count);
            }
        }
        let scale = (1.0 - floor) * self.len() as f64 / points.len() as f64;
        density.iter_mut().for_each(|value| *value = *value * scale + floor);
        Ok(density)
    }

    fn count(&self, points: &[Vec2]) -> Vec<f64> {
        let mut counts = vec![0.0; self.len()];
        for point in points {
            self.deposit(self.cells_from_plane(*point), 1.0, &mut counts);
        }
        counts
    }

    /// Shares `mass` at `point` (cell units, inside) among the four nearest cells.
    #[inline]
    pub(super) fn deposit(&self, point: DVec2, mass: f64, into: &mut [f64]) {
        let (x, y) = (point.x - 0.5, point.y - 0.5);
        let [width, height] = self.size;
        // Truncation instead of floor: -0.5..0 goes to cell 0, as it should at the border.
        let (column, row) = ((x as usize).min(width - 1), (y as usize).min(height - 1));
        let (right, up) = ((column + 1).min(width - 1), (row + 1).min(height - 1));
        let (u, v) = ((x - column as f64).clamp(0.0, 1.0), (y - row as f64).clamp(0.0, 1.0));
        into[row * width + column] += mass * (1.0 - u) * (1.0 - v);
        into[row * width + right] += mass * u * (1.0 - v);
        into[up * width + column] += mass * (1.0 - u) * v;
        into[up * width + right] += mass * u * v;
    }

    /// Average of four cells each: a density of mean 1 on the coarser lattice.
    pub(super) fn restrict(&self, fine: &[f64]) -> Vec<f64> {
        let [width, height] = self.size.map(|n| n / 2);
        (0..width * height)
            .map(|i| {
                let corner = 2 * (i / width) * self.size[0] + 2 * (i % width);
                let above = corner + self.size[0];
                (fine[corner] + fine[corner + 1] + fine[above] + fine[above + 1]) / 4.0
            })
            .collect()
    }

    /// A potential of the coarser lattice on this one: bilinear, and in this one's cell units (hence the 4).
    pub(super) fn prolong(&self, coarse: &[f64]) -> Vec<f64> {
        let lattice = self.coarser();
        (0..self.len())
            .map(|i| {
                let (column, row) = ((i % self.size[0]) as f64, (i / self.size[0]) as f64);
                4.0 * lattice.interpolate(coarse, DVec2::new(column + 0.5, row + 0.5) / 2.0)
            })
            .collect()
    }

    /// Values at cell centres, between them bilinear, constant beyond the outermost.
    pub(super) fn interpolate(&self, values: &[f64], point: DVec2) -> f64 {
        let [width, height] = self.size;
        let x = (point.x - 0.5).clamp(0.0, (width - 1) as f64);
        let y = (point.y - 0.5).clamp(0.0, (height - 1) as f64);
        let (column, row) =
            ((x as usize).min(width.saturating_sub(2)), (y as usize).min(height.saturating_sub(2)));
        let (u, v) = (x - column as f64, y - row as f64);
        let at = |column: usize, row: usize| values[row * width + column];
        (1.0 - v) * ((1.0 - u) * at(column, row) + u * at(column + 1, row))
            + v * ((1.0 - u) * at(column, row + 1) + u * at(column + 1, row + 1))
    }

    /// Quadratic B-spline with the values as coefficients: the curvature of a potential is kept, and its slope continuous.
    pub(super) fn smooth(&self, values: &[f64], point: DVec2) -> f64 {
        let [width, height] = self.size;
        let weights = |x: f64| {
            let u = x - x.floor() - 0.5;
            [0.5 * (0.5 - u) * (0.5 - u), 0.75 - u * u, 0.5 * (0.5 + u) * (0.5 + u)]
        };
        let (across, along) = (weights(point.x), weights(point.y));
        let nearest =
            |x: f64, offset: i64, n: usize| (x.floor() as i64 + offset).clamp(0, n as i64 - 1) as usize;
        let mut sum = 0.0;
        for (row, v) in (-1..=1).zip(along) {
            let line = &values[nearest(point.y, row, height) * width..][..width];
            for (column, u) in (-1..=1).zip(across) {
                sum += u * v * line[nearest(point.x, column, width)];
            }
        }
        sum
    }
}
