//! Velocities of a plan that outlive it.

use glam::Vec2;

use super::cells::{Cells, weighted};
use super::sight::Sight;
use crate::constraint::barrier::Barriers;

/// Velocities in cells, plane units per unit of time, as a plan had them at one step.
#[derive(Clone, Debug, serde::Deserialize, serde::Serialize)]
pub struct CellVelocities {
    cells: Cells,
    velocities: Vec<Vec2>,
}

impl CellVelocities {
    pub(super) fn new(cells: Cells, velocities: Vec<Vec2>) -> Self {
        Self { cells, velocities }
    }

    /// Length of a cell, plane units.
    pub fn side(&self) -> f32 {
        self.cells.side
    }

    /// The cells.
    pub fn cells(&self) -> &Cells {
        &self.cells
    }

    /// The velocity at `p`, between those of the cells around it that it sees past the walls; zero where it sees none. `sight` is
    /// that of the same cells.
    #[inline]
    pub fn seen_from(&self, (barriers, sight): (&Barriers, &Sight), p: Vec2) -> Vec2 {
        let around = self.cells.around(p);
        match sight.is_open(around[0].0) {
            true => weighted(&self.velocities, around),
            false => self.past(barriers, p, around),
        }
    }

    fn past(&self, barriers: &Barriers, p: Vec2, around: [(usize, f32); 4]) -> Vec2 {
        let mut sum = Vec2::ZERO;
        let mut total = 0.0;
        for (cell, weight) in around {
            if !barriers.blocks(p, self.cells.centre(cell)) {
                // A cell with no bilinear weight may be the only one in sight.
                let weight = weight + 1e-6;
                sum += weight * self.velocities[cell];
                total += weight;
            }
        }
        if total > 0.0 { sum / total } else { Vec2::ZERO }
    }
}
