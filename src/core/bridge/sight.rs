//! Where the centres of cells see each other past walls.

use std::f32::consts::FRAC_1_SQRT_2;

use rayon::prelude::*;

use super::cells::Cells;
use crate::constraint::barrier::Barriers;

/// The squares between the centres of four cells in which no wall is: there, every point sees all four.
pub struct Sight {
    /// By the lower left cell.
    open: Vec<bool>,
}

impl Sight {
    /// Past `barriers`.
    pub fn new(cells: &Cells, barriers: &Barriers) -> Self {
        let [width, height] = cells.size;
        let open = |cell: usize| {
            let (x, y) = (cell % width, cell / width);
            // Points beyond the outermost centres are not in the square.
            let inner = x > 0 && y > 0 && x + 2 < width && y + 2 < height;
            let middle = cells.centre(cell) + 0.5 * cells.side;
            inner && barriers.distance(middle) > FRAC_1_SQRT_2 * cells.side
        };
        Self { open: (0..cells.count()).into_par_iter().map(open).collect() }
    }

    /// Whether all points see the centres of the cell and of those next to it along x and y.
    #[inline]
    pub fn is_open(&self, cell: usize) -> bool {
        self.open[cell]
    }
}
