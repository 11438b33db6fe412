//! A weight window: paths that hardly ever land are ended early, and the few that survive carry their flux (Booth & Hendricks
//! 1984). Light trapped by total reflection in a wall or a stem takes half of all rays and lands one photon in a hundred.
//!
//! The window is learnt from whole paths: how often a ray that leaves a part of the surface in about this direction still
//! lands, and how many rays that takes. The less likely and the more costly, the more flux a path should have there. Any
//! window leaves the estimate unbiased.

use glam::Vec3;

use super::path::{Carried, FluxBalance, Watch};
use crate::math::rng::Stream;
use crate::scene::Ray;

/// Directions along each axis of the octahedral map, and in all.
const SIDE: usize = 16;
const DIRECTIONS: usize = SIDE * SIDE;
/// Most parts of the surface: the table fits into the second-level cache.
const MOST_PARTS: usize = 8192;
/// Most flux of a path over that of one that was not ended early.
const MOST: f32 = 16.0;
/// Exponent of the flux of a path over its merit. 1/2 is best where photons keep unequal flux; being drawn by flux makes
/// unequal ones worth less, and 0.35 lands the most photons of equal worth for a ray (2 to 7 % more than 1/2 in two glasses).
const EXPONENT: f32 = 0.35;
/// Steps of the table from a flux to its double.
const STEPS: f32 = 8.0;
/// Steps up to `MOST`.
const STEPS_TO_MOST: usize = 32;
/// Paths by which a coarser cell counts in a finer one.
const PRIOR: f32 = 4.0;
/// Least probability of landing: none that was seen is not none.
const LEAST: f32 = 1e-4;

/// The cells of surface and direction: neighbouring triangles together, and directions by an octahedral map.
#[derive(Clone, Copy, Debug, PartialEq, serde::Deserialize, serde::Serialize)]
pub(super) struct Cells {
    /// Triangles of a part, as a power of 2: those of a leaf of the hierarchy, or of several.
    shift: u32,
    parts: usize,
}

impl Cells {
    /// Cells over this many triangles.
    pub(super) fn new(triangles: usize) -> Self {
        let mut shift = 3;
        while triangles >> shift >= MOST_PARTS {
            shift += 1;
        }
        Self { shift, parts: (triangles >> shift) + 1 }
    }

    fn count(self) -> usize {
        self.parts * DIRECTIONS
    }

    /// The cell of a ray that leaves a mesh.
    #[inline]
    fn of(self, ray: &Ray) -> usize {
        let part = (ray.from.index() as usize >> self.shift).min(self.parts - 1);
        part * DIRECTIONS + octahedral(ray.direction)
    }
}

/// The cell of a unit vector on the octahedral map.
#[inline]
fn octahedral(v: Vec3) -> usize {
    let a = v.abs();
    let scale = 1.0 / (a.x + a.y + a.z);
    let (x, y) = (v.x * scale, v.y * scale);
    let (x, y) = if v.z >= 0.0 { (x, y) } else { ((1.0 - y.abs()).copysign(x), (1.0 - x.abs()).copysign(y)) };
    let cell = |x: f32| (((x + 1.0) * (SIDE as f32 / 2.0)) as usize).min(SIDE - 1);
    cell(y) * SIDE + cell(x)
}

/// The cells that paths came by.
#[derive(Default)]
pub(super) struct Trails {
    cells: Vec<u32>,
    /// Where each path ends among the cells, and whether it landed.
    paths: Vec<(u32, bool)>,
}

/// Writes down the cells of a path.
pub(super) struct Recorder {
    pub(super) cells: Cells,
    pub(super) trails: Trails,
}

impl Recorder {
    pub(super) fn new(cells: Cells) -> Self {
        Self { cells, trails: Trails::default() }
    }
}

impl Watch for Recorder {
    fn goes_on(&mut self, ray: &Ray, _: Carried, _: &mut Stream, _: &mut FluxBalance) -> bool {
        self.trails.cells.push(self.cells.of(ray) as u32);
        true
    }

    fn ends(&mut self, landed: bool) {
        self.trails.paths.push((self.trails.cells.len() as u32, landed));
    }
}

/// The fate of the rays of a cell.
#[derive(Clone, Copy, Default)]
struct Tally {
    /// Paths that came by, once for each time.
    visits: u32,
    /// Those that landed.
    landed: u32,
    /// Rays from here on.
    rays: u32,
}

impl Tally {
    fn add(&mut self, other: Self) {
        self.visits = self.visits.saturating_add(other.visits);
        self.landed = self.landed.saturating_add(other.landed);
        self.rays = self.rays.saturating_add(other.rays);
    }

