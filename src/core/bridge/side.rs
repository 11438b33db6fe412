//! One end of a plan: the light there, its potentials, and the velocities towards the other end.

use glam::Vec2;
use rayon::prelude::*;

use super::cells::Cells;
use super::kernel::Kernel;
use super::wall_cells::WallCells;

/// Values below this count as none: their logarithm is left alone.
pub(super) const LEAST: f64 = 1e-280;
/// Iterations of the self-transport for each plan; it starts from the last.
const SELF_SWEEPS: usize = 4;
/// Density that one photon spreads over a blur of a cell and a half, cells^-1, and the share of it that counts as none.
const ONE_PHOTON: f64 = 0.07;
const FLOOR: f64 = 0.1;

/// One end of a plan.
pub(super) struct Side {
    /// Share of the light in each cell; sum 1.
    pub(super) density: Vec<f64>,
    /// The Schroedinger factor of this end.
    pub(super) scale: Vec<f64>,
    /// The factor of the other end, spread to this one.
    pub(super) reached: Vec<f64>,
    /// The factor of the transport of this end onto itself, and that spread.
    own_scale: Vec<f64>,
    own_reached: Vec<f64>,
    /// Blurred density around each photon at the key frame.
    birth: Vec<f32>,
    /// Velocity towards the other end in each cell, plane units per unit of time.
    pub(super) velocity: Vec<Vec2>,
}

impl Side {
    pub(super) fn new(count: usize) -> Self {
        let zero = || vec![0.0; count];
        Self {
            density: zero(),
            scale: zero(),
            reached: zero(),
            own_scale: Vec::new(),
            own_reached: zero(),
            birth: Vec::new(),
            velocity: vec![Vec2::ZERO; count],
        }
    }

    /// Puts the photons into cells.
    pub(super) fn gather(&mut self, cells: &Cells, walls: Option<&WallCells>, photons: &[Vec2]) {
        let mut sums = match walls {
            None => cells.sum(photons, |_, p| cells.around(p)),
            Some(walls) => cells.sum(photons, |_, p| walls.around(p)),
        };
        let total = sums.iter().sum::<f64>().max(f64::MIN_POSITIVE);
        sums.iter_mut().for_each(|sum| *sum /= total);
        self.density = sums;
    }

    /// The factor that makes the light at this end what it is.
    pub(super) fn rescale(&mut self) {
        let columns = self.scale.iter_mut().zip(&self.density).zip(&self.reached);
        columns.for_each(|((scale, density), reached)| *scale = over(*density, *reached));
    }

    /// Renews the transport of this end onto itself.
    pub(super) fn transport_onto_itself(&mut self, side: usize, kernel: &mut Kernel) {
        let fresh = self.own_scale.is_empty();
        if fresh {
            self.own_scale = self.density.iter().map(|density| density.sqrt()).collect();
        }
        let least = 1e-6 * self.own_scale.iter().copied().fold(0.0, f64::max);
        for (scale, density) in self.own_scale.iter_mut().zip(&self.density) {
            *scale = if *density > 0.0 { scale.max(least) } else { 0.0 };
        }
        for _ in 0..if fresh { 3 * SELF_SWEEPS } else { SELF_SWEEPS } {
            kernel.spread_freely(side, &self.own_scale, &mut self.own_reached);
            let columns = self.own_scale.iter_mut().zip(&self.density).zip(&self.own_reached);
            // The square root damps the swing of the symmetric iteration.
            columns
                .for_each(|((scale, density), reached)| *scale = (*scale * over(*density, *reached)).sqrt());
        }
        kernel.spread_freely(side, &self.own_scale, &mut self.own_reached);
    }

    /// The velocity of each cell: `drift` grad ln(reached / own) towards the other end, and -`diffusion` grad ln of the
    /// density over that at the key frame, which fills cracks.
    pub(super) fn find_velocities(
        &mut self,
        cells: &Cells,
        walls: Option<&WallCells>,
        drift: f64,
        (diffusion, relative): (f64, &[f64]),
    ) {
        let known = |reached: f64| if reached > LEAST { reached.ln() } else { f64::NAN };
        let ahead: Vec<f64> = self
            .reached
            .iter()
            .zip(&self.own_reached)
            .zip(relative)
            .map(|((reached, own), relative)| {
                // Far from its own light a cell has no self-transport; nothing moves there.
                drift * (known(*reached) - known(*own)) - diffusion * relative
            })
            .collect();
        let gradient = |cell: usize| gradient(cells, walls, &ahead, cell);
        self.velocity = (0..cells.count()).into_par_iter().with_min_len(1024).map(gradient).collect();
    }

    /// ln of the density around each cell over that at the key frame; zero before any photon has moved.
    pub(super) fn relative_density(
        &mut self,
        side: usize,
        cells: &Cells,
        (walls, kernel): (Option<&WallCells>, &mut Kernel),
        photons: &[Vec2],
    ) -> Vec<f64> {
        let mut light = vec![0.0; cells.count()];
        kernel.blur(side, &self.density, &mut light);
        if self.birth.is_empty() {
            let birth = |&p: &Vec2| cells.value(&light, p) as f32;
            self.birth = photons.par_iter().with_min_len(4096).map(birth).collect();
            return vec![0.0; cells.count()];
        }
        let birth = &self.birth;
        let per_photon = 1.0 / photons.len().max(1) as f32;
        let weigh =
            |i: usize, around: [(usize, f32); 4]| around.map(|(cell, w)| (cell, w * birth[i] * per_photon));
        let sums = match walls {
            None => cells.sum(photons, |i, p| weigh(i, cells.around(p))),
            Some(walls) => cells.sum(photons, |i, p| weigh(i, walls.around(p))),
        };
        let mut born = vec![0.0; cells.count()];
        kernel.blur(side, &sums, &mut born);
        let floor = FLOOR * ONE_PHOTON * f64::from(per_photon);
        let relative =
            |(light, born): (&f64, &f64)| ((light + floor) / (born / light.max(1e-12) + floor)).ln();
        light.iter().zip(&born).map(relative).collect()
    }
}

/// `a` / `b`; 0 where either is none.
fn over(a: f64, b: f64) -> f64 {
    if a > 0.0 && b > LEAST { a / b } else { 0.0 }
}

/// The gradient of `values` in a cell by differences to those neighbours that it sees and that have a value; plane units.
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
        let differences = [before, next].map(|d| d.filter(|d| d.is_finite()));
        let slope = match differences {
            [Some(a), Some(b)] => 0.5 * (a + b),
            // One-sided at borders and walls.
            [Some(a), None] | [None, Some(a)] => a,
            [None, None] => 0.0,
        };
        (slope / f64::from(cells.side)) as f32
    };
    Vec2::new(along(0, cell % width, width, 1), along(1, cell / width, height, width))
}
