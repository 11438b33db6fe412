//! The learning of the emission guide: a quadtree over one domain, refined where trial paths reach the receiver.

use rayon::prelude::*;

use super::domain::Domain;
use super::path::{FluxBalance, LightPart, Watch as _, follow};
use super::window::{Lesson, Recorder, Trails};
use crate::math::rng::{Purpose, Stream};
use crate::scene::Scene;
use crate::{Progress, Result};

/// Trial paths per level of the quadtree, shared among its open cells, and the bounds per cell.
const LEVEL_PROBES: u64 = 16_384;
const CELL_PROBES: std::ops::RangeInclusive<u64> = 4..=64;
/// Factor on the paths of a second attempt, where nothing landed on the first level.
const SECOND_LOOK: u64 = 16;
/// First and last level of the quadtree; the first has 32 x 32 cells.
const FIRST_LEVEL: u32 = 5;
const LAST_LEVEL: u32 = 10;
/// Random-stream pass number of the trial paths; no render reaches it.
const LEARNING: u64 = u64::MAX;

/// A leaf of the quadtree over one domain.
#[derive(serde::Deserialize, serde::Serialize)]
pub(super) struct Leaf {
    pub domain: u32,
    /// Depth: the domain has 2^level x 2^level cells of this size.
    pub level: u32,
    /// Column and row.
    pub at: [u32; 2],
    /// Whether photons from it or a neighbour reached the receiver.
    pub active: bool,
}

/// The trial paths of one domain.
pub(super) struct GuideLearner<'a> {
    pub scene: &'a Scene,
    pub part: LightPart,
    pub domain: &'a Domain,
    /// Index of the domain.
    pub index: u32,
    pub seed: u64,
    pub progress: &'a Progress,
    /// The flux balance of the trial paths.
    pub balance: &'a mut FluxBalance,
    /// What is learnt of their fate.
    pub lesson: &'a mut Lesson,
}

impl GuideLearner<'_> {
    /// Fills the balance by a few paths, without refining.
    pub(super) fn probe_once(&mut self) -> Result<()> {
        self.probe(FIRST_LEVEL, &all_cells(FIRST_LEVEL), *CELL_PROBES.start()).map(|_| ())
    }

    /// Refines where photons land, level by level, while at most `max_open` cells are open.
    pub(super) fn learn(&mut self, max_open: usize) -> Result<Vec<Leaf>> {
        let mut leaves = Vec::new();
        let mut open = all_cells(FIRST_LEVEL);
        let mut level = FIRST_LEVEL;
        while !open.is_empty() {
            let probes = (LEVEL_PROBES / open.len() as u64).clamp(*CELL_PROBES.start(), *CELL_PROBES.end());
            let mut landed = self.probe(level, &open, probes)?;
            if level == FIRST_LEVEL && !landed.contains(&true) && self.balance.met_specular() {
                landed = self.probe(level, &open, probes * SECOND_LOOK)?;
            }
            let active = with_neighbours(level, &open, &landed);
            let refine =
                level < LAST_LEVEL && 4 * active.iter().filter(|active| **active).count() <= max_open;
            let mut next = Vec::new();
            for (at, active) in open.into_iter().zip(active) {
                if active && refine {
                    next.extend(
                        [[0, 0], [1, 0], [0, 1], [1, 1]].map(|[x, y]| [2 * at[0] + x, 2 * at[1] + y]),
                    );
                } else {
                    leaves.push(Leaf { domain: self.index, level, at, active });
                }
            }
            open = next;
            level += 1;
        }
        Ok(leaves)
    }

    /// Traces `probes` paths from each cell; whether any lands.
    fn probe(&mut self, level: u32, cells: &[[u32; 2]], probes: u64) -> Result<Vec<bool>> {
        let results: Vec<(Vec<bool>, FluxBalance, Trails)> = cells
            .par_chunks(128)
            .map(|chunk| {
                let mut balance = FluxBalance::default();
                let mut recorder = Recorder::new(self.lesson.cells);
                let landed = chunk.iter().map(|at| {
                    self.progress.check()?;
                    Ok(self.any_lands((level, *at), probes, &mut recorder, &mut balance))
                });
                Ok((landed.collect::<Result<_>>()?, balance, recorder.trails))
            })
            .collect::<Result<_>>()?;
        for (_, balance, trails) in &results {
            self.balance.add(*balance);
            self.lesson.add(trails);
        }
        Ok(results.into_iter().flat_map(|(landed, ..)| landed).collect())
    }

    fn any_lands(
        &self,
        (level, at): (u32, [u32; 2]),
        probes: u64,
        recorder: &mut Recorder,
        balance: &mut FluxBalance,
    ) -> bool {
        let size = 0.5_f32.powi(level as i32);
        let [x, y] = at.map(u64::from);
        let cell = (u64::from(self.index) << 44) | (u64::from(level) << 40) | (y << 20) | x;
        let mut rng = Stream::new(self.seed, Purpose::Trace, LEARNING, cell);
        let light = self.domain.emission.flux;
        let mut any = false;
        for _ in 0..probes {
            let u = at.map(|index| (index as f32 + rng.f32()) * size);
            if let Some((ray, media)) = self.domain.sample(self.scene, u, &mut rng) {
                let scene = (self.scene, self.part);
                let landed = follow(scene, ray, (light, media), recorder, &mut rng, balance).is_some();
                recorder.ends(landed);
                any |= landed;
            }
        }
        any
    }
}

fn all_cells(level: u32) -> Vec<[u32; 2]> {
    let side = 1_u32 << level;
    (0..side * side).map(|i| [i % side, i / side]).collect()
}

/// For each cell, whether a photon landed from it or one of its eight neighbours.
fn with_neighbours(level: u32, cells: &[[u32; 2]], landed: &[bool]) -> Vec<bool> {
    let side = 1_usize << level;
    let mut map = vec![false; side * side];
    for ([x, y], landed) in cells.iter().zip(landed) {
        map[*y as usize * side + *x as usize] = *landed;
    }
    let near = |at: usize| at.saturating_sub(1)..=(at + 1).min(side - 1);
    let active = |[x, y]: &[u32; 2]| {
        near(*y as usize).any(|row| near(*x as usize).any(|column| map[row * side + column]))
    };
    cells.iter().map(active).collect()
}
