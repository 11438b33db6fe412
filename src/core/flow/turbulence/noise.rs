//! Random stream functions: drawn, and made orthonormal in the inner product of their velocities.

use glam::Vec2;
use rayon::prelude::*;

use super::settings::TurbulenceSettings;
use crate::flow::field::{Field, Grid};
use crate::math::mixed_gram::{Axis, MixedGram};
use crate::math::rng::{Purpose, Stream};

/// Makes the key noises of a plane. A noise is one column of coefficients of psi per grid.
pub(super) struct NoiseMaker<'a> {
    settings: &'a TurbulenceSettings,
    shares: Vec<f64>,
    grids: Vec<Grid>,
    area: f64,
    /// Of every pair of grids (a, b), row by row of a: integrals along x and y, each of values and of slopes.
    grams: Vec<[[MixedGram; 2]; 2]>,
}

/// Coefficients of psi, one column for each grid.
pub(super) type Noise = Vec<Vec<f64>>;

impl<'a> NoiseMaker<'a> {
    /// For a plane of this extent.
    pub(super) fn new(settings: &'a TurbulenceSettings, extent: Vec2) -> Self {
        let grids: Vec<Grid> = settings.grids.iter().map(|&cells| square_cells(cells, extent)).collect();
        let pairs = grids.iter().flat_map(|a| grids.iter().map(move |b| (a, b)));
        let grams = pairs.map(|(a, b)| {
            [0, 1].map(|axis| {
                let along = |grid: &Grid| Axis { cells: grid.cells[axis], width: grid.cell_size()[axis] };
                let covered = |grid: &Grid| f64::from(grid.extent[axis]);
                let length = f64::from(extent[axis]).min(covered(a)).min(covered(b));
                [0, 1].map(|order| MixedGram::new(along(a), along(b), length, order))
            })
        });
        let grams = grams.collect();
        let area = f64::from(extent.x) * f64::from(extent.y);
        Self { settings, shares: settings.shares(), grids, area, grams }
    }

    /// The grids, in the order of the settings.
    pub(super) fn grids(&self) -> &[Grid] {
        &self.grids
    }

    /// The key noises of these numbers. Each has unit root mean square velocity, and is orthogonal to the one before and the
    /// one after: those of odd number are rid of their shares in both neighbours, so that no noise depends on any but
    /// these.
    pub(super) fn keys(&self, first: u64, last: u64) -> Vec<Noise> {
        // The odd ones at the ends need a neighbour beyond.
        let (from, to) = (first - first % 2, last + last % 2);
        let mut noises: Vec<Noise> = (from..=to).map(|key| self.draw(key)).collect();
        for odd in (1..noises.len()).step_by(2) {
            let (before, rest) = noises.split_at_mut(odd);
            let (noise, after) = rest.split_at_mut(1);
            self.orthogonalize(&mut noise[0], &before[odd - 1], &after[0]);
        }
        noises.drain((first - from) as usize..=(last - from) as usize).collect()
    }

    /// Independent Gaussian coefficients, each grid weighted by its share, all together of unit velocity.
    fn draw(&self, key: u64) -> Noise {
        let draw = |(i, grid): (usize, &Grid)| {
            // By the cells, not by the place in the list: a grid added leaves the swirls of the others.
            let mut random =
                Stream::new(self.settings.seed, Purpose::Turbulence, key, self.settings.grids[i].into());
            let [nx, ny] = grid.nodes();
            let mut column: Vec<f64> = (0..nx * ny).map(|_| gaussian(&mut random)).collect();
            let speed = self.pair(i, i, &column, &column).sqrt();
            column.iter_mut().for_each(|c| *c *= self.shares[i] / speed);
            column
        };
        let mut noise = self.grids.iter().enumerate().map(draw).collect();
        self.normalize(&mut noise);
        noise
    }

    /// Takes the shares in `a` and `b`, both of unit velocity, out of `noise`.
    fn orthogonalize(&self, noise: &mut Noise, a: &Noise, b: &Noise) {
        let [ab, to_a, to_b] = [(a, b), (&*noise, a), (&*noise, b)].map(|(x, y)| self.inner(x, y));
        let determinant = 1.0 - ab * ab;
        let (of_a, of_b) = ((to_a - ab * to_b) / determinant, (to_b - ab * to_a) / determinant);
        for ((column, a), b) in noise.iter_mut().zip(a).zip(b) {
            for ((c, a), b) in column.iter_mut().zip(a).zip(b) {
                *c -= of_a * a + of_b * b;
            }
        }
        self.normalize(noise);
    }

    fn normalize(&self, noise: &mut Noise) {
        let per_speed = 1.0 / self.inner(noise, noise).sqrt();
        noise.iter_mut().flatten().for_each(|c| *c *= per_speed);
    }

    /// Mean over the plane of the scalar product of two noises' velocities.
    pub(super) fn inner(&self, a: &Noise, b: &Noise) -> f64 {
        let all = 0..self.grids.len();
        all.clone()
            .flat_map(|i| all.clone().map(move |k| (i, k)))
            .map(|(i, k)| self.pair(i, k, &a[i], &b[k]))
            .sum()
    }

