//! Square cells over the plane: densities and velocities at their centres.

use std::iter::Sum;
use std::ops::Mul;

use glam::Vec2;
use rayon::prelude::*;

/// Square cells over the plane, row by row from y = 0 upwards. Values stand for the centres of cells; points beyond the
/// outermost centres take the value of the nearest.
#[derive(Clone, Debug, PartialEq, serde::Deserialize, serde::Serialize)]
pub struct Cells {
    /// Cells along x and y; at least two.
    pub size: [usize; 2],
    /// Length of a side, plane units.
    pub side: f32,
}

/// The four cells around a point, as the index of the lower left one, and the place between their centres.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub(super) index: usize,
    pub(super) x: f32,
    pub(super) y: f32,
}

/// Points per parallel task; fixed, so that sums come out the same on any number of threads.
const CHUNK: usize = 1 << 14;

impl Cells {
    /// `longer` cells along the longer side of a plane of size `extent`, whose longer side is 1.
    pub fn new(extent: Vec2, longer: usize) -> Self {
        let side = extent.max_element() / longer.max(2) as f32;
        let count = |length: f32| ((length / side).round() as usize).max(2);
        Self { size: [count(extent.x), count(extent.y)], side }
    }

    /// The number of cells.
    pub fn count(&self) -> usize {
        self.size[0] * self.size[1]
    }

    /// The centre of cell `index`, plane units.
    pub fn centre(&self, index: usize) -> Vec2 {
        let (x, y) = (index % self.size[0], index / self.size[0]);
        Vec2::new(x as f32 + 0.5, y as f32 + 0.5) * self.side
    }

    #[inline]
    pub(super) fn place(&self, p: Vec2) -> Place {
        let [width, height] = self.size;
        let along = |p: f32, count: usize| {
            let at = (p / self.side - 0.5).max(0.0).min((count - 1) as f32);
            let cell = (at as usize).min(count - 2);
            (cell, at - cell as f32)
        };
        let ((column, x), (row, y)) = (along(p.x, width), along(p.y, height));
        Place { index: row * width + column, x, y }
    }

    /// The cell that holds a point; beyond the outermost cells the nearest.
    #[inline]
    pub fn holding(&self, p: Vec2) -> usize {
        let [width, height] = self.size;
        let column = ((p.x / self.side).max(0.0) as usize).min(width - 1);
        let row = ((p.y / self.side).max(0.0) as usize).min(height - 1);
        row * width + column
    }

    /// The four cells around a point with their bilinear weights.
    #[inline]
    pub(super) fn around(&self, p: Vec2) -> [(usize, f32); 4] {
        let Place { index, x, y } = self.place(p);
        let width = self.size[0];
        [
            (index, (1.0 - x) * (1.0 - y)),
            (index + 1, x * (1.0 - y)),
            (index + width, (1.0 - x) * y),
            (index + width + 1, x * y),
        ]
    }

    /// The sum of `weight(i, cell)` over points, `weights` giving the cells of each with their shares.
    pub(super) fn sum<const N: usize>(
        &self,
        points: &[Vec2],
        cells_of: impl Fn(usize, Vec2) -> [(usize, f32); N] + Sync,
    ) -> Vec<f64> {
        let partial = points.par_chunks(CHUNK).enumerate().map(|(chunk, points)| {
            let mut sums = vec![0.0; self.count()];
            for (i, &p) in points.iter().enumerate() {
                for (cell, weight) in cells_of(chunk * CHUNK + i, p) {
                    sums[cell] += f64::from(weight);
                }
            }
            sums
        });
        let mut all = vec![0.0; self.count()];
        for sums in partial.collect::<Vec<_>>() {
            all.iter_mut().zip(sums).for_each(|(all, sum)| *all += sum);
        }
        all
    }

    /// The bilinear value at a point, in single precision.
    #[inline]
    pub fn single_value<T: Copy + Mul<f32, Output = T> + Sum>(&self, values: &[T], p: Vec2) -> T {
        weighted(values, self.around(p))
    }

    /// The bilinear value at a point.
    #[inline]
    pub fn value(&self, values: &[f64], p: Vec2) -> f64 {
        self.around(p).iter().map(|&(cell, weight)| f64::from(weight) * values[cell]).sum()
    }
}

/// The sum of the values of some cells, each times its weight.
#[inline]
pub(super) fn weighted<T: Copy + Mul<f32, Output = T> + Sum>(values: &[T], cells: [(usize, f32); 4]) -> T {
    cells.iter().map(|&(cell, weight)| values[cell] * weight).sum()
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::*;

    #[test]
    fn what_is_put_into_cells_is_all_there_and_has_its_centre_of_mass() {
        let cells = Cells::new(Vec2::new(1.0, 0.5), 16);
        assert_eq!(cells.size, [16, 8]);
        let points: Vec<Vec2> = (0..50_000).map(|i| Vec2::new(0.2 + 1e-5 * i as f32, 0.3)).collect();
        let sums = cells.sum(&points, |_, p| cells.around(p));
        let total: f64 = sums.iter().sum();
        assert!((total - 50_000.0).abs() < 0.5, "single precision weights: {total}");
        let moment: DVec2 = (0..cells.count()).map(|i| cells.centre(i).as_dvec2() * sums[i]).sum();
        let mean = points.iter().map(|p| p.as_dvec2()).sum::<DVec2>() / 50_000.0;
        // Single precision weights.
        assert!((moment / total).distance(mean) < 1e-6, "bilinear weights keep linear functions");
    }
}
