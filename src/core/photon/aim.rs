//! Where a light must shine to make caustics. Nearly all of its light misses the glass, or leaves it for elsewhere, so
//! photons are sent only where earlier ones came through.
//!
//! The rays from a light to one specular mesh are the unit square ([`Emission`]), area in proportion to flux. A quadtree over the
//! square learns which cells send photons to the receiver. Cells that do, with their neighbours, get candidates in
//! proportion to their flux, so their photons weigh the same. The others are not cut off, which would lose light: they get
//! a small share of the candidates, whose photons, if any, weigh more. Where the pilot run meets such a photon, its cell
//! joins the others.

use rayon::prelude::*;

use super::path::{Ledger, follow};
use crate::math::rng::{Purpose, Stream};
use crate::scene::light::{Ball, Emission};
use crate::scene::{Media, Ray, Scene};
use crate::{Progress, Result};

/// Highest rate of candidates in cells from which nothing was seen to land, against the others.
const RARE: f64 = 1.0 / 16.0;
/// Highest share of all candidates that goes to such cells.
const RARE_SHARE: f64 = 0.2;
/// Paths per level of the quadtree while learning, shared among its open cells, but so many per cell.
const LEVEL_PROBES: u64 = 16_384;
const CELL_PROBES: std::ops::RangeInclusive<u64> = 4..=64;
/// Where the first level saw nothing land, it looks again with this many times the paths.
const SECOND_LOOK: u64 = 16;
/// First level of the quadtree: 32 x 32 cells.
const FIRST_LEVEL: u32 = 5;
/// Last level, and how many cells may be open on one; fewer for scenes of many lights and targets.
const LAST_LEVEL: u32 = 10;
const MAX_OPEN: usize = 16_384;
/// Meshes aimed at one by one; more of them are aimed at together.
const MAX_TARGETS: usize = 16;
/// Pass number of the learning paths; no render reaches it.
const LEARNING: u64 = u64::MAX;

/// How far emission is narrowed. All have the same expectation; only their cost differs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Aim {
    /// All the light of every source.
    Nowhere,
    /// Towards the bounds of glass and mirrors.
    Bounds,
    /// To where earlier photons came through. The way to use.
    Learned,
}

/// The rays from one light that meet the ball around one target and none of the balls before it.
pub(super) struct Domain {
    pub light: u16,
    emission: Emission,
    /// Targets whose rays belong to other domains.
    before: Vec<Ball>,
    /// Whether glass may lie around the place where photons start.
    in_glass: bool,
}

impl Domain {
    /// The ray of a point of the square, and the glass it starts in; none if no photon leaves there.
    pub(super) fn sample(&self, scene: &Scene, u: [f32; 2], rng: &mut Stream) -> Option<(Ray, Media)> {
        let ray = self.emission.sample(u, rng)?;
        if self.before.iter().any(|ball| ball.meets(&ray)) {
            return None;
        }
        let media = if self.in_glass { scene.media_at(ray.origin) } else { Media::default() };
        Some((ray, media))
    }

    fn power(&self) -> f64 {
        self.emission.flux.as_dvec3().element_sum() / 3.0
    }
}

/// A cell of a domain's square, and what a candidate from it carries.
pub(super) struct Cell {
    pub domain: u32,
    pub corner: [f32; 2],
    pub size: f32,
    /// RGB flux of a photon [W] times the number of candidates.
    pub flux: glam::Vec3,
}

/// All cells of all lights and the share of the candidates each gets.
pub(super) struct Plan {
    pub domains: Vec<Domain>,
    pub cells: Vec<Cell>,
    /// Share of candidates up to and with each cell, rising to 1.
    pub cumulative: Vec<f64>,
    /// What the learning paths of each light met, for the message if nothing lands.
    pub ledgers: Vec<Ledger>,
    leaves: Vec<Leaf>,
}

/// A quadtree leaf while learning: level, column, row, and whether photons from it land.
struct Leaf {
    domain: u32,
    level: u32,
    at: [u32; 2],
    active: bool,
}

