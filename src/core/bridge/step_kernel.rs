//! One short step of the motion around walls.

use rayon::prelude::*;

use super::cells::Cells;
use super::wall_cells::WallCells;
use crate::math::tasks::rows_per_task;

/// Reach of one step, in cells to each side, and the cells along a side of its window.
const REACH: usize = 4;
const WINDOW: usize = 2 * REACH + 1;
/// Cells of a row that are summed up at once, in registers.
const BLOCK: usize = 16;
/// Iterations that scale the rows of a kernel to sum 1.
const SCALINGS: usize = 20;
/// Operations for each cell, about half of them for the windows beside walls.
const OPERATIONS: usize = 50;

/// One short step: a Gaussian over the cells that see each other, scaled so that rows and columns sum to 1, which makes
/// walls and borders reflect.
#[derive(Clone)]
pub(super) struct StepKernel {
    size: [usize; 2],
    /// Gaussian by distance along an axis, in cells.
    taps: [f64; REACH + 1],
    scale: Vec<f64>,
    /// Cells with a wall in reach, ascending; the weights in their windows are explicit, 0 for cells that they do not see.
    beside: Vec<u32>,
    weights: Vec<[[f32; WINDOW]; WINDOW]>,
}

/// A density on its way through a step.
#[derive(Clone)]
pub(super) struct Leaving {
    /// The density as the kernel scales it, with a border of zeros as wide as the reach.
    scaled: Vec<f64>,
    /// It spread along rows.
    rows: Vec<f64>,
}

impl Leaving {
    /// None yet.
    pub(super) fn none([width, height]: [usize; 2]) -> Self {
        let bordered = (width + 2 * REACH) * (height + 2 * REACH);
        Self { scaled: vec![0.0; bordered], rows: vec![0.0; width * height] }
    }

    /// All rows of the grid in parts of `count`, each the scaled ones with their borders and those spread along rows.
    fn parts(
        &mut self,
        [width, height]: [usize; 2],
        count: usize,
    ) -> impl IndexedParallelIterator<Item = (&mut [f64], &mut [f64])> {
        let stride = width + 2 * REACH;
        let inner = &mut self.scaled[REACH * stride..][..height * stride];
        inner.par_chunks_mut(count * stride).zip(self.rows.par_chunks_mut(count * width))
    }
}

impl StepKernel {
    /// The step of variance `variance`, squared cells along each axis; without walls where `walls` is none.
    pub(super) fn new(cells: &Cells, walls: Option<&WallCells>, variance: f64) -> Self {
        let taps = std::array::from_fn(|i| (-(i as f64).powi(2) / (2.0 * variance)).exp());
        let mut kernel = Self {
            size: cells.size,
            taps,
            scale: vec![1.0; cells.count()],
            beside: Vec::new(),
            weights: Vec::new(),
        };
        if let Some(walls) = walls {
            kernel.add_windows(cells, walls);
        }
        let mut leaving = Leaving::none(cells.size);
        let mut product = vec![0.0; cells.count()];
        for _ in 0..SCALINGS {
            // K d with the scale inside: the rows of D K D are d (K d).
            let scale = std::mem::replace(&mut kernel.scale, vec![1.0; cells.count()]);
            kernel.leave(&scale, &mut leaving);
            kernel.arrive(&leaving, &mut product);
            kernel.scale = scale.iter().zip(&product).map(|(d, sum)| (d / sum).sqrt()).collect();
        }
        kernel
    }

    /// Cells along x and y.
    pub(super) fn size(&self) -> [usize; 2] {
        self.size
    }

