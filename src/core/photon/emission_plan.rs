//! Emission guiding: importance sampling of the rays that lead to caustics. Nearly all light misses the glass, or leaves
//! it for elsewhere, so candidates are sent mostly where earlier photons reached the receiver.
//!
//! The rays from a light to one specular mesh (a caster) are parametrised by the unit square ([`Emission`]), area in
//! proportion to flux. A quadtree over the square learns which cells are active: they, or a neighbour, send photons to
//! the receiver. Active cells get candidates in proportion to their flux, so their photons have equal flux. The others
//! keep a small share of the candidates with more flux each, so that the estimate stays unbiased; where the pilot run
//! sees a photon land from one, that cell becomes active.

use super::guide_learner::{GuideLearner, Leaf};
use super::path::FluxBalance;
use crate::math::rng::Stream;
use crate::scene::light::{Emission, Sphere};
use crate::scene::{Media, Ray, Scene};
use crate::{Progress, Result};

/// Highest rate of candidates in inactive cells, relative to active ones.
const INACTIVE_RATE: f64 = 1.0 / 16.0;
/// Highest share of all candidates in inactive cells.
const INACTIVE_SHARE: f64 = 0.2;
/// Most cells to be refined on one level of the quadtree; fewer for scenes of many lights and casters.
const MAX_OPEN: usize = 16_384;
/// Most casters with bounding spheres of their own; more of them share one.
const MAX_CASTERS: usize = 16;

/// How emission is importance-sampled. All have the same expectation; only their cost differs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EmissionGuiding {
    /// All the light of every source.
    Unguided,
    /// Towards the bounding spheres of glass and mirrors.
    Bounds,
    /// By the cells from which trial photons reached the receiver; the default.
    Learned,
}

/// The rays from one light that meet the bounding sphere of one caster and none of the spheres before it.
pub(super) struct Domain {
    pub light: u16,
    pub emission: Emission,
    /// Spheres whose rays belong to other domains.
    before: Vec<Sphere>,
    /// Whether photons may start inside glass.
    in_glass: bool,
}

impl Domain {
    /// The ray of a point of the square and the glass it starts in; none if no photon leaves there.
    pub(super) fn sample(&self, scene: &Scene, u: [f32; 2], rng: &mut Stream) -> Option<(Ray, Media)> {
        let ray = self.emission.sample(u, rng)?;
        if self.before.iter().any(|sphere| sphere.intersects(&ray)) {
            return None;
        }
        let media = if self.in_glass { scene.media_at(ray.origin) } else { Media::default() };
        Some((ray, media))
    }

    fn power(&self) -> f64 {
        self.emission.flux.as_dvec3().element_sum() / 3.0
    }
}

/// A cell of a domain's square with the flux of its candidates.
pub(super) struct Cell {
    pub domain: u32,
    pub corner: [f32; 2],
    pub size: f32,
    /// RGB flux of a photon (W) times the number of candidates.
    pub flux: glam::Vec3,
}

/// The cells of all lights with their shares of the candidates.
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
    /// Learns the active cells. Deterministic in the seed.
    pub(super) fn new(
        scene: &Scene,
        guiding: EmissionGuiding,
        seed: u64,
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
            let mut learner = GuideLearner { scene, domain, index: index as u32, seed, progress, balance };
            match guiding {
                EmissionGuiding::Unguided | EmissionGuiding::Bounds => {
                    learner.probe_once()?;
                    leaves.push(Leaf { domain: index as u32, level: 0, at: [0, 0], active: true });
                }
                EmissionGuiding::Learned => {
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

/// The domains: one for each light and caster.
fn domains(scene: &Scene, guiding: EmissionGuiding) -> Vec<Domain> {
    let (lower, upper) = scene.bounds();
    let world = Sphere::around_box(lower, upper);
    let specular = || scene.meshes().iter().filter(|mesh| mesh.material.is_specular());
    let mut casters: Vec<Sphere> = specular().map(|mesh| mesh.bounding_sphere()).collect();
    if casters.len() > MAX_CASTERS {
        let lower = specular().map(|mesh| mesh.lower).fold(lower, glam::Vec3::min);
        let upper = specular().map(|mesh| mesh.upper).fold(upper, glam::Vec3::max);
        casters = vec![Sphere::around_box(lower, upper)];
    }
    let mut domains = Vec::new();
    for (light, desc) in scene.lights().iter().enumerate() {
        let in_glass = specular().any(|mesh| desc.overlaps_box(mesh.lower, mesh.upper));
        let domain = |target, before: &[Sphere]| Domain {
            light: light as u16,
            emission: desc.emission(target, world),
            before: before.to_vec(),
            in_glass,
        };
        match guiding {
            EmissionGuiding::Unguided => domains.push(domain(None, &[])),
            EmissionGuiding::Bounds | EmissionGuiding::Learned => {
                domains.extend((0..casters.len()).map(|i| domain(Some(casters[i]), &casters[..i])));
            }
        }
    }
    domains
}

/// Interleaves the bits of column and row (Z order).
fn morton([x, y]: [u32; 2]) -> u64 {
    let spread = |v: u32| (0..16).fold(0_u64, |code, bit| code | (u64::from(v >> bit & 1) << (2 * bit)));
    spread(x) | spread(y) << 1
}
