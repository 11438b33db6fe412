//! A plan around walls that is renewed on the way from where the light is.

use glam::Vec2;

use super::cells::Cells;
use super::ends::{End, RELAXATION, scale_in_turn};
use super::free_plan::DIFFUSION;
use super::gradient::{floor, gather, gradients};
use super::regions::Regions;
use super::relative_density::RelativeDensity;
use super::self_transport::{SelfTransport, lift};
use super::settings::BridgeSettings;
use super::wall_cells::WallCells;
use super::wall_kernel::WallKernel;
use crate::math::smoothstep::smoothstep;
use crate::{Progress, Result};

/// Sweeps of a renewal at most, and the misplaced share of the light at which they end.
const SWEEPS: usize = 150;
const TOLERANCE: f64 = 3e-3;
/// Steps from a renewal to the next. With 1 the gap is .0030 and .0055 in place of .0035 and .0067 (*letters*, *bottles*), for twice
/// the time.
const EVERY: usize = 2;
/// Distance to a wall up to which light also spreads as planned, over the size of the pieces that hold together: light that goes
/// along a wall would gather there in a thread.
const BESIDE: f32 = 1.0;

/// What a renewal takes from the one before.
#[derive(Default)]
pub(super) struct Renewal {
    own: [SelfTransport; 2],
    relative: [RelativeDensity; 2],
    velocities: [Vec<Vec2>; 2],
}

/// What stays the same from renewal to renewal: the cells, the walls and the regions among them, the variance of a step in plane
/// units squared, and the steps of the kernel that make the blur of densities.
pub(super) struct Grid<'a> {
    pub(super) cells: &'a Cells,
    pub(super) walls: Option<&'a WallCells<'a>>,
    pub(super) regions: &'a Regions,
    pub(super) variance: f64,
    pub(super) blur: usize,
}

impl Renewal {
    /// The velocities in cells of both sides after `done` steps, each towards the other. `kernel` has the plan before, and has the
    /// renewed one then.
    pub(super) fn velocities(
        &mut self,
        kernel: &mut WallKernel,
        (settings, grid): (&BridgeSettings, &Grid),
        (done, photons): (usize, [&[Vec2]; 2]),
        progress: &Progress,
    ) -> Result<&[Vec<Vec2>; 2]> {
        if !done.is_multiple_of(EVERY) {
            return Ok(&self.velocities);
        }
        let mut ends = photons.map(|photons| End::new(gather(grid.cells, grid.walls, photons)));
        if done > 0 {
            let [a, b] = &mut ends;
            grid.regions.balance(&a.density, &mut b.density);
            b.scale = kernel.later_end().to_vec();
            lift(&mut b.scale, &b.density);
            kernel.narrow(done);
            let spread = |side: usize, factor: &[f64], out: &mut [f64]| kernel.spread(side, factor, out);
            let tolerance = TOLERANCE / f64::from(settings.sweeps);
            scale_in_turn(&mut ends, (settings.sweeps(SWEEPS), tolerance, RELAXATION), spread, progress)?;
        }
        self.velocities = [0, 1].map(|side| {
            self.side_velocities(kernel, (settings, grid), (side, done), (&ends[side].density, photons[side]))
        });
        Ok(&self.velocities)
    }

    /// The mean move of the light of a side towards the other end. Of it is taken, as in free motion, that of its transport onto
    /// itself; close to walls half the spreading instead, so that it moves as the planned density does. It diffuses down its relative density.
    fn side_velocities(
        &mut self,
        kernel: &mut WallKernel,
        (settings, grid): (&BridgeSettings, &Grid),
        (side, done): (usize, usize),
        (density, photons): (&[f64], &[Vec2]),
    ) -> Vec<Vec2> {
        let &Grid { cells, walls, variance, blur, .. } = grid;
        let steps = settings.steps;
        let (step, left) = (if side == 0 { done } else { steps - 1 - done }, steps - 2 * done);
        let onward = kernel.onward(side, step, cells);
        let own = self.own[side].renew(density, |factor, out| kernel.blur(step, left, factor, out));
        let mut light = vec![0.0; cells.count()];
        kernel.blur(step, left - 1, own, &mut light);
        let own = kernel.moves_towards(step, &light, cells);

        kernel.blur(step, blur, density, &mut light);
        let blur = |density: &[f64], out: &mut [f64]| kernel.blur(step, blur, density, out);
        let relative = self.relative[side].of((cells, walls), (&light, photons), blur);
        let back = gradients(cells, walls, &relative);
        let floor = floor(photons.len());
        let logarithms: Vec<f64> = light.iter().map(|light| (light + floor).ln()).collect();
        let spreads = gradients(cells, walls, &logarithms);
        let half = 0.5 * variance as f32;
        let velocity = |cell: usize| {
            let away =
                walls.map_or(f32::INFINITY, |walls| walls.distances()[cell]) / (BESIDE * settings.hold);
            let free = smoothstep(f64::from(away)) as f32;
            let moves = onward[cell] - free * own[cell] - (1.0 - free) * half * spreads[cell];
            steps as f32 * (moves - DIFFUSION as f32 * half * back[cell])
        };
        (0..cells.count()).map(velocity).collect()
    }
}
