//! The kernel of motion around walls: many short steps, none through a wall, and no cell fuller than its cap.

use std::ops::Range;

use glam::Vec2;
use rayon::prelude::*;

use super::cells::Cells;
use super::wall_cells::WallCells;
use crate::math::tasks::Tasks as _;

/// Reach of one step, in cells to each side, and the cells along a side of its window.
const REACH: usize = 4;
const WINDOW: usize = 2 * REACH + 1;
/// Cells of a row that are summed up at once, in registers.
const BLOCK: usize = 16;
/// Iterations that scale the rows of a kernel to sum 1.
const SCALINGS: usize = 20;
/// Cells per parallel task: smaller grids are done before another thread has woken up.
const PER_TASK: usize = 16_384;
/// Densities below this count as none.
const LEAST: f64 = 1e-290;

/// One short step: a Gaussian over the cells that see each other, scaled so that rows and columns sum to 1, which makes
/// walls and borders reflect.
pub(super) struct StepKernel {
    size: [usize; 2],
    /// Gaussian by distance along an axis, in cells.
    taps: [f64; REACH + 1],
    scale: Vec<f64>,
    /// Cells with a wall in reach, ascending; the weights in their windows are explicit, 0 for cells that they do not see.
    beside: Vec<u32>,
    weights: Vec<[[f32; WINDOW]; WINDOW]>,
}

/// Columns for the intermediate values of a step.
pub(super) struct Work {
    /// The scaled density, with a border of zeros as wide as the reach.
    scaled: Vec<f64>,
    /// It spread along rows.
    rows: Vec<f64>,
}

