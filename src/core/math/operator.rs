//! The matrix of Eq. (7) for one or two coupled potentials on a grid, and its products with vectors.

use rayon::prelude::*;

use super::normal_blocks::{NormalBlocks, Weights};
use super::real::Real;
use super::stencil::{OFFSETS, Stencil, offset, offset_index};
use super::tasks;
use super::vector::{GridVector, HALO, Layout};

/// A symmetric positive semidefinite matrix over a grid.
pub struct Operator<T> {
    /// Where the nodes lie.
    pub layout: Layout,
    /// Potentials, 1 or 2.
    pub components: usize,
    /// The inverse diagonal for smoothing, see `set_inverse_diagonal`; 0 where a row is zero.
    pub inverse_diagonal: GridVector<T>,
    psi: Stencil<T>,
    coupled: Option<Coupled<T>>,
}

/// The blocks of the second potential.
struct Coupled<T> {
    phi: Stencil<T>,
    /// The off-diagonal block of A^T A + D^T D.
    antisymmetric: Stencil<T>,
    /// The off-diagonal block of N^T N beside it; absent without walls.
    symmetric: Option<Stencil<T>>,
}

impl<T: Real> Operator<T> {
    /// Room for a matrix of zeros.
    pub fn zero(layout: Layout, components: usize) -> Self {
        let coupled =
            || Coupled { phi: Stencil::zero(layout), antisymmetric: Stencil::zero(layout), symmetric: None };
        Self {
            layout,
            components,
            inverse_diagonal: GridVector::zero(layout, components),
            psi: Stencil::zero(layout),
            coupled: (components == 2).then(coupled),
        }
    }

    /// Sets the matrix. Two potentials need `blocks.ata_cross`.
    pub fn set(&mut self, blocks: &NormalBlocks, weights: Weights) {
        let no_penetration = blocks.no_penetration.as_ref();
        // weight (A^T A + D^T D + sign E) + alpha B^T B
        let diagonal = |out: &mut Stencil<T>, weight: f64, sign: f64| {
            out.fill_rows(|row, dx, dy, entries| {
                let source = |block| row_of(block, row, dx, dy);
                write(entries, source(&blocks.ata), weight);
                if let Some(no_penetration) = no_penetration {
                    add(entries, source(&no_penetration.diagonal), weight * sign);
                }
                blocks.btb.add_entries(weights.alpha, row, dx, dy as usize, entries);
            });
        };
        diagonal(&mut self.psi, weights.psi, weights.no_penetration);
        if let (Some(coupled), Some(ata_cross)) = (&mut self.coupled, &blocks.ata_cross) {
            diagonal(&mut coupled.phi, weights.phi, -weights.no_penetration);
            let cross = |out: &mut Stencil<T>, block: &Stencil<f64>| {
                out.fill_rows(|row, dx, dy, entries| {
                    write(entries, row_of(block, row, dx, dy), weights.cross);
                });
            };
            cross(&mut coupled.antisymmetric, ata_cross);
            coupled.symmetric = no_penetration.and_then(|walls| walls.cross.as_ref()).map(|block| {
                let mut out = coupled.symmetric.take().unwrap_or_else(|| Stencil::zero(block.layout));
                cross(&mut out, block);
                out
            });
        }
        self.set_inverse_diagonal();
    }

    /// One over d_i = sum over k of |m_ik| sqrt(m_ii / m_kk) of this matrix M, so that no eigenvalue of diag(d)^-1 M exceeds
    /// 1 (Gershgorin's circles for M scaled to a unit diagonal). The square root evens out the splines that are cut off at
    /// the border.
    fn set_inverse_diagonal(&mut self) {
        let one = T::from_f64(1.0);
        let (layout, components) = (self.layout, self.components);
        let blocks = [Some(&self.psi), self.coupled.as_ref().map(|coupled| &coupled.phi)];
        let mut scale = GridVector::zero(layout, components);
        for (component, block) in blocks.iter().flatten().enumerate() {
            for (y, x) in (0..layout.nodes[1]).flat_map(|y| (0..layout.nodes[0]).map(move |x| (y, x))) {
                let value = block.entry(x, y, 0, 0, one).to_f64();
                let inverse = if value > 0.0 { 1.0 / value.sqrt() } else { 0.0 };
                scale.set(component, x, y, T::from_f64(inverse));
            }
        }
        let mut sums = GridVector::zero(layout, components);
        let (len, rows) = (sums.row_len(), self.rows_per_task());
        sums.rows_mut().par_chunks_mut(len * rows).enumerate().for_each(|(task, part)| {
            for (i, sums) in part.chunks_exact_mut(len).enumerate() {
                let row = task * rows + i;
                self.subtract_row::<true>(row, &scale, sums);
                for (sum, &scale) in sums.iter_mut().zip(&scale.rows()[row * len..]) {
                    let (sum_f64, scale) = (-sum.to_f64(), scale.to_f64());
                    *sum = T::from_f64(if sum_f64 > 0.0 { scale / sum_f64 } else { 0.0 });
                }
            }
        });
        self.inverse_diagonal = sums;
    }

