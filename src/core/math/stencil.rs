//! Symmetric or antisymmetric matrices that link each node with its 7 x 7 neighbours; one half is stored.
//!
//! The entries of one offset lie side by side along a row, so every loop runs over contiguous numbers.

use rayon::prelude::*;

use super::bspline::REFINE;
use super::real::Real;
use super::tasks::rows_per_task;
use super::vector::{HALO, Layout};

/// Stored offsets (dx, dy): dy = 0 with dx 0..=3, then dy 1..=3 with dx -3..=3.
pub const OFFSETS: usize = 25;

/// Operations for each entry of a matrix that is filled.
const OPERATIONS: usize = 10;

/// Index of a stored offset.
#[inline(always)]
pub const fn offset_index(dx: isize, dy: isize) -> usize {
    if dy == 0 { dx as usize } else { (4 + 7 * (dy - 1) + dx + 3) as usize }
}

/// The stored offset (dx, dy) of an index.
#[inline(always)]
pub const fn offset(index: usize) -> (isize, isize) {
    if index < 4 { (index as isize, 0) } else { ((index as isize - 4) % 7 - 3, (index as isize - 4) / 7 + 1) }
}

/// All stored offsets (dx, dy) in the order of their index.
pub fn offsets() -> impl Iterator<Item = (isize, isize)> {
    (0..OFFSETS).map(offset)
}

/// The stored half of a matrix: entry (node, node + offset) for each node and stored offset.
#[derive(Clone, Debug)]
pub struct Stencil<T> {
    /// Where the nodes lie.
    pub layout: Layout,
    values: Vec<T>,
}

impl<T: Real> Stencil<T> {
    /// All zeros.
    pub fn zero(layout: Layout) -> Self {
        let rows = layout.nodes[1] + HALO;
        Self { layout, values: vec![T::default(); rows * OFFSETS * layout.stride] }
    }

    /// Numbers of a row of nodes, all offsets.
    pub fn row_len(&self) -> usize {
        OFFSETS * self.layout.stride
    }

    /// Entries of one offset along a row with the halo around; rows count from the first halo row, as in `GridVector`.
    #[inline(always)]
    pub fn padded(&self, row: usize, offset: usize) -> &[T] {
        let start = (row * OFFSETS + offset) * self.layout.stride;
        &self.values[start..start + self.layout.stride]
    }

    /// All node rows.
    pub fn rows_mut(&mut self) -> &mut [T] {
        let start = HALO * self.row_len();
        &mut self.values[start..]
    }

    /// Sets all to zero.
    pub fn clear(&mut self) {
        self.values.par_chunks_mut(1 << 16).for_each(|part| part.fill(T::default()));
    }

    /// Entry of node (x, y) and its neighbour at (x + dx, y + dy), from the stored half; `sign` is -1 for an
    /// antisymmetric matrix.
    pub fn entry(&self, x: usize, y: usize, dx: isize, dy: isize, sign: T) -> T {
        let start = x + HALO;
        if dy > 0 || (dy == 0 && dx >= 0) {
            self.padded(y + HALO, offset_index(dx, dy))[start]
        } else {
            let row = (y + HALO).wrapping_add_signed(dy);
            sign * self.padded(row, offset_index(-dx, -dy))[start.wrapping_add_signed(dx)]
        }
    }

    /// Fills each row of each offset: `fill(row, dx, dy, entries)`, entries without halo.
    pub fn fill_rows(&mut self, fill: impl Fn(usize, isize, isize, &mut [T]) + Sync) {
        let (len, Layout { width, stride, .. }) = (self.row_len(), self.layout);
        let rows = rows_per_task(len, OPERATIONS);
        self.rows_mut().par_chunks_mut(rows * len).enumerate().for_each(|(task, part)| {
            for (row, values) in (task * rows..).zip(part.chunks_exact_mut(len)) {
                for ((dx, dy), values) in offsets().zip(values.chunks_exact_mut(stride)) {
                    fill(row, dx, dy, &mut values[HALO..HALO + width]);
                }
            }
        });
    }

    /// The same matrix with x and y exchanged.
    fn transposed(&self, sign: T) -> Self {
        let [nx, ny] = self.layout.nodes;
        let mut out = Self::zero(Layout::new([ny, nx]));
        out.fill_rows(|row, dx, dy, entries| {
            // Node (row, y) here, offset (dy, dx) in the original.
            for (y, entry) in entries[..ny].iter_mut().enumerate() {
                *entry = self.entry(row, y, dy, dx, sign);
            }
        });
        out
    }

    /// The matrix on a grid with half as many cells along y (`nodes` along y): R A R^T with the mask of `REFINE`.
    fn coarsened_along_y(&self, nodes: usize, sign: T) -> Self {
        let [nx, ny] = self.layout.nodes;
        let mut out = Self::zero(Layout::new([nx, nodes]));
        out.fill_rows(|row, dx, dy, entries| {
            for a in 0..5 {
                for b in 0..5 {
                    let fine_dy = 2 * dy + b - a;
                    let (from, to) = (2 * row as isize - 3 + a, 2 * (row as isize + dy) - 3 + b);
                    let inside = 0..ny as isize;
                    if fine_dy.abs() > 3 || !inside.contains(&from) || !inside.contains(&to) {
                        continue;
                    }
                    let stored = fine_dy > 0 || (fine_dy == 0 && dx >= 0);
                    let (row, offset, shift, sign) = if stored {
                        (from, offset_index(dx, fine_dy), 0, T::from_f64(1.0))
                    } else {
                        (to, offset_index(-dx, -fine_dy), dx, sign)
                    };
                    let source = self.padded(row as usize + HALO, offset);
                    let source = &source[HALO.wrapping_add_signed(shift)..][..entries.len()];
                    let weight = sign * T::from_f64(REFINE[a as usize] * REFINE[b as usize]);
                    for (entry, &value) in entries.iter_mut().zip(source) {
                        *entry = weight.fused(value, *entry);
                    }
                }
            }
        });
        out
    }

    /// The Galerkin matrix on a coarser grid; an axis whose number of `nodes` stays is left as it is.
    pub fn coarsened(&self, nodes: [usize; 2], sign: T) -> Self {
        let along_y = nodes[1] != self.layout.nodes[1];
        let halved = if along_y { &self.coarsened_along_y(nodes[1], sign) } else { self };
        if nodes[0] == self.layout.nodes[0] {
            return halved.clone();
        }
        halved.transposed(sign).coarsened_along_y(nodes[0], sign).transposed(sign)
    }
}
