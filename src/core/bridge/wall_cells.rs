//! What the cells of a plan see of each other where walls stand.

use glam::Vec2;
use rayon::prelude::*;

use super::cells::Cells;
use super::settings::WallsFrom;
use super::sight::Sight;
use crate::constraint::barrier::Barriers;

/// Cells from a wall up to which sight is tested.
const NEAR: f32 = 2.5;
/// Weight of a visible cell beside its bilinear one: a point whose nearest cell is hidden keeps a value.
const LEAST_WEIGHT: f32 = 1e-6;

/// The walls at one moment as cells see them.
pub(super) struct WallCells<'a> {
    pub(super) cells: Cells,
    barriers: &'a Barriers,
    /// From the centre of each cell to the nearest wall, plane units.
    distances: Vec<f32>,
    /// Whether a cell sees the next one along x and along y.
    open: Vec<[bool; 2]>,
    sight: Sight,
}

impl<'a> WallCells<'a> {
    pub(super) fn new(cells: &Cells, barriers: &'a Barriers) -> Self {
        let [width, height] = cells.size;
        let centre = |i: usize| cells.centre(i);
        let distances: Vec<f32> =
            (0..cells.count()).into_par_iter().map(|i| barriers.distance(centre(i))).collect();
        let sees =
            |i: usize, j: usize| distances[i] >= NEAR * cells.side || !barriers.blocks(centre(i), centre(j));
        let faces = |i: usize| {
            [i % width + 1 < width && sees(i, i + 1), i / width + 1 < height && sees(i, i + width)]
        };
        let open = (0..cells.count()).into_par_iter().map(faces).collect();
        Self { cells: cells.clone(), barriers, distances, open, sight: Sight::new(cells, barriers) }
    }

    /// The walls.
    pub(super) fn barriers(&self) -> &'a Barriers {
        self.barriers
    }

    /// Whether a wall may lie within some cells of cell `index`.
    pub(super) fn near(&self, index: usize) -> bool {
        self.distances[index] < NEAR * self.cells.side
    }

    /// From the centre of each cell to the nearest wall, plane units.
    pub(super) fn distances(&self) -> &[f32] {
        &self.distances
    }

    /// Whether the straight line between two points meets a wall.
    pub(super) fn blocks(&self, a: Vec2, b: Vec2) -> bool {
        self.barriers.blocks(a, b)
    }

    /// Whether a cell sees the next along `axis`, 0 or 1.
    pub(super) fn open(&self, index: usize, axis: usize) -> bool {
        self.open[index][axis]
    }

    /// The cells around a point that it sees, with weights of sum 1; of sum 0 where it sees none.
    pub(super) fn around(&self, p: Vec2) -> [(usize, f32); 4] {
        let mut around = self.cells.around(p);
        if self.sight.is_open(around[0].0) {
            return around;
        }
        for (cell, weight) in &mut around {
            let hidden = self.barriers.blocks(p, self.cells.centre(*cell));
            *weight = if hidden { 0.0 } else { *weight + LEAST_WEIGHT };
        }
        let total: f32 = around.iter().map(|(_, weight)| weight).sum();
        if total > 0.0 {
            around.iter_mut().for_each(|(_, weight)| *weight /= total);
            return around;
        }
        let nearest = self.nearest_visible(p);
        [
            (nearest.unwrap_or(around[0].0), if nearest.is_some() { 1.0 } else { 0.0 }),
            around[1],
            around[2],
            around[3],
        ]
    }

    /// The nearest cell that a point sees, among 6 x 6 around it.
    fn nearest_visible(&self, p: Vec2) -> Option<usize> {
        let [width, height] = self.cells.size;
        let corner = self.cells.place(p).index;
        let (column, row) = (corner % width, corner / width);
        let rows = row.saturating_sub(2)..(row + 4).min(height);
        let all = rows
            .flat_map(|y| (column.saturating_sub(2)..(column + 4).min(width)).map(move |x| y * width + x));
        let distance = |&cell: &usize| self.cells.centre(cell).distance_squared(p);
        all.filter(|&cell| !self.barriers.blocks(p, self.cells.centre(cell)))
            .min_by(|a, b| distance(a).total_cmp(&distance(b)))
    }
}

/// The walls over the steps of a plan.
pub(super) struct StandingWalls<'a> {
    steps: usize,
    /// The walls with the first step in which they stand.
    runs: Vec<(usize, Option<WallCells<'a>>)>,
}

impl<'a> StandingWalls<'a> {
    pub(super) fn new(cells: &Cells, steps: usize, walls: &[WallsFrom<'a>]) -> Self {
        let first_step = |time: f64| (time * steps as f64).round() as usize;
        let run = |from: &WallsFrom<'a>| {
            (first_step(from.time), from.barriers.map(|barriers| WallCells::new(cells, barriers)))
        };
        Self { steps, runs: walls.iter().map(run).collect() }
    }

    /// The same walls on other cells.
    pub(super) fn on(&self, cells: &Cells, steps: usize) -> Self {
        let walls: Vec<WallsFrom> = self
            .runs
            .iter()
            .map(|(step, walls)| WallsFrom {
                time: *step as f64 / self.steps as f64,
                barriers: walls.as_ref().map(WallCells::barriers),
            })
            .collect();
        Self::new(cells, steps, &walls)
    }

    /// Whether any wall stands at any time.
    pub(super) fn any(&self) -> bool {
        self.runs.iter().any(|(_, walls)| walls.is_some())
    }

    /// The walls of each run of steps in which the same ones stand.
    pub(super) fn runs(&self) -> impl Iterator<Item = Option<&WallCells<'a>>> {
        self.runs.iter().map(|(_, walls)| walls.as_ref())
    }

    /// The number of the run in which a step is.
    pub(super) fn run_of(&self, step: usize) -> usize {
        self.runs.partition_point(|(first, _)| *first <= step).saturating_sub(1)
    }

    /// The walls that stand around the light of `side` (0 earlier, 1 later) in the step after `done` steps of both.
    pub(super) fn of(&self, side: usize, done: usize) -> Option<&WallCells<'a>> {
        let step = if side == 0 { done } else { self.steps - 1 - done };
        self.runs.get(self.run_of(step))?.1.as_ref()
    }
}
