//! The plan of motion around walls, made once, and followed or renewed.

use std::f64::consts::GOLDEN_RATIO;

use glam::Vec2;

use super::cells::Cells;
use super::ends::{End, RELAXATION, scale_in_turn};
use super::free_plan::finer_scale;
use super::gradient::{BLUR, floor, gather, gradients};
use super::regions::Regions;
use super::renewal::{Grid, Renewal};
use super::settings::BridgeSettings;
use super::step_kernel::StepKernel;
use super::wall_cells::{StandingWalls, WallCells};
use super::wall_kernel::WallKernel;
use crate::math::smoothstep::smoothstep;
use crate::{Progress, Result};

/// Sweeps of the factors at most, and the misplaced share of the light at which they end.
const SWEEPS: usize = 150;
const TOLERANCE: f64 = 1e-3;
/// Cells of the plan from which a finer one starts, at most.
const COARSEST: usize = 48;
/// Least variance of a step in squared cells: a narrower kernel is none on the grid.
const LEAST_VARIANCE: f64 = 0.36;
/// Reach of the softness of walls, over the size of the pieces that hold together, and the logarithm of how much light less there is
/// at a wall that stands all the time.
const REACH: f64 = 0.6;
const SOFTNESS: f64 = 20.0;
/// Diffusion down the density over the planned one, over that of the bridge. With 1 the gap at the meeting is .0037 and .0159 in
/// place of .0026 and .0139 (*letters*, *bottles*); with 4 it is no smaller.
const FEEDBACK: f64 = 2.0;
/// Share of the straight ways between both key frames that walls block, up to which the plan is renewed on the way, and from which on it
/// is followed as it was made; the flow of a wall that is dragged changes little by little. Where light squeezes through a slit, or goes
/// around a bar or a C, renewed plans crack it.
const FEW_BLOCKED: f64 = 0.28;
const MANY_BLOCKED: f64 = 0.36;
/// The number of ways that are looked at.
const WAYS: usize = 1024;
/// Share of the light whose cells set the cap; brighter ones keep their own density.
const CAP_SHARE: f64 = 0.9;

/// The plan of motion around walls, once it is made.
pub(super) struct WallPlan {
    settings: BridgeSettings,
    /// Followed as it was made.
    followed: Option<Made>,
    /// Renewed, where the same walls stand all the time and leave most ways open.
    renewed: Option<(Made, Renewal)>,
    /// Share of the renewed plan in the velocities.
    share: f32,
}

/// A plan that is made.
#[derive(Clone)]
struct Made {
    kernel: WallKernel,
    regions: Regions,
    /// Light of the ends, share in each cell.
    ends: [Vec<f64>; 2],
    /// Variance of a step, plane units squared.
    variance: f64,
    /// Steps of the kernel that make the blur of densities.
    blur: usize,
    error: f64,
}

impl WallPlan {
    pub(super) fn new(settings: BridgeSettings) -> Self {
        Self { settings, followed: None, renewed: None, share: 0.0 }
    }

    fn made(&self) -> Option<&Made> {
        self.followed.as_ref().or(self.renewed.as_ref().map(|(made, _)| made))
    }

    /// The misplaced share of the light.
    pub(super) fn error(&self) -> f64 {
        self.made().map_or(0.0, |made| made.error)
    }

    /// Share of the light of either key frame that walls shut off from the other.
    pub(super) fn shut_off(&self) -> [f64; 2] {
        self.made().map_or([0.0; 2], |made| made.regions.shut_off())
    }

