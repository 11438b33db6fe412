//! How dense light is over how dense it was.

use glam::Vec2;
use rayon::prelude::*;

use super::cells::Cells;
use super::gradient::floor;
use super::wall_cells::WallCells;

/// The blurred density around each photon at its key frame, by row; empty before it is known.
#[derive(Default)]
pub(super) struct RelativeDensity {
    birth: Vec<f32>,
}

impl RelativeDensity {
    /// ln of the blurred density `light` in each cell over the mean over its photons of that at the key frame; zero in the first
    /// call, before any photon has moved. `blur` is the blur of densities.
    pub(super) fn of(
        &mut self,
        (cells, walls): (&Cells, Option<&WallCells>),
        (light, photons): (&[f64], &[Vec2]),
        blur: impl FnOnce(&[f64], &mut [f64]),
    ) -> Vec<f64> {
        if self.birth.is_empty() {
            let birth = |&p: &Vec2| cells.value(light, p) as f32;
            self.birth = photons.par_iter().with_min_len(4096).map(birth).collect();
            return vec![0.0; cells.count()];
        }
        let per_photon = 1.0 / photons.len().max(1) as f32;
        let weigh = |i: usize, p: Vec2| {
            let around = walls.map_or_else(|| cells.around(p), |walls| walls.around(p));
            around.map(|(cell, weight)| (cell, weight * self.birth[i] * per_photon))
        };
        let sums = cells.sum(photons, weigh);
        let mut born = vec![0.0; cells.count()];
        blur(&sums, &mut born);
        let floor = floor(photons.len());
        let relative =
            |(light, born): (&f64, &f64)| ((light + floor) / (born / light.max(1e-12) + floor)).ln();
        light.iter().zip(&born).map(relative).collect()
    }
}
