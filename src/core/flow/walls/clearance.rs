//! Distances to the nearest wall, on a grid.

use glam::Vec2;
use rayon::prelude::*;

use crate::bridge::Cells;
use crate::constraint::barrier::Barriers;

/// Cells along the plane's longer side.
const CELLS: usize = 192;

/// The distance to the nearest wall all over the plane, between the centres of cells: exact to a fraction of a cell.
pub(crate) struct Clearance {
    cells: Cells,
    extent: Vec2,
    distances: Vec<f64>,
}

impl Clearance {
    pub(crate) fn new(barriers: &Barriers, extent: Vec2) -> Self {
        let cells = Cells::new(extent, CELLS);
        let distance = |cell: usize| f64::from(barriers.distance(cells.centre(cell)));
        let distances = (0..cells.count()).into_par_iter().map(distance).collect();
        Self { cells, extent, distances }
    }

    /// A distance within which no wall is, whatever lies between the centres of cells; 0 next to one.
    pub(crate) fn at_least(&self, p: Vec2) -> f32 {
        // Distances change by no more than the way: between two centres by half the diagonal.
        (self.at(p) - std::f32::consts::FRAC_1_SQRT_2 * self.cells.side).max(0.0)
    }

    /// The distance from `p` to the nearest wall, plane units; beyond the plane a lower bound.
    pub(crate) fn at(&self, p: Vec2) -> f32 {
        let within = p.clamp(Vec2::ZERO, self.extent);
        self.cells.value(&self.distances, within) as f32 - p.distance(within)
    }
}
