//! Points sorted by grid cell.

use glam::Vec2;
use rayon::prelude::*;

use super::element::{Element, Entry, Point, Target};
use super::rows::Rows;
use crate::flow::field::Grid;

/// The cell of a point, and its place there, 0..=1 along x and y. One beyond the border is moved onto it.
#[inline(always)]
pub(super) fn place(grid: Grid, p: Vec2) -> ([usize; 2], [f32; 2]) {
    let locate = |axis: usize| {
        let cells = grid.cells[axis];
        let x = (p[axis] * (1.0 / grid.cell_size()[axis]) as f32).clamp(0.0, cells as f32);
        let cell = (x as usize).min(cells - 1);
        (cell, x - cell as f32)
    };
    let [(column, x), (row, y)] = [0, 1].map(locate);
    ([column, row], [x, y])
}

/// The points of some rows, those of a cell side by side.
#[derive(Default)]
pub(super) struct SortedPoints {
    cells: Vec<u32>,
    points: Vec<Point>,
    /// First point of each cell, and the end of the last.
    starts: Vec<u32>,
}

impl SortedPoints {
    /// Counting sort by cell.
    pub(super) fn sort(&mut self, grid: Grid, rows: Rows) {
        let [width, height] = grid.cells;
        self.cells.clear();
        self.cells.par_extend(rows.positions.par_iter().map(|&p| {
            let ([column, row], _) = place(grid, p);
            (row * width + column) as u32
        }));
        self.starts.clear();
        self.starts.resize(width * height + 1, 0);
        for &cell in &self.cells {
            self.starts[cell as usize + 1] += 1;
        }
        for i in 0..width * height {
            self.starts[i + 1] += self.starts[i];
        }
        self.points.resize(self.cells.len(), [0.0; 4]);
        // The start of each cell moves to its end, which is the start of the next.
        for ((&cell, &position), &velocity) in self.cells.iter().zip(rows.positions).zip(rows.velocities) {
            let (_, [x, y]) = place(grid, position);
            let slot = &mut self.starts[cell as usize];
            self.points[*slot as usize] = [x, y, velocity.x, velocity.y];
            *slot += 1;
        }
    }

    /// Points of a cell, after `sort`.
    fn points_of(&self, cell: usize) -> &[Point] {
        let start = if cell == 0 { 0 } else { self.starts[cell - 1] };
        &self.points[start as usize..self.starts[cell] as usize]
    }

    /// Adds the element matrices of a row of cells to `target`.
    pub(super) fn add_cell_row(
        &self,
        grid: Grid,
        row: usize,
        weight: f64,
        table: &[Entry],
        mut target: Target,
    ) {
        let scale = grid.cell_size().map(|size| 1.0 / size);
        let coupled = target.ata_cross.is_some();
        let mut element = Element::zero();
        for column in 0..grid.cells[0] {
            let points = self.points_of(row * grid.cells[0] + column);
            if points.is_empty() {
                continue;
            }
            element.clear(coupled);
            for point in points {
                element.add(point, scale, coupled);
            }
            element.scatter(column, weight, table, &mut target);
        }
    }
}
