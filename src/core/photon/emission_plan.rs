//! Emission guiding: importance sampling of the rays that lead to caustics. Nearly all light misses the glass, or leaves
//! it for elsewhere, so candidates are sent mostly where earlier photons reached the receiver.
//!
//! The rays from a light to one specular mesh (a caster) are parametrised by the unit square ([`Emission`](crate::scene::light::Emission)), area in
//! proportion to flux. A quadtree over the square learns which cells are active: they, or a neighbour, send photons to
//! the receiver. Active cells get candidates in proportion to their flux, so their photons have equal flux. The others
//! keep a small share of the candidates with more flux each, so that the estimate stays unbiased; where the pilot run
//! sees a photon land from one, that cell becomes active.

use super::domain::{Domain, EmissionGuiding, domains};
use super::guide_learner::{GuideLearner, Leaf};
use super::path::{FluxBalance, LightPart};
use super::window::Lesson;
use crate::scene::Scene;
use crate::{Progress, Result};

/// Highest rate of candidates in inactive cells, relative to active ones.
const INACTIVE_RATE: f64 = 1.0 / 16.0;
/// Highest share of all candidates in inactive cells.
const INACTIVE_SHARE: f64 = 0.2;
/// Most cells to be refined on one level of the quadtree; fewer for scenes of many lights and casters.
const MAX_OPEN: usize = 16_384;
/// A cell of a domain's square with the flux of its candidates.
#[derive(serde::Deserialize, serde::Serialize)]
pub(super) struct Cell {
    pub domain: u32,
    pub corner: [f32; 2],
    pub size: f32,
    /// RGB flux of a photon (W) times the number of candidates.
    pub flux: glam::Vec3,
    /// Flux of a photon over that of one from an active cell.
    pub factor: f32,
}

/// The cells of all lights with their shares of the candidates.
#[derive(serde::Deserialize, serde::Serialize)]
pub(super) struct EmissionPlan {
    pub domains: Vec<Domain>,
    pub cells: Vec<Cell>,
    /// Cumulative share of the candidates, up to and including each cell; ends at 1.
    pub cumulative: Vec<f64>,
    /// The flux balance of each light's trial paths, for the diagnosis if nothing lands.
    pub balances: Vec<FluxBalance>,
    leaves: Vec<Leaf>,
}

impl EmissionPlan {
    /// Learns the active cells, and the fate of the trial paths. Deterministic in the seed.
    pub(super) fn new(
        (scene, part): (&Scene, LightPart),
        guiding: EmissionGuiding,
        seed: u64,
        lesson: &mut Lesson,
        progress: &Progress,
    ) -> Result<Self> {
        let domains = domains(scene, guiding);
        let mut balances = vec![FluxBalance::default(); scene.lights().len()];
        let mut leaves = Vec::new();
        progress.begin("trace", domains.len() as u64);
        for (index, domain) in domains.iter().enumerate() {
            if domain.power() <= 0.0 {
                continue;
            }
            let balance = &mut balances[domain.light as usize];
            let index = index as u32;
            let mut learner = GuideLearner { scene, part, domain, index, seed, progress, balance, lesson };
            match guiding {
                EmissionGuiding::Unguided | EmissionGuiding::Bounds => {
                    learner.probe_once()?;
                    leaves.push(Leaf { domain: index, level: 0, at: [0, 0], active: true });
                }
                EmissionGuiding::Cells | EmissionGuiding::Learned => {
                    leaves.extend(learner.learn(MAX_OPEN / domains.len().clamp(1, 8))?);
                }
            }
            progress.advance(1);
        }
        Ok(Self::from_leaves(domains, leaves, balances))
    }

    fn from_leaves(domains: Vec<Domain>, mut leaves: Vec<Leaf>, balances: Vec<FluxBalance>) -> Self {
        // In Z order neighbours in the square are near in the list: their rays visit the same memory.
        leaves.sort_by_key(|leaf| (leaf.domain, morton(leaf.at.map(|x| x << (16 - leaf.level)))));
        let mut plan = Self { domains, cells: Vec::new(), cumulative: Vec::new(), balances, leaves };
        plan.allocate();
        plan
    }

    /// Allocates the candidates to the leaves.
    fn allocate(&mut self) {
        let Self { domains, leaves, .. } = self;
        let power = |leaf: &Leaf| domains[leaf.domain as usize].power();
        let flux = |leaf: &Leaf| power(leaf) * 0.25_f64.powi(leaf.level as i32);
        let sum = |active| leaves.iter().filter(|leaf| leaf.active == active).map(flux).sum::<f64>();
        let (active, rest) = (sum(true), sum(false));
        let rare = match (active > 0.0, rest > 0.0) {
            (true, true) => INACTIVE_RATE.min(INACTIVE_SHARE / (1.0 - INACTIVE_SHARE) * active / rest),
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
                factor: (1.0 / rate(leaf)) as f32,
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

    /// Activates the given cells; whether any was inactive.
    pub(super) fn activate(&mut self, cells: &[u32]) -> bool {
        let mut changed = false;
        for cell in cells {
            let leaf = &mut self.leaves[*cell as usize];
            changed |= !leaf.active;
            leaf.active = true;
        }
        if changed {
            self.allocate();
        }
        changed
    }
}

/// Interleaves the bits of column and row (Z order).
fn morton([x, y]: [u32; 2]) -> u64 {
    let spread = |v: u32| (0..16).fold(0_u64, |code, bit| code | (u64::from(v >> bit & 1) << (2 * bit)));
    spread(x) | spread(y) << 1
}
