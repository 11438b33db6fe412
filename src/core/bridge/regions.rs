//! The regions between which light can pass, and what walls shut off.

use super::cells::Cells;
use super::wall_cells::{StandingWalls, WallCells};

/// Groups of cells that light can reach from each other over the whole time, by the cells of the earlier and of the later
/// key frame.
#[derive(Clone)]
pub(super) struct Regions {
    /// Group of each cell at the begin and at the end.
    groups: [Vec<u32>; 2],
    count: usize,
    shut_off: [f64; 2],
}

impl Regions {
    /// The regions between `walls`; `densities` at both key frames.
    pub(super) fn new(cells: &Cells, walls: &StandingWalls, densities: [&[f64]; 2]) -> Self {
        // A node for each connected part of each run of steps; runs join where they share a cell.
        let parts: Vec<Vec<u32>> = walls.runs().map(|walls| connected(cells, walls)).collect();
        let counts: Vec<usize> =
            parts.iter().map(|part| 1 + part.iter().copied().max().unwrap_or(0) as usize).collect();
        let starts: Vec<usize> =
            counts.iter().scan(0, |sum, count| Some(std::mem::replace(sum, *sum + count))).collect();
        let mut join = Join::new(counts.iter().sum());
        for run in 1..parts.len() {
            for cell in 0..cells.count() {
                join.join(
                    starts[run - 1] + parts[run - 1][cell] as usize,
                    starts[run] + parts[run][cell] as usize,
                );
            }
        }
        let last = parts.len() - 1;
        let mut groups = [0, last].map(|run| {
            parts[run].iter().map(|&part| join.root(starts[run] + part as usize) as u32).collect::<Vec<_>>()
        });
        let mut roots: Vec<u32> = groups.iter().flatten().copied().collect();
        roots.sort_unstable();
        roots.dedup();
        for group in groups.iter_mut().flatten() {
            *group = roots.partition_point(|root| root < group) as u32;
        }
        let mut regions = Self { groups, count: roots.len(), shut_off: [0.0; 2] };
        let [a, b] = [0, 1].map(|side| regions.light(side, densities[side]));
        let excess = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).max(0.0)).sum::<f64>();
        regions.shut_off = [excess(&a, &b), excess(&b, &a)];
        regions
    }

    pub(super) fn shut_off(&self) -> [f64; 2] {
        self.shut_off
    }

    fn light(&self, side: usize, density: &[f64]) -> Vec<f64> {
        let mut light = vec![0.0; self.count];
        density.iter().zip(&self.groups[side]).for_each(|(density, &group)| light[group as usize] += density);
        light
    }

    /// Scales the later light so that each region has as much of it as of the earlier one.
    pub(super) fn balance(&self, earlier: &[f64], later: &mut [f64]) {
        let (a, b) = (self.light(0, earlier), self.light(1, later));
        for (density, &group) in later.iter_mut().zip(&self.groups[1]) {
            let there = b[group as usize];
            *density *= if there > 0.0 { a[group as usize] / there } else { 0.0 };
        }
    }
}

/// The connected part of each cell, counted from 0.
fn connected(cells: &Cells, walls: Option<&WallCells>) -> Vec<u32> {
    let Some(walls) = walls else { return vec![0; cells.count()] };
    let [width, _] = cells.size;
    let mut join = Join::new(cells.count());
    for cell in 0..cells.count() {
        for (axis, stride) in [(0, 1), (1, width)] {
            if walls.open(cell, axis) {
                join.join(cell, cell + stride);
            }
        }
    }
    let roots: Vec<usize> = (0..cells.count()).map(|cell| join.root(cell)).collect();
    let mut sorted = roots.clone();
    sorted.sort_unstable();
    sorted.dedup();
    roots.iter().map(|root| sorted.partition_point(|other| other < root) as u32).collect()
}

/// Disjoint sets.
struct Join(Vec<usize>);

impl Join {
    fn new(count: usize) -> Self {
        Self((0..count).collect())
    }

    fn root(&mut self, mut node: usize) -> usize {
        while self.0[node] != node {
            self.0[node] = self.0[self.0[node]];
            node = self.0[node];
        }
        node
    }

    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        self.0[a.max(b)] = a.min(b);
    }
}