impl Work {
    pub(super) fn new([width, height]: [usize; 2]) -> Self {
        Self {
            scaled: vec![0.0; (width + 2 * REACH) * (height + 2 * REACH)],
            rows: vec![0.0; width * height],
        }
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
        let mut work = Work::new(cells.size);
        let mut product = vec![0.0; cells.count()];
        for _ in 0..SCALINGS {
            // K d with the scale inside: the rows of D K D are d (K d).
            let scale = std::mem::replace(&mut kernel.scale, vec![1.0; cells.count()]);
            kernel.spread(&scale, &mut work, &mut product);
            kernel.scale = scale.iter().zip(&product).map(|(d, sum)| (d / sum).sqrt()).collect();
        }
        kernel
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

    /// `out` = K `density`.
    pub(super) fn spread(&self, density: &[f64], work: &mut Work, out: &mut [f64]) {
        let [width, height] = self.size;
        let stride = width + 2 * REACH;
        let rows_per_task = PER_TASK.div_ceil(width);
        let Work { scaled, rows } = work;
        let inner = scaled[REACH * stride..][..height * stride].par_chunks_mut(rows_per_task * stride);
        let tasks = inner.zip(rows.par_chunks_mut(rows_per_task * width)).enumerate();
        tasks.for_each_task(|(task, (scaled, rows))| {
            let rows = scaled.chunks_exact_mut(stride).zip(rows.chunks_exact_mut(width));
            for (y, (scaled, row)) in (task * rows_per_task..).zip(rows) {
                let values = density[y * width..].iter().zip(&self.scale[y * width..]);
                let own = scaled[REACH..REACH + width].iter_mut();
                own.zip(values).for_each(|(out, (value, scale))| *out = value * scale);
                self.along_row(scaled, row);
            }
        });
        let (scaled, rows) = (&*scaled, &*rows);
        out.par_chunks_mut(rows_per_task * width).enumerate().for_each_task(|(task, out)| {
            for (y, out) in (task * rows_per_task..).zip(out.chunks_exact_mut(width)) {
                self.along_columns(y, rows, out);
                let [first, last] =
                    [y, y + 1].map(|y| self.beside.partition_point(|&cell| (cell as usize) < y * width));
                for (&cell, weights) in self.beside[first..last].iter().zip(&self.weights[first..last]) {
                    let x = cell as usize - y * width;
                    out[x] = in_window(weights, &scaled[y * stride + x..], stride);
                }
                out.iter_mut().zip(&self.scale[y * width..]).for_each(|(out, scale)| *out *= scale);
            }
        });
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

/// The kernel over all steps with the factors that keep every cell below its cap.
pub(super) struct WallKernel {
    /// The kernels, and which of them each step has.
    kernels: Vec<StepKernel>,
    of_step: Vec<usize>,
    /// Most light of each cell.
    cap: Vec<f64>,
    /// The share of light that is let stay beside walls in one step, by kernel and cell.
    soft: Vec<Vec<f64>>,
    /// Factors at the begin of each step, at most 1, and the densities from both sides there.
    factors: Vec<Vec<f64>>,
    from: [Vec<Vec<f64>>; 2],
    work: Work,
    current: Vec<f64>,
    /// Whether both sides have spread, so that the light between them is known.
    known: [bool; 2],
    /// The factors of both ends.
    ends: [Vec<f64>; 2],
    /// The steps between the ends.
    range: Range<usize>,
}

impl WallKernel {
    pub(super) fn new(
        (kernels, soft): (Vec<StepKernel>, Vec<Vec<f64>>),
        of_step: Vec<usize>,
        cap: Vec<f64>,
    ) -> Self {
        let (steps, count) = (of_step.len(), cap.len());
        let size = kernels.first().map_or([0; 2], |kernel| kernel.size);
        let columns = |value: f64| vec![vec![value; count]; steps + 1];
        let factors = (0..=steps).map(|k| soft[of_step[k.min(steps - 1)]].clone()).collect();
        Self {
            kernels,
            of_step,
            cap,
            soft,
            factors,
            from: [columns(1.0), columns(1.0)],
            work: Work::new(size),
            current: vec![0.0; count],
            known: [false; 2],
            ends: [vec![0.0; count], vec![0.0; count]],
            range: 0..steps,
        }
    }

    /// Moves both ends by `done` steps towards each other, from where they were at first.
    pub(super) fn narrow(&mut self, done: usize) {
        self.range = done..self.of_step.len() - done;
    }

    /// `out` = the density of `side` (0: from the begin on, 1: from the end back) at the other end.
    pub(super) fn spread(&mut self, side: usize, density: &[f64], out: &mut [f64]) {
        let Range { start, end } = self.range;
        self.current.copy_from_slice(density);
        self.known[side] = true;
        self.ends[side].copy_from_slice(density);
        let capped = self.known == [true; 2];
        for k in 0..end - start {
            let (step, to) = if side == 0 { (start + k, start + k + 1) } else { (end - 1 - k, end - 1 - k) };
            let kernel = &self.kernels[self.of_step[step]];
            kernel.spread(&self.current, &mut self.work, &mut self.from[side][to]);
            if to == start || to == end {
                break;
            }
            let [a, b] = &self.from;
            let soft = &self.soft[self.of_step[to]];
            let columns = self.current.iter_mut().zip(&mut self.factors[to]).zip(&self.cap);
            for (i, ((current, factor), cap)) in columns.enumerate() {
                if capped {
                    *factor = (cap / (a[to][i] * b[to][i]).max(LEAST)).min(soft[i]);
                }
                *current = *factor * self.from[side][to][i];
            }
        }
        out.copy_from_slice(&self.from[side][if side == 0 { end } else { start }]);
    }

    /// The factor of the later end that was spread last.
    pub(super) fn later_end(&self) -> &[f64] {
        &self.ends[1]
    }

    /// What has come from the earlier end to the later one.
    pub(super) fn reached_later(&self) -> &[f64] {
        &self.from[0][self.of_step.len()]
    }

    /// The light between the ends at the begin of step `k`, which is not the first: share of the light in each cell.
    pub(super) fn density(&self, k: usize) -> Vec<f64> {
        let [a, b] = &self.from;
        let columns = a[k].iter().zip(&b[k]).zip(&self.factors[k]);
        columns.map(|((a, b), factor)| a * b * factor).collect()
    }

    /// The velocity of the planned light in step `k` in each cell, plane units per step: half the mean move of the light that
    /// is there from here on, and half that of the light that is there then until now. Zero where there is none.
    ///
    /// Where walls change after the step, light of the side `alone` must be through by then, which its own moves alone know.
    pub(super) fn velocity(&mut self, k: usize, cells: &Cells, alone: Option<usize>) -> Vec<Vec2> {
        let [onward, back] = [0, 1].map(|side| self.onward(side, k, cells));
        match alone {
            None => onward.iter().zip(&back).map(|(onward, back)| 0.5 * (*onward - *back)).collect(),
            Some(0) => onward,
            Some(_) => back.iter().map(|back| -*back).collect(),
        }
    }

    /// The mean move in step `k` of the light of `side` towards the other end in each cell, plane units.
    pub(super) fn onward(&mut self, side: usize, k: usize, cells: &Cells) -> Vec<Vec2> {
        let light = if side == 0 { self.factored(1, k + 1) } else { self.factored(0, k) };
        self.moves_towards(k, &light, cells)
    }

    /// The density from `side` at the begin of step `k`, times the factor there.
    fn factored(&self, side: usize, k: usize) -> Vec<f64> {
        if k == [self.range.start, self.range.end][side] {
            return self.ends[side].clone();
        }
        self.from[side][k].iter().zip(&self.factors[k]).map(|(density, factor)| density * factor).collect()
    }

    /// The mean move from each cell to where `light` is, as far as step `k` reaches.
    pub(super) fn moves_towards(&mut self, k: usize, light: &[f64], cells: &Cells) -> Vec<Vec2> {
        let kernel = &self.kernels[self.of_step[k]];
        let mut spread = |values: &[f64]| {
            let mut out = vec![0.0; values.len()];
            kernel.spread(values, &mut self.work, &mut out);
            out
        };
        let weighted = |axis: usize| -> Vec<f64> {
            light.iter().enumerate().map(|(i, value)| value * f64::from(cells.centre(i)[axis])).collect()
        };
        let (all, x, y) = (spread(light), spread(&weighted(0)), spread(&weighted(1)));
        let mean = |i: usize| {
            if all[i] <= LEAST {
                return Vec2::ZERO;
            }
            Vec2::new((x[i] / all[i]) as f32, (y[i] / all[i]) as f32) - cells.centre(i)
        };
        (0..all.len()).map(mean).collect()
    }

    /// `out` = `density` after `times` steps with the walls of step `k`.
    pub(super) fn blur(&mut self, k: usize, times: usize, density: &[f64], out: &mut [f64]) {
        out.copy_from_slice(density);
        for _ in 0..times {
            self.current.copy_from_slice(out);
            self.kernels[self.of_step[k]].spread(&self.current, &mut self.work, out);
        }
    }
}