impl Plan {
    /// Learns where to shine. Deterministic in the seed.
    pub(super) fn new(scene: &Scene, aim: Aim, seed: u64, progress: &Progress) -> Result<Self> {
        let domains = domains(scene, aim);
        let mut ledgers = vec![Ledger::default(); scene.lights().len()];
        let mut leaves = Vec::new();
        progress.begin("aim", domains.len() as u64);
        for (index, domain) in domains.iter().enumerate() {
            let index = index as u32;
            let ledger = &mut ledgers[domain.light as usize];
            match aim {
                _ if domain.power() <= 0.0 => (),
                Aim::Nowhere | Aim::Bounds => {
                    leaves.push(Leaf { domain: index, level: 0, at: [0, 0], active: true });
                    probe(scene, domain, index, (FIRST_LEVEL, &all_cells(FIRST_LEVEL)), 1, seed, ledger);
                }
                Aim::Learned => {
                    let enough = MAX_OPEN / domains.len().clamp(1, 8);
                    learn(scene, domain, index, enough, seed, ledger, &mut leaves, progress)?;
                }
            }
            progress.advance(1);
        }
        Ok(Self::from_leaves(domains, leaves, ledgers))
    }

    fn from_leaves(domains: Vec<Domain>, mut leaves: Vec<Leaf>, ledgers: Vec<Ledger>) -> Self {
        // Neighbours in the square are neighbours in the list: their rays visit the same memory.
        leaves.sort_by_key(|leaf| (leaf.domain, morton(leaf.at.map(|x| x << (16 - leaf.level)))));
        let mut plan = Self { domains, cells: Vec::new(), cumulative: Vec::new(), ledgers, leaves };
        plan.allot();
        plan
    }

    /// Gives each leaf its share of the candidates.
    fn allot(&mut self) {
        let Self { domains, leaves, .. } = self;
        let power = |leaf: &Leaf| domains[leaf.domain as usize].power();
        let flux = |leaf: &Leaf| power(leaf) * 0.25_f64.powi(leaf.level as i32);
        let sum = |active| leaves.iter().filter(|leaf| leaf.active == active).map(flux).sum::<f64>();
        let (active, rest) = (sum(true), sum(false));
        let rare = match (active > 0.0, rest > 0.0) {
            (true, true) => RARE.min(RARE_SHARE / (1.0 - RARE_SHARE) * active / rest),
            (true, false) | (false, _) => 1.0,
        };
        let rate = |leaf: &Leaf| if leaf.active { 1.0 } else { rare };
        let total = active + rare * rest;
        let cell = |leaf: &Leaf| {
            let size = 0.5_f32.powi(leaf.level as i32);
            Cell {
                domain: leaf.domain,
                corner: leaf.at.map(|x| x as f32 * size),
                size,
                // flux x area / share of the candidates
                flux: domains[leaf.domain as usize].emission.flux
                    * (total / (power(leaf) * rate(leaf))) as f32,
            }
        };
        self.cells = leaves.iter().map(cell).collect();
        let mut below = 0.0;
        self.cumulative = leaves
            .iter()
            .map(|leaf| {
                below += flux(leaf) * rate(leaf) / total;
                below
            })
            .collect();
        self.cumulative.last_mut().into_iter().for_each(|last| *last = 1.0);
    }

    /// Makes those of the given cells active that were not: whether any was.
    pub(super) fn activate(&mut self, cells: &[u32]) -> bool {
        let mut changed = false;
        for cell in cells {
            let leaf = &mut self.leaves[*cell as usize];
            changed |= !leaf.active;
            leaf.active = true;
        }
        if changed {
            self.allot();
        }
        changed
    }
}

/// One domain for each light and target.
fn domains(scene: &Scene, aim: Aim) -> Vec<Domain> {
    let (lower, upper) = scene.bounds();
    let world = Ball::around(lower, upper);
    let specular = || scene.meshes().iter().filter(|mesh| mesh.material.is_specular());
    let mut targets: Vec<Ball> = specular().map(|mesh| mesh.ball()).collect();
    if targets.len() > MAX_TARGETS {
        let lower = specular().map(|mesh| mesh.lower).fold(lower, glam::Vec3::min);
        let upper = specular().map(|mesh| mesh.upper).fold(upper, glam::Vec3::max);
        targets = vec![Ball::around(lower, upper)];
    }
    let mut domains = Vec::new();
    for (light, desc) in scene.lights().iter().enumerate() {
        let in_glass = specular().any(|mesh| desc.touches(mesh.lower, mesh.upper));
        let domain = |target, before: &[Ball]| Domain {
            light: light as u16,
            emission: desc.emission(target, world),
            before: before.to_vec(),
            in_glass,
        };
        match aim {
            Aim::Nowhere => domains.push(domain(None, &[])),
            Aim::Bounds | Aim::Learned => {
                domains.extend((0..targets.len()).map(|i| domain(Some(targets[i]), &targets[..i])));
            }
        }
    }
    domains
}