    /// Rows in a parallel task of a product of this matrix and a vector: the stored half of each block is used twice.
    pub fn rows_per_task(&self) -> usize {
        tasks::rows_per_task(self.components * self.layout.stride, self.components * 2 * OFFSETS)
    }

    /// `out` -= M `vector`, where M is this matrix.
    pub fn subtract_product(&self, vector: &GridVector<T>, out: &mut GridVector<T>) {
        let (len, rows) = (out.row_len(), self.rows_per_task());
        out.rows_mut().par_chunks_mut(len * rows).enumerate().for_each(|(task, part)| {
            for (i, out) in part.chunks_exact_mut(len).enumerate() {
                self.subtract_row::<false>(task * rows + i, vector, out);
            }
        });
    }

    /// `out` -= node row `row` of M `vector`; `out` is all components of the row with their halo.
    #[inline]
    pub fn subtract_row<const ABSOLUTE: bool>(&self, row: usize, vector: &GridVector<T>, out: &mut [T]) {
        match &self.coupled {
            None => {
                let out = &mut out[HALO..HALO + self.layout.width];
                subtract_symmetric::<T, ABSOLUTE>(&self.psi, row + HALO, |row| vector.padded(row, 0), out);
            }
            Some(coupled) => self.subtract_coupled::<ABSOLUTE>(coupled, row, vector, out),
        }
    }

    fn subtract_coupled<const ABSOLUTE: bool>(
        &self,
        coupled: &Coupled<T>,
        row: usize,
        vector: &GridVector<T>,
        out: &mut [T],
    ) {
        let Layout { width, stride, .. } = self.layout;
        let (out_psi, out_phi) = out.split_at_mut(stride);
        let (out_psi, out_phi) = (&mut out_psi[HALO..HALO + width], &mut out_phi[HALO..HALO + width]);
        let at = row + HALO;
        // The centre of the antisymmetric block is zero.
        let (p, q) =
            (&self.psi.padded(at, 0)[HALO..HALO + width], &coupled.phi.padded(at, 0)[HALO..HALO + width]);
        let (psi, phi) =
            (&vector.padded(at, 0)[HALO..HALO + width], &vector.padded(at, 1)[HALO..HALO + width]);
        for i in 0..width {
            out_psi[i] = minus::<T, ABSOLUTE>(p[i]).fused(psi[i], out_psi[i]);
            out_phi[i] = minus::<T, ABSOLUTE>(q[i]).fused(phi[i], out_phi[i]);
        }
        for k in 1..OFFSETS {
            self.subtract_offset::<ABSOLUTE>(coupled, (at, k), vector, out_psi, out_phi);
        }
        if let Some(symmetric) = &coupled.symmetric {
            subtract_symmetric::<T, ABSOLUTE>(symmetric, at, |row| vector.padded(row, 1), out_psi);
            subtract_symmetric::<T, ABSOLUTE>(symmetric, at, |row| vector.padded(row, 0), out_phi);
        }
    }