    /// The cells of the grid in the window of a cell, each with its row and column there.
    fn window(&self, cell: usize) -> impl Iterator<Item = (usize, [usize; 2])> + use<'_> {
        let [width, height] = self.size;
        let (column, row) = (cell % width, cell / width);
        let columns = column.saturating_sub(REACH)..(column + REACH + 1).min(width);
        let rows = row.saturating_sub(REACH)..(row + REACH + 1).min(height);
        let place = move |x: usize, y: usize| (y * width + x, [y + REACH - row, x + REACH - column]);
        rows.flat_map(move |y| columns.clone().map(move |x| place(x, y)))
    }

    /// Explicit weights for the cells that do not see all others within reach.
    fn add_windows(&mut self, cells: &Cells, walls: &WallCells) {
        let seen = |cell: usize| {
            // A wall within reach of a cell is near some cell of its window.
            if !self.window(cell).any(|(other, _)| walls.near(other)) {
                return None;
            }
            let centre = cells.centre(cell);
            let mut weights = [[0.0; WINDOW]; WINDOW];
            for (other, [row, column]) in self.window(cell) {
                if other == cell || !walls.blocks(centre, cells.centre(other)) {
                    let [along_y, along_x] = [row, column].map(|place| self.taps[place.abs_diff(REACH)]);
                    weights[row][column] = (along_y * along_x) as f32;
                }
            }
            Some((cell as u32, weights))
        };
        (self.beside, self.weights) = (0..cells.count()).into_par_iter().filter_map(seen).unzip();
    }

    fn rows_per_task(&self) -> usize {
        rows_per_task(self.size[0], OPERATIONS)
    }

    /// `density` leaves on this step.
    pub(super) fn leave(&self, density: &[f64], leaving: &mut Leaving) {
        let ([width, _], count) = (self.size, self.rows_per_task());
        let parts = leaving.parts(self.size, count).zip(density.par_chunks(count * width)).enumerate();
        parts.for_each(|(task, ((scaled, rows), density))| {
            let rows = scaled.chunks_exact_mut(width + 2 * REACH).zip(rows.chunks_exact_mut(width));
            for (y, (row, density)) in (task * count..).zip(rows.zip(density.chunks_exact(width))) {
                self.leave_row(y, density.iter().copied(), row);
            }
        });
    }

    fn leave_row(
        &self,
        y: usize,
        density: impl Iterator<Item = f64>,
        (scaled, row): (&mut [f64], &mut [f64]),
    ) {
        let width = self.size[0];
        let values = density.zip(&self.scale[y * width..]);
        let own = scaled[REACH..REACH + width].iter_mut();
        own.zip(values).for_each(|(out, (value, scale))| *out = value * scale);
        self.along_row(scaled, row);
    }

    /// `out` = what comes of `leaving` after the step: K times the density that left.
    pub(super) fn arrive(&self, leaving: &Leaving, out: &mut [f64]) {
        let ([width, _], count) = (self.size, self.rows_per_task());
        out.par_chunks_mut(count * width).enumerate().for_each(|(task, out)| {
            for (y, out) in (task * count..).zip(out.chunks_exact_mut(width)) {
                self.arrive_row(y, leaving, out);
            }
        });
    }

    /// As [`Self::arrive`]; what has come leaves at once on the step `next`, `kept(cell, density)` of it.
    pub(super) fn arrive_and_leave(
        &self,
        leaving: &Leaving,
        out: &mut [f64],
        (next, kept): (&Self, impl Fn(usize, f64) -> f64 + Sync),
        leaves: &mut Leaving,
    ) {
        let ([width, _], count) = (self.size, self.rows_per_task());
        let parts = leaves.parts(self.size, count).zip(out.par_chunks_mut(count * width)).enumerate();
        parts.for_each(|(task, ((scaled, rows), out))| {
            let rows = scaled.chunks_exact_mut(width + 2 * REACH).zip(rows.chunks_exact_mut(width));
            for (y, (row, out)) in (task * count..).zip(rows.zip(out.chunks_exact_mut(width))) {
                self.arrive_row(y, leaving, out);
                let density = (y * width..).zip(&*out).map(|(cell, density)| kept(cell, *density));
                next.leave_row(y, density, row);
            }
        });
    }

    fn arrive_row(&self, y: usize, Leaving { scaled, rows }: &Leaving, out: &mut [f64]) {
        let width = self.size[0];
        let stride = width + 2 * REACH;
        self.along_columns(y, rows, out);
        let [first, last] =
            [y, y + 1].map(|y| self.beside.partition_point(|&cell| (cell as usize) < y * width));
        for (&cell, weights) in self.beside[first..last].iter().zip(&self.weights[first..last]) {
            let x = cell as usize - y * width;
            out[x] = in_window(weights, &scaled[y * stride + x..], stride);
        }
        out.iter_mut().zip(&self.scale[y * width..]).for_each(|(out, scale)| *out *= scale);
    }

    /// Spreads a row, which has a border on either side, along itself.
    fn along_row(&self, bordered: &[f64], out: &mut [f64]) {
        for (out, window) in out.iter_mut().zip(bordered.array_windows::<WINDOW>()) {
            let beside = (1..=REACH).map(|k| self.taps[k] * (window[REACH - k] + window[REACH + k]));
            *out = self.taps[0] * window[REACH] + beside.sum::<f64>();
        }
    }

    /// Row `y` of `rows` spread along columns.
    fn along_columns(&self, y: usize, rows: &[f64], out: &mut [f64]) {
        let [width, height] = self.size;
        let from = y.saturating_sub(REACH)..(y + REACH + 1).min(height);
        let (blocks, rest) = out.as_chunks_mut::<BLOCK>();
        let begin = blocks.len() * BLOCK;
        for (block, out) in blocks.iter_mut().enumerate() {
            let mut sums = [0.0; BLOCK];
            for row in from.clone() {
                let tap = self.taps[y.abs_diff(row)];
                let Some(values) = rows[row * width + block * BLOCK..].first_chunk::<BLOCK>() else { break };
                sums.iter_mut().zip(values).for_each(|(sum, value)| *sum += tap * value);
            }
            *out = sums;
        }
        for (x, out) in rest.iter_mut().enumerate() {
            *out = from.clone().map(|row| self.taps[y.abs_diff(row)] * rows[row * width + begin + x]).sum();
        }
    }
}

/// The sum over a window that begins at the first of `values`, of rows of `stride`.
fn in_window(weights: &[[f32; WINDOW]; WINDOW], values: &[f64], stride: usize) -> f64 {
    // Lanes of their own for all columns but the last one.
    let (mut lanes, mut last) = ([0.0; WINDOW - 1], 0.0);
    for (row, weights) in weights.iter().enumerate() {
        let Some(values) = values[row * stride..].first_chunk::<WINDOW>() else { break };
        for i in 0..lanes.len() {
            lanes[i] += f64::from(weights[i]) * values[i];
        }
        last += f64::from(weights[WINDOW - 1]) * values[WINDOW - 1];
    }
    lanes.iter().sum::<f64>() + last
}
