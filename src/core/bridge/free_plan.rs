//! The plan of free motion, renewed at every step.

use glam::Vec2;
use rayon::prelude::*;

use super::cells::Cells;
use super::ends::{End, LEAST, over, scale_in_turn};
use super::gaussian::Gaussian;
use super::gradient::{BLUR, gather, gradients};
use super::relative_density::RelativeDensity;
use super::self_transport::SelfTransport;
use super::settings::BridgeSettings;
use crate::{Progress, Result};

/// Sweeps of the factors in each renewal, and in the first one, which starts from a plan on half as many cells.
const SWEEPS: usize = 8;
const FIRST_SWEEPS: usize = 16;
/// Sweeps of the coarsest plan, which starts from nothing, and its cells at most.
const COLD_SWEEPS: usize = 80;
const COARSEST: usize = 48;
/// Least variance in squared cells: a narrower kernel is none on the grid.
const LEAST_VARIANCE: f64 = 0.36;
/// Diffusion down the relative density, over that of the bridge.
pub(super) const DIFFUSION: f64 = 0.5;

/// The plan of free motion.
pub(super) struct FreePlan {
    settings: BridgeSettings,
    blur: Gaussian,
    /// Factors of the end that is scaled last, from the last plan.
    scale: Option<Vec<f64>>,
    own: [SelfTransport; 2],
    /// In the order of scaling.
    relative: [RelativeDensity; 2],
    error: f64,
    /// Whether the later light is scaled first. The order is that of the photons, so that exchanged keys have the same plan.
    exchanged: bool,
}

impl FreePlan {
    pub(super) fn new(settings: BridgeSettings, cells: &Cells) -> Self {
        let blur = Gaussian::new(cells.size, BLUR * BLUR);
        Self {
            settings,
            blur,
            scale: None,
            own: Default::default(),
            relative: Default::default(),
            error: 0.0,
            exchanged: false,
        }
    }

    /// The misplaced share of the light after the last renewal.
    pub(super) fn error(&self) -> f64 {
        self.error
    }

    /// Makes the plan anew after `done` steps; the velocities in cells of both sides, each towards the other.
    pub(super) fn velocities(
        &mut self,
        cells: &Cells,
        done: usize,
        photons: [&[Vec2]; 2],
        progress: &Progress,
    ) -> Result<[Vec<Vec2>; 2]> {
        let [earlier, later] = photons;
        if done == 0 {
            let bits = |p: &Vec2| [p.x.to_bits(), p.y.to_bits()];
            self.exchanged = later.iter().map(bits).lt(earlier.iter().map(bits));
        }
        if !self.exchanged {
            return self.ordered_velocities(cells, done, photons, progress);
        }
        let [of_later, of_earlier] = self.ordered_velocities(cells, done, [later, earlier], progress)?;
        Ok([of_earlier, of_later])
    }

    /// The same for photons in the order of scaling.
    fn ordered_velocities(
        &mut self,
        cells: &Cells,
        done: usize,
        photons: [&[Vec2]; 2],
        progress: &Progress,
    ) -> Result<[Vec<Vec2>; 2]> {
        let BridgeSettings { hold, steps, .. } = self.settings;
        let left = 1.0 - 2.0 * done as f64 / steps as f64;
        let variance = (f64::from(hold / cells.side).powi(2) * left).max(LEAST_VARIANCE);
        let mut kernel = Gaussian::new(cells.size, variance);
        let mut ends = photons.map(|photons| End::new(gather(cells, None, photons)));
        let sweeps = match self.scale.take() {
            Some(scale) => {
                ends[1].scale = scale;
                self.settings.sweeps(SWEEPS)
            }
            None => {
                ends[1].scale = start(&self.settings, cells, &ends[1].density, photons, progress)?;
                self.settings.sweeps(FIRST_SWEEPS)
            }
        };
        let spread = |_: usize, factor: &[f64], out: &mut [f64]| kernel.spread(factor, out);
        scale_in_turn(&mut ends, (sweeps, 0.0, 1.0), spread, progress)?;
        self.error = ends[0].error();
        let drift = variance * f64::from(cells.side).powi(2) / left;
        let velocities = [0, 1].map(|side| {
            let density = &ends[side].density;
            let own = self.own[side].renew(density, |factor, out| kernel.spread(factor, out));
            let mut reached = vec![0.0; cells.count()];
            kernel.spread(own, &mut reached);
            let mut light = vec![0.0; cells.count()];
            self.blur.spread(density, &mut light);
            let blur = |density: &[f64], out: &mut [f64]| self.blur.spread(density, out);
            let relative = self.relative[side].of((cells, None), (&light, photons[side]), blur);
            self.side_velocities(cells, drift, [&ends[side].reached, &reached, &relative])
        });
        let [_, b] = ends;
        self.scale = Some(b.scale);
        Ok(velocities)
    }

    /// `drift` grad ln(reached / own), and -s^2/2 D grad of the relative density, which fills cracks.
    fn side_velocities(&self, cells: &Cells, drift: f64, [reached, own, relative]: [&[f64]; 3]) -> Vec<Vec2> {
        let known = |reached: f64| if reached > LEAST { reached.ln() } else { f64::NAN };
        let diffusion = 0.5 * DIFFUSION * f64::from(self.settings.hold).powi(2);
        let ahead: Vec<f64> = reached
            .iter()
            .zip(own)
            .zip(relative)
            // Far from its own light a cell has no self-transport; nothing moves there.
            .map(|((reached, own), relative)| drift * (known(*reached) - known(*own)) - diffusion * relative)
            .collect();
        gradients(cells, None, &ahead)
    }
}

/// The first factor of the later end with this density: that of a plan on half as many cells, or of none.
fn start(
    settings: &BridgeSettings,
    cells: &Cells,
    later: &[f64],
    photons: [&[Vec2]; 2],
    progress: &Progress,
) -> Result<Vec<f64>> {
    if settings.cells <= COARSEST {
        return Ok(later.iter().map(|d| f64::from(u8::from(*d > 0.0))).collect());
    }
    let half = BridgeSettings { cells: settings.cells / 2, ..*settings };
    let coarse = Cells::new(half.extent, half.cells);
    let variance = f64::from(half.hold / coarse.side).powi(2).max(LEAST_VARIANCE);
    let mut kernel = Gaussian::new(coarse.size, variance);
    let mut ends = photons.map(|photons| End::new(gather(&coarse, None, photons)));
    ends[1].scale = start(&half, &coarse, &ends[1].density, photons, progress)?;
    let sweeps = half.sweeps(if half.cells <= COARSEST { COLD_SWEEPS } else { FIRST_SWEEPS });
    let mut spread = |_: usize, factor: &[f64], out: &mut [f64]| kernel.spread(factor, out);
    scale_in_turn(&mut ends, (sweeps, 0.0, 1.0), &mut spread, progress)?;
    let [a, b] = &mut ends;
    spread(0, &a.scale, &mut b.reached);
    Ok(finer_scale((&coarse, &b.reached), (cells, later)))
}

/// The factor of a density on finer cells, from what reached it on coarser ones.
pub(super) fn finer_scale(
    (coarse, reached): (&Cells, &[f64]),
    (fine, density): (&Cells, &[f64]),
) -> Vec<f64> {
    let logarithms: Vec<f64> = reached.iter().map(|reached| reached.max(LEAST).ln()).collect();
    let scale = |cell: usize| over(density[cell], coarse.value(&logarithms, fine.centre(cell)).exp());
    (0..fine.count()).into_par_iter().with_min_len(1024).map(scale).collect()
}
