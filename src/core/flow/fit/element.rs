//! The element matrix of a grid cell: its sums of A^T A and A^T a over the points in the cell.

use crate::math::bspline::{slopes, values};
use crate::math::stencil::{OFFSETS, offset_index};
use crate::math::vector::{HALO, Layout};

/// A point in its cell: place 0..=1 along x and y, velocity.
pub(super) type Point = [f32; 4];

/// Where a number of the element matrix belongs.
pub(super) struct Entry {
    /// Row and column of the node in its cell, 0..4.
    pub(super) row: usize,
    pub(super) column: usize,
    pub(super) offset: usize,
    /// Index in `ata`.
    ata: usize,
    /// Indices in `ata_cross`, the second to be subtracted.
    ata_cross: [usize; 2],
}

/// Sums over the points of a cell, products of one number along x and one along y.
pub(super) struct Element {
    /// Pairs (i, k) along x with i <= k, all pairs (j, l) along y: x'_i x'_k y_j y_l + x_i x_k y'_j y'_l.
    ata: [[f64; 16]; 10],
    /// All pairs (i, k) along x, all (j, l) along y: x'_i x_k y_j y'_l. C is this minus its transpose.
    ata_cross: [[f64; 16]; 16],
    right: [[[f64; 4]; 4]; 2],
}

/// Memory from the lowest node row of a cell row upwards.
pub(super) struct Target<'a> {
    pub(super) layout: Layout,
    pub(super) ata: &'a mut [f64],
    pub(super) ata_cross: Option<&'a mut [f64]>,
    pub(super) right: &'a mut [f64],
}

impl Element {
    pub(super) fn zero() -> Self {
        Self { ata: [[0.0; 16]; 10], ata_cross: [[0.0; 16]; 16], right: [[[0.0; 4]; 4]; 2] }
    }

    pub(super) fn clear(&mut self, coupled: bool) {
        self.ata = [[0.0; 16]; 10];
        self.right = [[[0.0; 4]; 4]; 2];
        if coupled {
            self.ata_cross = [[0.0; 16]; 16];
        }
    }

    #[inline(always)]
    pub(super) fn add(&mut self, &[x, y, vx, vy]: &Point, scale: [f64; 2], coupled: bool) {
        let (bx, by) = (values(f64::from(x)), values(f64::from(y)));
        let (dx, dy) =
            (slopes(f64::from(x)).map(|d| d * scale[0]), slopes(f64::from(y)).map(|d| d * scale[1]));
        let (by2, dy2) = (outer(by, by), outer(dy, dy));
        for (sum, (i, k)) in self.ata.iter_mut().zip(PAIRS) {
            let (b, d) = (bx[i] * bx[k], dx[i] * dx[k]);
            for q in 0..16 {
                sum[q] = d.mul_add(by2[q], b.mul_add(dy2[q], sum[q]));
            }
        }
        if coupled {
            let (xs, ys) = (outer(dx, bx), outer(by, dy));
            for (sum, x) in self.ata_cross.iter_mut().zip(xs) {
                for q in 0..16 {
                    sum[q] = x.mul_add(ys[q], sum[q]);
                }
            }
        }
        let (vx, vy) = (f64::from(vx), f64::from(vy));
        for row in 0..4 {
            for i in 0..4 {
                let (gx, gy) = (dx[i] * by[row], bx[i] * dy[row]);
                self.right[0][row][i] += gx * vy - gy * vx;
                self.right[1][row][i] += gx * vx + gy * vy;
            }
        }
    }

    /// Adds the sums to the nodes of the cell in column `column`.
    pub(super) fn scatter(&self, column: usize, weight: f64, table: &[Entry], target: &mut Target) {
        let stride = target.layout.stride;
        let first = HALO + column;
        let ata = self.ata.as_flattened();
        for entry in table {
            let at = (entry.row * OFFSETS + entry.offset) * stride + first + entry.column;
            target.ata[at] += weight * ata[entry.ata];
        }
        if let Some(out) = &mut target.ata_cross {
            let ata_cross = self.ata_cross.as_flattened();
            for entry in table {
                let at = (entry.row * OFFSETS + entry.offset) * stride + first + entry.column;
                out[at] += weight * (ata_cross[entry.ata_cross[0]] - ata_cross[entry.ata_cross[1]]);
            }
        }
        for (component, right) in self.right.iter().enumerate() {
            for (row, right) in right.iter().enumerate() {
                let out = &mut target.right[(row * 2 + component) * stride + first..][..4];
                for (out, value) in out.iter_mut().zip(right) {
                    *out += weight * value;
                }
            }
        }
    }
}

/// a_i b_k for all i, k.
#[inline(always)]
fn outer(a: [f64; 4], b: [f64; 4]) -> [f64; 16] {
    let mut pairs = [0.0; 16];
    for (pairs, a) in pairs.chunks_exact_mut(4).zip(a) {
        for k in 0..4 {
            pairs[k] = a * b[k];
        }
    }
    pairs
}

/// Pairs i <= k in the order of `Element::ata`.
const PAIRS: [(usize, usize); 10] =
    [(0, 0), (0, 1), (0, 2), (0, 3), (1, 1), (1, 2), (1, 3), (2, 2), (2, 3), (3, 3)];

/// The stored half of an element matrix: all pairs of its 16 nodes whose offset is stored.
pub(super) fn table() -> Vec<Entry> {
    let pair = |i: usize, k: usize| PAIRS.iter().position(|&p| p == (i.min(k), i.max(k))).unwrap_or(0);
    let nodes = || (0..4).flat_map(|row| (0..4).map(move |column| (row, column)));
    let mut table = Vec::new();
    for ((j, i), (l, k)) in nodes().flat_map(|a| nodes().map(move |b| (a, b))) {
        let (dx, dy) = (k as isize - i as isize, l as isize - j as isize);
        if dy < 0 || (dy == 0 && dx < 0) {
            continue;
        }
        let ata_cross = [(4 * i + k) * 16 + 4 * j + l, (4 * k + i) * 16 + 4 * l + j];
        let ata = pair(i, k) * 16 + 4 * j + l;
        table.push(Entry { row: j, column: i, offset: offset_index(dx, dy), ata, ata_cross });
    }
    table
}