    /// The same of one column on grid `i` and one on grid `k`: a^T (G1 x G0 + G0 x G1) b / |D|, exactly.
    fn pair(&self, i: usize, k: usize, a: &[f64], b: &[f64]) -> f64 {
        let [x, y] = &self.grams[i * self.grids.len() + k];
        let (na, nb) = (self.grids[i].nodes()[0], self.grids[k].nodes()[0]);
        let row = |(row, a): (usize, &[f64])| {
            let of_order = |order: usize| {
                let (first, weights) = y[order].row(row);
                let mut across = vec![0.0; nb];
                for (weight, b) in weights.iter().zip(b[first * nb..].chunks_exact(nb)) {
                    across.iter_mut().zip(b).for_each(|(sum, b)| *sum += weight * b);
                }
                let along = |(column, a): (usize, &f64)| {
                    let (first, weights) = x[1 - order].row(column);
                    a * weights.iter().zip(&across[first..]).map(|(weight, b)| weight * b).sum::<f64>()
                };
                a.iter().enumerate().map(along).sum::<f64>()
            };
            of_order(0) + of_order(1)
        };
        let rows: Vec<f64> = a.par_chunks_exact(na).enumerate().map(row).collect();
        rows.iter().sum::<f64>() / self.area
    }
}

/// The fields of a noise, `scale` times as strong.
pub(super) fn fields(grids: &[Grid], noise: &Noise, scale: f64) -> Vec<Field> {
    let field = |(grid, psi): (&Grid, &Vec<f64>)| {
        let psi: Vec<f32> = psi.iter().map(|c| (scale * c) as f32).collect();
        Field::from_potentials(*grid, &psi, &vec![0.0; psi.len()])
    };
    grids.iter().zip(noise).map(field).collect()
}

/// A grid of square cells, `cells` along the longer side of the plane; along the other the last may reach beyond.
fn square_cells(cells: u32, extent: Vec2) -> Grid {
    // Rounding must not add a row.
    let count = [extent.x, extent.y].map(|length| ((length * cells as f32 - 1e-3).ceil() as usize).max(1));
    Grid { cells: count, extent: Vec2::new(count[0] as f32, count[1] as f32) / cells as f32 }
}

/// A normally distributed number (Box and Muller).
fn gaussian(random: &mut Stream) -> f64 {
    let (radius, angle) = (1.0 - random.f64(), random.f64());
    (-2.0 * radius.ln()).sqrt() * (std::f64::consts::TAU * angle).cos()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbouring_keys_are_orthonormal_over_all_grids() {
        let settings = TurbulenceSettings { grids: vec![5, 8, 21], ..Default::default() };
        let maker = NoiseMaker::new(&settings, Vec2::new(1.0, 0.37));
        let keys = maker.keys(3, 8);
        assert_eq!(keys.len(), 6);
        for pair in keys.windows(2) {
            // Sums of some thousand terms in f64.
            assert!((maker.inner(&pair[0], &pair[0]) - 1.0).abs() < 1e-12);
            assert!(maker.inner(&pair[0], &pair[1]).abs() < 1e-12);
        }
    }

    #[test]
    fn a_key_is_the_same_whichever_others_are_asked_for() {
        let settings = TurbulenceSettings { grids: vec![6, 9], ..Default::default() };
        let maker = NoiseMaker::new(&settings, Vec2::ONE);
        let all = maker.keys(0, 9);
        for first in 0..9 {
            assert_eq!(maker.keys(first, first + 1), all[first as usize..][..2]);
        }
    }

    #[test]
    fn the_inner_product_is_the_mean_over_the_plane() {
        let settings = TurbulenceSettings { grids: vec![5, 8], ..Default::default() };
        let extent = Vec2::new(0.55, 1.0);
        let maker = NoiseMaker::new(&settings, extent);
        let [a, b] = maker.keys(1, 2).try_into().unwrap_or_else(|_| unreachable!());
        let fields = |noise: &Noise| fields(maker.grids(), noise, 1.0);
        let (fa, fb) = (fields(&a), fields(&b));
        let velocity = |fields: &[Field], p: [f64; 2]| {
            let all = fields.iter().map(|field| field.velocity_f64(p));
            all.fold([0.0; 2], |sum, u| [sum[0] + u[0], sum[1] + u[1]])
        };
        let side = 400u32;
        let mut sums = [0.0; 2];
        for i in 0..side * side {
            let [x, y] = [i % side, i / side].map(|n| (f64::from(n) + 0.5) / f64::from(side));
            let p = [x * f64::from(extent.x), y * f64::from(extent.y)];
            let (u, v) = (velocity(&fa, p), velocity(&fb, p));
            sums[0] += u[0] * u[0] + u[1] * u[1];
            sums[1] += u[0] * v[0] + u[1] * v[1];
        }
        let mean = sums.map(|sum| sum / f64::from(side * side));
        // The midpoint rule with 20 points a cell leaves some 1e-4, single precision 1e-7.
        assert!((mean[0] - 1.0).abs() < 1e-3 && mean[1].abs() < 1e-3, "{mean:?}");
    }
}