fn all_cells(level: u32) -> Vec<[u32; 2]> {
    let side = 1_u32 << level;
    (0..side * side).map(|i| [i % side, i / side]).collect()
}

/// Refines the quadtree where photons land, level by level, until it has `enough` cells.
#[expect(clippy::too_many_arguments, reason = "one call; a struct would only rename them")]
fn learn(
    scene: &Scene,
    domain: &Domain,
    index: u32,
    enough: usize,
    seed: u64,
    ledger: &mut Ledger,
    leaves: &mut Vec<Leaf>,
    progress: &Progress,
) -> Result<()> {
    let mut open = all_cells(FIRST_LEVEL);
    for level in FIRST_LEVEL..=LAST_LEVEL {
        progress.check()?;
        let probes =
            (LEVEL_PROBES / open.len().max(1) as u64).clamp(*CELL_PROBES.start(), *CELL_PROBES.end());
        let mut landed = probe(scene, domain, index, (level, &open), probes, seed, ledger);
        if level == FIRST_LEVEL && !landed.contains(&true) && ledger.met_specular() {
            landed = probe(scene, domain, index, (level, &open), probes * SECOND_LOOK, seed, ledger);
        }
        let side = 1_usize << level;
        let mut map = vec![false; side * side];
        for ([x, y], landed) in open.iter().zip(&landed) {
            map[*y as usize * side + *x as usize] = *landed;
        }
        let activity: Vec<bool> = open.iter().map(|at| near_active(&map, side, *at)).collect();
        let refine = level < LAST_LEVEL && 4 * activity.iter().filter(|active| **active).count() <= enough;
        let mut next = Vec::new();
        for (at, active) in open.into_iter().zip(activity) {
            if active && refine {
                next.extend([[0, 0], [1, 0], [0, 1], [1, 1]].map(|[x, y]| [2 * at[0] + x, 2 * at[1] + y]));
            } else {
                leaves.push(Leaf { domain: index, level, at, active });
            }
        }
        if next.is_empty() {
            break;
        }
        open = next;
    }
    Ok(())
}

/// Whether the cell or one of its eight neighbours is active.
fn near_active(map: &[bool], side: usize, at: [u32; 2]) -> bool {
    let [x, y] = at.map(|a| a as usize);
    (y.saturating_sub(1)..=(y + 1).min(side - 1))
        .any(|row| map[row * side + x.saturating_sub(1)..=row * side + (x + 1).min(side - 1)].contains(&true))
}

/// Sends a few paths from each cell: whether any lands.
#[expect(clippy::too_many_arguments, reason = "two calls; a struct would only rename them")]
fn probe(
    scene: &Scene,
    domain: &Domain,
    index: u32,
    (level, cells): (u32, &[[u32; 2]]),
    probes: u64,
    seed: u64,
    ledger: &mut Ledger,
) -> Vec<bool> {
    let size = 0.5_f32.powi(level as i32);
    let results: Vec<(Vec<bool>, Ledger)> = cells
        .par_chunks(128)
        .map(|chunk| {
            let mut ledger = Ledger::default();
            let landed = chunk.iter().map(|[x, y]| {
                let cell = (u64::from(index) << 44)
                    | (u64::from(level) << 40)
                    | (u64::from(*y) << 20)
                    | u64::from(*x);
                let mut rng = Stream::new(seed, Purpose::Trace, LEARNING, cell);
                (0..probes).fold(false, |landed, _| {
                    let u = [(*x as f32 + rng.f32()) * size, (*y as f32 + rng.f32()) * size];
                    let start = domain.sample(scene, u, &mut rng);
                    landed
                        | start
                            .and_then(|(ray, media)| {
                                follow(scene, ray, domain.emission.flux, media, &mut rng, &mut ledger)
                            })
                            .is_some()
                })
            });
            (landed.collect(), ledger)
        })
        .collect();
    let mut landed = Vec::with_capacity(cells.len());
    for (part, more) in results {
        landed.extend(part);
        ledger.add(more);
    }
    landed
}

/// Interleaves the bits of column and row (Z order).
fn morton([x, y]: [u32; 2]) -> u64 {
    let spread = |v: u32| (0..16).fold(0_u64, |code, bit| code | (u64::from(v >> bit & 1) << (2 * bit)));
    spread(x) | spread(y) << 1
}
