//! Box filters by running sums: the cost does not depend on their length.

use std::ops::Range;

use glam::Vec4;
use rayon::prelude::*;

use super::kernel::{BOXES, ExtendedBox, LANES};
use crate::math::mirror::mirrored;
use crate::render::texture::ReceiverTexture;

/// Columns, or rows, filtered side by side: two cache lines, and enough running sums for the vector registers.
const STRIP: usize = 8;

/// The texels of one row of a strip of columns, or of one column of a block of rows.
type Cell = [f32; LANES * STRIP];
const EMPTY: Cell = [0.0; LANES * STRIP];

/// The filter, with buffers kept from call to call.
#[derive(Debug, Default)]
pub(super) struct RunningSum {
    strips: Vec<Line>,
}

impl RunningSum {
    /// Applies the three boxes along columns and rows.
    pub(super) fn filter(&mut self, texture: &mut ReceiverTexture, kernel: &ExtendedBox) {
        let columns = texture.layout().columns;
        self.strips.resize_with(columns.div_ceil(STRIP), Line::default);
        let texels: &[f32] = bytemuck::cast_slice(texture.texels());
        self.strips.par_iter_mut().enumerate().for_each(|(strip, line)| {
            let first = strip * STRIP;
            let width = STRIP.min(columns - first);
            let rows = texels.chunks_exact(LANES * columns).map(|row| {
                let mut cell = EMPTY;
                cell[..LANES * width].copy_from_slice(&row[LANES * first..LANES * (first + width)]);
                cell
            });
            line.filter(rows, kernel);
        });
        let strips = &self.strips;
        let blocks = texture.texels_mut().par_chunks_mut(STRIP * columns).enumerate();
        blocks.for_each_init(Line::default, |line, (block, texels)| {
            let rows = texels.len() / columns;
            line.filter((0..columns).map(|x| across(strips, x, block * STRIP, rows)), kernel);
            for (x, cell) in line.cells().iter().enumerate() {
                for (y, texel) in cell.as_chunks::<LANES>().0.iter().enumerate().take(rows) {
                    texels[y * columns + x] = Vec4::from_array(*texel);
                }
            }
        });
    }
}

/// The texels of column `x` in `rows` rows from `first` on.
fn across(strips: &[Line], x: usize, first: usize, rows: usize) -> Cell {
    let strip = &strips[x / STRIP].cells()[first..first + rows];
    let lane = x % STRIP * LANES;
    let mut cell = EMPTY;
    for (to, from) in cell.chunks_exact_mut(LANES).zip(strip) {
        to.copy_from_slice(&from[lane..lane + LANES]);
    }
    cell
}

impl ExtendedBox {
    /// One box over `from`, which has `half` + 1 cells more than `to` on either side.
    fn apply(&self, from: &[Cell], to: &mut [Cell]) {
        let length = 2 * self.half + 1;
        let norm = 1.0 / (length as f64 + 2.0 * self.edge);
        let edge = self.edge * norm;
        // In f64: a running sum in f32 would leave a residue of bright texels behind.
        let mut sum = [0.0_f64; LANES * STRIP];
        for cell in &from[1..length] {
            (0..LANES * STRIP).for_each(|lane| sum[lane] += f64::from(cell[lane]));
        }
        let entering = from[length..].iter().zip(&from[length + 1..]);
        let leaving = from.iter().zip(&from[1..]);
        for ((out, (last, after)), (before, first)) in to.iter_mut().zip(entering).zip(leaving) {
            for lane in 0..LANES * STRIP {
                sum[lane] += f64::from(last[lane]);
                out[lane] = (sum[lane] * norm + f64::from(before[lane] + after[lane]) * edge) as f32;
                sum[lane] -= f64::from(first[lane]);
            }
        }
    }
}

/// A line of cells padded on either side, and a second one: each box filters from one to the other.
#[derive(Debug, Default)]
struct Line {
    padded: Vec<Cell>,
    other: Vec<Cell>,
    inside: Range<usize>,
}

impl Line {
    fn cells(&self) -> &[Cell] {
        &self.padded[self.inside.clone()]
    }

    /// Applies all boxes to a line.
    fn filter(&mut self, line: impl Iterator<Item = Cell>, kernel: &ExtendedBox) {
        let reach = kernel.half + 1;
        self.padded.clear();
        self.padded.resize(reach, EMPTY);
        self.padded.extend(line);
        self.inside = reach..self.padded.len();
        self.padded.resize(self.inside.end + reach, EMPTY);
        self.other.resize(self.padded.len(), EMPTY);
        for _ in 0..BOXES {
            self.reflect(reach);
            kernel.apply(&self.padded, &mut self.other[self.inside.clone()]);
            std::mem::swap(&mut self.padded, &mut self.other);
        }
    }

    /// Fills the padding by reflection, repeated where it is longer than the line.
    fn reflect(&mut self, reach: usize) {
        let count = self.inside.len();
        let mirror = |i: isize| reach + mirrored(i, count);
        for i in 0..reach {
            self.padded[i] = self.padded[mirror(i as isize - reach as isize)];
            self.padded[reach + count + i] = self.padded[mirror((count + i) as isize)];
        }
    }
}