    /// Both neighbours at plus and minus offset `k` of node row `at`.
    #[inline(always)]
    fn subtract_offset<const ABSOLUTE: bool>(
        &self,
        coupled: &Coupled<T>,
        (at, k): (usize, usize),
        vector: &GridVector<T>,
        out_psi: &mut [T],
        out_phi: &mut [T],
    ) {
        let width = self.layout.width;
        let (dx, dy) = offset(k);
        let (after, before) = (HALO.wrapping_add_signed(dx), HALO.wrapping_add_signed(-dx));
        let (above, below) = (at + dy as usize, at - dy as usize);
        let p = &self.psi.padded(at, k)[HALO..HALO + width];
        let q = &coupled.phi.padded(at, k)[HALO..HALO + width];
        let c = &coupled.antisymmetric.padded(at, k)[HALO..HALO + width];
        let psi = &vector.padded(above, 0)[after..after + width];
        let phi = &vector.padded(above, 1)[after..after + width];
        for i in 0..width {
            out_psi[i] = minus::<T, ABSOLUTE>(p[i])
                .fused(psi[i], minus::<T, ABSOLUTE>(c[i]).fused(phi[i], out_psi[i]));
            out_phi[i] =
                minus::<T, ABSOLUTE>(q[i]).fused(phi[i], plus::<T, ABSOLUTE>(c[i]).fused(psi[i], out_phi[i]));
        }
        let p = &self.psi.padded(below, k)[before..before + width];
        let q = &coupled.phi.padded(below, k)[before..before + width];
        let c = &coupled.antisymmetric.padded(below, k)[before..before + width];
        let psi = &vector.padded(below, 0)[before..before + width];
        let phi = &vector.padded(below, 1)[before..before + width];
        for i in 0..width {
            out_psi[i] =
                minus::<T, ABSOLUTE>(p[i]).fused(psi[i], plus::<T, ABSOLUTE>(c[i]).fused(phi[i], out_psi[i]));
            out_phi[i] = minus::<T, ABSOLUTE>(q[i])
                .fused(phi[i], minus::<T, ABSOLUTE>(c[i]).fused(psi[i], out_phi[i]));
        }
    }
}

/// `out` -= node row `at` (counting the halo) of a symmetric stencil times one component of a vector.
#[inline]
fn subtract_symmetric<'a, T: Real + 'a, const ABSOLUTE: bool>(
    stencil: &Stencil<T>,
    at: usize,
    vector: impl Fn(usize) -> &'a [T],
    out: &mut [T],
) {
    let width = out.len();
    let centre = &stencil.padded(at, 0)[HALO..HALO + width];
    let x = &vector(at)[HALO..HALO + width];
    for i in 0..width {
        out[i] = minus::<T, ABSOLUTE>(centre[i]).fused(x[i], out[i]);
    }
    for k in 1..OFFSETS {
        let (dx, dy) = offset(k);
        let (after, before) = (HALO.wrapping_add_signed(dx), HALO.wrapping_add_signed(-dx));
        let (above, below) = (at + dy as usize, at - dy as usize);
        let s = &stencil.padded(at, k)[HALO..HALO + width];
        let t = &stencil.padded(below, k)[before..before + width];
        let x = &vector(above)[after..after + width];
        let y = &vector(below)[before..before + width];
        for i in 0..width {
            out[i] = minus::<T, ABSOLUTE>(t[i]).fused(y[i], minus::<T, ABSOLUTE>(s[i]).fused(x[i], out[i]));
        }
    }
}

/// The entries of one offset along node row `row`.
fn row_of(block: &Stencil<f64>, row: usize, dx: isize, dy: isize) -> &[f64] {
    &block.padded(row + HALO, offset_index(dx, dy))[HALO..]
}

/// `entries` = `weight` times `source`.
fn write<T: Real>(entries: &mut [T], source: &[f64], weight: f64) {
    for (entry, value) in entries.iter_mut().zip(source) {
        *entry = T::from_f64(weight * value);
    }
}

/// `entries` += `weight` times `source`.
fn add<T: Real>(entries: &mut [T], source: &[f64], weight: f64) {
    for (entry, value) in entries.iter_mut().zip(source) {
        *entry = *entry + T::from_f64(weight * value);
    }
}

/// -value, or -|value|.
#[inline(always)]
fn minus<T: Real, const ABSOLUTE: bool>(value: T) -> T {
    if ABSOLUTE { -value.magnitude() } else { -value }
}

/// value, or -|value|.
#[inline(always)]
fn plus<T: Real, const ABSOLUTE: bool>(value: T) -> T {
    if ABSOLUTE { -value.magnitude() } else { value }
}