    /// The velocities in cells of both sides after `done` steps, each towards the other. The first call makes the plan.
    pub(super) fn velocities(
        &mut self,
        (cells, walls): (&Cells, &StandingWalls),
        done: usize,
        photons: [&[Vec2]; 2],
        progress: &Progress,
    ) -> Result<[Vec<Vec2>; 2]> {
        if self.made().is_none() {
            let made = Made::new(&self.settings, (cells, walls), photons, None, progress)?;
            self.share = match walls.runs().count() {
                1 => renewed_share(blocked(walls.of(0, 0), photons)),
                _ => 0.0,
            };
            (self.followed, self.renewed) = match self.share {
                0.0 => (Some(made), None),
                1.0 => (None, Some((made, Renewal::default()))),
                _ => (Some(made.clone()), Some((made, Renewal::default()))),
            };
        }
        let mut velocities = [(); 2].map(|()| vec![Vec2::ZERO; cells.count()]);
        let mut add = |share: f32, plan: &[Vec<Vec2>; 2]| {
            for (sum, velocities) in velocities.iter_mut().zip(plan) {
                sum.iter_mut().zip(velocities).for_each(|(sum, velocity)| *sum += share * *velocity);
            }
        };
        if let Some(made) = &mut self.followed {
            let mut followed = |side: usize| {
                made.side_velocities(&self.settings, (cells, walls), (side, done), photons[side])
            };
            add(1.0 - self.share, &[followed(0), followed(1)]);
        }
        if let Some((made, renewal)) = &mut self.renewed {
            let Made { kernel, regions, variance, blur, .. } = made;
            let grid = Grid { cells, walls: walls.of(0, 0), regions, variance: *variance, blur: *blur };
            add(self.share, renewal.velocities(kernel, (&self.settings, &grid), (done, photons), progress)?);
        }
        Ok(velocities)
    }
}

/// The share of the renewed plan where walls block this share of the ways.
fn renewed_share(blocked: f64) -> f32 {
    (1.0 - smoothstep((blocked - FEW_BLOCKED) / (MANY_BLOCKED - FEW_BLOCKED))) as f32
}

impl Made {
    /// Makes the plan; `coarse` has coarser cells and what reached the later end on them.
    fn new(
        settings: &BridgeSettings,
        (cells, walls): (&Cells, &StandingWalls),
        photons: [&[Vec2]; 2],
        coarse: Option<(&Cells, &[f64])>,
        progress: &Progress,
    ) -> Result<Self> {
        let steps = settings.steps;
        let mut ends = [0, 1].map(|side| End::new(gather(cells, walls.of(side, 0), photons[side])));
        let regions = Regions::new(cells, walls, [&ends[0].density, &ends[1].density]);
        let [a, b] = &mut ends;
        regions.balance(&a.density, &mut b.density);
        let whole = f64::from(settings.hold / cells.side).powi(2);
        let step = (whole / steps as f64).max(LEAST_VARIANCE);
        let kernels = walls.runs().map(|walls| StepKernel::new(cells, walls, step)).collect();
        let soft = walls.runs().map(|walls| soft(settings, cells, walls)).collect();
        let of_step = (0..steps).map(|step| walls.run_of(step)).collect();
        let mut kernel =
            WallKernel::new((kernels, soft), of_step, cap(settings, [&ends[0].density, &ends[1].density]));
        ends[1].scale = match coarse {
            Some(coarse) => finer_scale(coarse, (cells, &ends[1].density)),
            None if settings.cells <= COARSEST => {
                ends[1].density.iter().map(|d| f64::from(u8::from(*d > 0.0))).collect()
            }
            None => {
                let half = BridgeSettings { cells: settings.cells / 2, ..*settings };
                let coarse_cells = Cells::new(half.extent, half.cells);
                let coarse_walls = walls.on(&coarse_cells, steps);
                let coarse = Self::new(&half, (&coarse_cells, &coarse_walls), photons, None, progress)?;
                finer_scale((&coarse_cells, coarse.kernel.reached_later()), (cells, &ends[1].density))
            }
        };
        let spread = |side: usize, factor: &[f64], out: &mut [f64]| kernel.spread(side, factor, out);
        let tolerance = TOLERANCE / f64::from(settings.sweeps);
        scale_in_turn(&mut ends, (settings.sweeps(SWEEPS), tolerance, RELAXATION), spread, progress)?;
        let error = ends[0].error();
        let blur = (BLUR * BLUR / step).round().max(1.0) as usize;
        let variance = step * f64::from(cells.side).powi(2);
        Ok(Self { kernel, regions, ends: ends.map(|end| end.density), variance, blur, error })
    }

