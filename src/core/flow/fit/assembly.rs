//! The sums of Eq. (7) over points: blocks of A^T A, D^T D and N^T N, and the right sides A^T a, D^T d.
//!
//! Points are sorted by cell; those of a cell are summed into one element matrix, which is then added to the stencils.

use glam::{DVec2, Vec2};
use rayon::prelude::*;

use super::bending::bending;
use super::cells::{SortedPoints, place};
use super::element::{Entry, Target, table};
use super::rows::{NoPenetrationRows, Rows};
use crate::flow::field::Grid;
use crate::math::bspline::{slopes, values};
use crate::math::normal_blocks::{NoPenetration, NormalBlocks};
use crate::math::stencil::{OFFSETS, Stencil, offset};
use crate::math::vector::{GridVector, HALO, Layout};

/// The sums of Eq. (7) over rows.
pub struct Assembly {
    grid: Grid,
    /// The blocks of A^T A, D^T D, B^T B and N^T N.
    pub blocks: NormalBlocks,
    /// A^T a and D^T d without the factors p and q: sums of g_x v_y - g_y v_x, and of g_x v_x + g_y v_y.
    pub right: GridVector<f64>,
    table: Vec<Entry>,
    sorted: SortedPoints,
}

impl Assembly {
    /// All sums zero; `coupled` when C is needed.
    pub fn new(grid: Grid, coupled: bool) -> Self {
        let layout = Layout::new(grid.nodes());
        Self {
            grid,
            blocks: NormalBlocks {
                ata: Stencil::zero(layout),
                ata_cross: coupled.then(|| Stencil::zero(layout)),
                btb: bending(grid),
                no_penetration: None,
            },
            right: GridVector::zero(layout, 2),
            table: table(),
            sorted: SortedPoints::default(),
        }
    }

    /// All sums zero again.
    pub fn clear(&mut self) {
        self.blocks.ata.clear();
        self.blocks.ata_cross.iter_mut().for_each(Stencil::clear);
        self.right.clear();
    }

    /// Adds the sums over `rows`, always in the same order.
    pub fn add(&mut self, rows: Rows) {
        self.sorted.sort(self.grid, rows);
        // Tasks own 16 node rows each and may take the cell rows that touch no other; the three cell rows between two
        // tasks come in a second round.
        self.add_round(0, rows.weight);
        self.add_round(PERIOD - 3, rows.weight);
    }

    /// Sets E and Y of N^T N, which stay until they are set anew. S/2 and C/2 are added as [`Rows`] of half the weight at
    /// the same points with velocity zero.
    pub fn set_no_penetration(&mut self, walls: Option<NoPenetrationRows>) {
        self.blocks.no_penetration = walls.map(|walls| {
            let layout = self.blocks.ata.layout;
            let zero = || Stencil::zero(layout);
            let mut sum =
                NoPenetration { diagonal: zero(), cross: self.blocks.ata_cross.as_ref().map(|_| zero()) };
            for (&position, &normal) in walls.positions.iter().zip(walls.normals) {
                self.add_no_penetration(&mut sum, position, normal, walls.weight);
            }
            sum
        });
    }

    /// Adds one point to E and Y.
    fn add_no_penetration(&self, sum: &mut NoPenetration, position: Vec2, normal: Vec2, weight: f64) {
        let (grid, layout) = (self.grid, sum.diagonal.layout);
        let size = grid.cell_size();
        // Placed as the isotropic half is: N^T N is their difference along the wall, of which nothing must be left.
        let ([column, row], [x, y]) = place(grid, position);
        let (x, y) = (f64::from(x), f64::from(y));
        let (bx, by) = (values(x), values(y));
        let (dx, dy) = (slopes(x).map(|d| d / size[0]), slopes(y).map(|d| d / size[1]));
        let gradient = |row: usize, column: usize| [dx[column] * by[row], bx[column] * dy[row]];
        let DVec2 { x: nx, y: ny } = normal.as_dvec2().normalize_or_zero();
        let (cos, sin) = (nx * nx - ny * ny, 2.0 * nx * ny);
        for entry in &self.table {
            let [gx, gy] = gradient(entry.row, entry.column);
            let (step_x, step_y) = offset(entry.offset);
            let [hx, hy] =
                gradient(entry.row.wrapping_add_signed(step_y), entry.column.wrapping_add_signed(step_x));
            let (f, g) = (gx * hx - gy * hy, gx * hy + gy * hx);
            let at =
                ((row + entry.row) * OFFSETS + entry.offset) * layout.stride + HALO + column + entry.column;
            sum.diagonal.rows_mut()[at] += 0.5 * weight * (cos * f + sin * g);
            if let Some(cross) = &mut sum.cross {
                cross.rows_mut()[at] += 0.5 * weight * (sin * f - cos * g);
            }
        }
    }

    fn add_round(&mut self, first: usize, weight: f64) {
        let (grid, sorted, table) = (self.grid, &self.sorted, &self.table);
        let layout = self.blocks.ata.layout;
        if first >= layout.nodes[1] {
            return;
        }
        let (len, right_len) = (self.blocks.ata.row_len(), self.right.row_len());
        let ata = self.blocks.ata.rows_mut()[first * len..].par_chunks_mut(PERIOD * len);
        let right = self.right.rows_mut()[first * right_len..].par_chunks_mut(PERIOD * right_len);
        let taken = if first == 0 { PERIOD - 3 } else { 3 };
        let run = |task: usize, ata: &mut [f64], mut ata_cross: Option<&mut [f64]>, right: &mut [f64]| {
            let start = first + task * PERIOD;
            for cell_row in start..(start + taken).min(grid.cells[1]) {
                let at = cell_row - start;
                let target = Target {
                    layout,
                    ata: &mut ata[at * len..],
                    ata_cross: ata_cross.as_deref_mut().map(|ata_cross| &mut ata_cross[at * len..]),
                    right: &mut right[at * right_len..],
                };
                sorted.add_cell_row(grid, cell_row, weight, table, target);
            }
        };
        match &mut self.blocks.ata_cross {
            None => ata.zip(right).enumerate().for_each(|(task, (d, r))| run(task, d, None, r)),
            Some(ata_cross) => {
                let ata_cross = ata_cross.rows_mut()[first * len..].par_chunks_mut(PERIOD * len);
                ata.zip(ata_cross).zip(right).enumerate().for_each(|(t, ((d, c), r))| run(t, d, Some(c), r));
            }
        }
    }
}

/// Node rows of a task.
const PERIOD: usize = 16;
