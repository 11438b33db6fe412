//! Distances to the nearest wall, on a grid.

use glam::Vec2;
use rayon::prelude::*;

use crate::bridge::Cells;
use crate::constraint::barrier::Barriers;

/// Cells along the plane's longer side.
const CELLS: usize = 192;

/// The distance to the nearest wall all over the plane, at the centres of cells.
pub(crate) struct Clearance {
    cells: Cells,
    extent: Vec2,
    distances: Vec<f32>,
}

impl Clearance {
    pub(crate) fn new(barriers: &Barriers, extent: Vec2) -> Self {
        let cells = Cells::new(extent, CELLS);
        let distance = |cell: usize| barriers.distance(cells.centre(cell));
        let distances = (0..cells.count()).into_par_iter().map(distance).collect();
        Self { cells, extent, distances }
    }

    /// A distance within which no wall is, up to a cell's diagonal less than that to the nearest; 0 next to one.
    #[inline]
    pub(crate) fn at_least(&self, p: Vec2) -> f32 {
        let within = p.clamp(Vec2::ZERO, self.extent);
        // Distances change by no more than the way: from the centre of a cell by half its diagonal.
        let away = std::f32::consts::FRAC_1_SQRT_2 * self.cells.side + p.distance(within);
        (self.distances[self.cells.holding(within)] - away).max(0.0)
    }

    /// The distance from `p` to the nearest wall, plane units, exact to a fraction of a cell; beyond the plane a lower bound.
    #[inline]
    pub(crate) fn at(&self, p: Vec2) -> f32 {
        let within = p.clamp(Vec2::ZERO, self.extent);
        self.cells.single_value(&self.distances, within) - p.distance(within)
    }
}