    /// The planned velocity of a side, and diffusion down the density over the planned one.
    fn side_velocities(
        &mut self,
        settings: &BridgeSettings,
        (cells, walls): (&Cells, &StandingWalls),
        (side, done): (usize, usize),
        photons: &[Vec2],
    ) -> Vec<Vec2> {
        let steps = settings.steps;
        let (step, at) = if side == 0 { (done, done) } else { (steps - 1 - done, steps - done) };
        let here = walls.of(side, done);
        let planned = match done {
            0 => self.ends[side].clone(),
            _ => self.kernel.density(at),
        };
        let light = gather(cells, here, photons);
        let mut blurred = [vec![0.0; cells.count()], vec![0.0; cells.count()]];
        for (density, out) in [light, planned].iter().zip(&mut blurred) {
            self.kernel.blur(step, self.blur, density, out);
        }
        let floor = floor(photons.len());
        let [light, planned] = &blurred;
        let per_time = self.variance * steps as f64;
        let diffusion = 0.5 * FEEDBACK * per_time;
        let excess: Vec<f64> = light
            .iter()
            .zip(planned)
            .map(|(light, planned)| ((light + floor) / (planned + floor)).ln())
            .collect();
        let per_step = if side == 0 { steps as f32 } else { -(steps as f32) };
        let back = gradients(cells, here, &excess);
        let next = if side == 0 { step + 1 } else { step.saturating_sub(1) };
        let alone = (walls.run_of(next) != walls.run_of(step)).then_some(side);
        let planned = self.kernel.velocity(step, cells, alone);
        planned.iter().zip(back).map(|(v, back)| per_step * *v - diffusion as f32 * back).collect()
    }
}

/// Share of the straight ways from photons of the earlier to photons of the later key frame that walls block.
fn blocked(walls: Option<&WallCells>, [earlier, later]: [&[Vec2]; 2]) -> f64 {
    let (Some(walls), false, false) = (walls, earlier.is_empty(), later.is_empty()) else { return 0.0 };
    let photon = |photons: &[Vec2], share: f64| photons[(share * photons.len() as f64) as usize];
    let is_blocked = |way: &usize| {
        // By the golden ratio, so that rows in some order do not pair neighbours; both ways around, so that exchanged key frames have
        // the same share.
        let number = (way / 2) as f64;
        let places = [2.0 * number / WAYS as f64, (number * GOLDEN_RATIO).fract()];
        let [from, to] = if way.is_multiple_of(2) { places } else { [places[1], places[0]] };
        walls.blocks(photon(earlier, from), photon(later, to))
    };
    (0..WAYS).filter(is_blocked).count() as f64 / WAYS as f64
}

/// Most light of each cell: `density` times that of the cells in which most of the light is, and in each at least its own at
/// the key frames.
fn cap(settings: &BridgeSettings, densities: [&[f64]; 2]) -> Vec<f64> {
    let typical = |density: &[f64]| {
        let mut sorted: Vec<f64> = density.iter().copied().filter(|d| *d > 0.0).collect();
        sorted.sort_unstable_by(f64::total_cmp);
        let mut sum = 0.0;
        let within = |d: &&f64| {
            sum += **d;
            sum <= CAP_SHARE
        };
        sorted.iter().take_while(within).last().copied().unwrap_or(1.0)
    };
    let [a, b] = densities;
    let most = typical(a).max(typical(b));
    a.iter().zip(b).map(|(a, b)| f64::from(settings.density) * a.max(*b).max(most)).collect()
}

/// The share of the light of each cell that is let stay in one step: less towards a wall, so that light fades there.
fn soft(settings: &BridgeSettings, cells: &Cells, walls: Option<&WallCells>) -> Vec<f64> {
    let Some(walls) = walls else { return vec![1.0; cells.count()] };
    let reach = REACH * f64::from(settings.hold);
    let per_step = SOFTNESS / settings.steps as f64;
    let share = |&distance: &f32| {
        let near = (1.0 - f64::from(distance) / reach).max(0.0);
        (-per_step * near * near).exp()
    };
    walls.distances().iter().map(share).collect()
}
