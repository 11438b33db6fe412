//! Velocities of a plan that outlive it.

use glam::Vec2;

use super::cells::Cells;
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

    /// The velocity at `p`, between those of the cells around it.
    pub fn at(&self, p: Vec2) -> Vec2 {
        self.cells.around(p).iter().map(|&(cell, weight)| self.velocities[cell] * weight).sum()
    }

    /// The velocity at `p`, between those of the cells that it sees past `barriers`; zero where it sees none.
    pub fn seen_from(&self, barriers: &Barriers, p: Vec2) -> Vec2 {
        let mut sum = Vec2::ZERO;
        let mut total = 0.0;
        for (cell, weight) in self.cells.around(p) {
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