    /// Probability of landing and rays from here on, where `before` is known of a coarser cell.
    fn means(&self, before: [f32; 2]) -> [f32; 2] {
        let mean = |sum: u32, before: f32| (sum as f32 + PRIOR * before) / (self.visits as f32 + PRIOR);
        [mean(self.landed, before[0]), mean(self.rays, before[1])]
    }
}

/// What was seen of the paths of a scene.
pub(super) struct Lesson {
    pub(super) cells: Cells,
    tallies: Vec<Tally>,
}

impl Lesson {
    pub(super) fn new(cells: Cells) -> Self {
        Self { cells, tallies: vec![Tally::default(); cells.count()] }
    }

    /// Adds the paths of some trails.
    pub(super) fn add(&mut self, trails: &Trails) {
        let mut start = 0;
        for (end, landed) in &trails.paths {
            let path = &trails.cells[start..*end as usize];
            let of = |rays: usize| Tally { visits: 1, landed: u32::from(*landed), rays: rays as u32 };
            path.iter()
                .enumerate()
                .for_each(|(k, cell)| self.tallies[*cell as usize].add(of(path.len() - k)));
            start = *end as usize;
        }
    }

    /// The window that these paths teach, from coarse cells to fine ones. `start` are the probability of landing and the
    /// rays of a whole path.
    pub(super) fn window(&self, start: [f32; 2]) -> Window {
        let (coarse, middle) = (self.coarsened(64, 4), self.coarsened(8, 2));
        let wanted = |(cell, tally): (usize, &Tally)| {
            let at = |parts: usize, directions: usize| self.coarse_cell(cell, parts, directions);
            let before = coarse[at(64, 4)].means(start);
            let [landed, rays] = tally.means(middle[at(8, 2)].means(before));
            let merit = (start[0] / start[1]) / (landed.max(LEAST) / rays);
            (STEPS * merit.powf(EXPONENT).clamp(1.0, MOST).log2()).round() as u8
        };
        Window {
            cells: self.cells,
            steps: self.tallies.iter().enumerate().map(wanted).collect(),
            factors: (0..=STEPS_TO_MOST).map(|step| (step as f32 / STEPS).exp2()).collect(),
        }
    }

    /// The cell of the coarser map of so many parts and of so many directions along each axis that holds a cell.
    fn coarse_cell(&self, cell: usize, parts: usize, directions: usize) -> usize {
        let side = SIDE / directions;
        let (part, direction) = (cell / DIRECTIONS, cell % DIRECTIONS);
        let (row, column) = (direction / SIDE / directions, direction % SIDE / directions);
        (part / parts * side + row) * side + column
    }

    fn coarsened(&self, parts: usize, directions: usize) -> Vec<Tally> {
        let side = SIDE / directions;
        let mut coarse = vec![Tally::default(); self.cells.parts.div_ceil(parts) * side * side];
        for (cell, tally) in self.tallies.iter().enumerate() {
            coarse[self.coarse_cell(cell, parts, directions)].add(*tally);
        }
        coarse
    }
}

/// The flux that a path should have in each cell, over that of one that was not ended early.
#[derive(serde::Deserialize, serde::Serialize)]
pub(super) struct Window {
    cells: Cells,
    /// By cell, in eighths of a power of 2.
    steps: Vec<u8>,
    /// The flux of each step.
    factors: Vec<f32>,
}

/// Holds paths to a window.
pub(super) struct Gate<'a> {
    window: &'a Window,
    /// Flux of the path over that of one from an active cell that was not ended early.
    factor: f32,
}

impl<'a> Gate<'a> {
    pub(super) fn new(window: &'a Window) -> Self {
        Self { window, factor: 1.0 }
    }
}

impl Watch for Gate<'_> {
    fn starts(&mut self, factor: f32) {
        self.factor = factor;
    }

    #[inline]
    fn goes_on(&mut self, ray: &Ray, light: Carried, rng: &mut Stream, balance: &mut FluxBalance) -> bool {
        let Window { cells, steps, factors } = self.window;
        let wanted = factors[usize::from(steps[cells.of(ray)])];
        if wanted <= self.factor {
            return true;
        }
        let kept = self.factor / wanted;
        let before = *light.weight;
        let goes_on = rng.f32() < kept;
        if goes_on {
            self.factor = wanted;
            *light.weight /= kept;
            *light.flux /= kept;
        } else {
            *light.weight = Vec3::ZERO;
        }
        balance.ended += (before - *light.weight).as_dvec3();
        goes_on
    }
}
