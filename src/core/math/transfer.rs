//! Restriction and prolongation between nested spline spaces: a coarse function is a fine function, exactly.

use rayon::prelude::*;

use super::bspline::{EXTRA, REFINE};
use super::real::Real;
use super::tasks::rows_per_task;
use super::vector::{GridVector, HALO, Layout};

/// Operations for each number that is restricted or prolonged.
const OPERATIONS: usize = 8;

/// Nodes of an axis after its cells are merged in pairs; an odd number reaches half a coarse cell beyond the end.
pub fn coarse_nodes(nodes: usize) -> usize {
    (nodes - EXTRA).div_ceil(2) + EXTRA
}

/// Moves vectors between two grids.
#[derive(Clone, Debug)]
pub struct Transfer<T> {
    halved: [bool; 2],
    /// Rows of the fine grid, columns of the coarse one.
    between: GridVector<T>,
}

impl<T: Real> Transfer<T> {
    /// Between `fine` and `coarse`.
    pub fn new(fine: Layout, coarse: Layout, components: usize) -> Self {
        let halved = [0, 1].map(|axis| fine.nodes[axis] != coarse.nodes[axis]);
        let between = Layout::new([coarse.nodes[0], fine.nodes[1]]);
        Self { halved, between: GridVector::zero(between, components) }
    }

    /// coarse = R fine.
    pub fn restrict(&mut self, fine: &GridVector<T>, coarse: &mut GridVector<T>) {
        let halved = self.halved[0];
        let (stride, components) = (fine.layout.stride, fine.components);
        for_lines(&mut self.between, |line, out| {
            let line = &fine.rows()[line * stride..][..stride];
            restrict_line(halved, line, out);
        });
        let halved = self.halved[1];
        let between = &self.between;
        for_lines(coarse, |line, out| {
            let (row, component) = (line / components, line % components);
            if !halved {
                out.copy_from_slice(&between.padded(row + HALO, component)[HALO..HALO + out.len()]);
                return;
            }
            out.fill(T::default());
            for (k, &weight) in REFINE.iter().enumerate() {
                // Fine row 2 row - 3 + k; the halo is three rows deep.
                let row = 2 * row + k;
                if row < between.layout.nodes[1] + 2 * HALO {
                    add(out, T::from_f64(weight), &between.padded(row, component)[HALO..]);
                }
            }
        });
    }

    /// fine += R^T coarse.
    pub fn prolong_add(&mut self, coarse: &GridVector<T>, fine: &mut GridVector<T>) {
        let components = fine.components;
        let halved = self.halved[1];
        for_lines(&mut self.between, |line, out| {
            let (row, component) = (line / components, line % components);
            out.fill(T::default());
            if !halved {
                return add(out, T::from_f64(1.0), &coarse.padded(row + HALO, component)[HALO..]);
            }
            // Fine row i is reached from coarse rows J with k = i + 3 - 2 J in 0..5.
            for k in (0..5).filter(|k| (row + k) % 2 == 1) {
                let from = (row + 3 - k) / 2;
                add(out, T::from_f64(REFINE[k]), &coarse.padded(from + HALO, component)[HALO..]);
            }
        });
        let halved = self.halved[0];
        let (between, stride, nodes) = (&self.between, self.between.layout.stride, fine.layout.nodes[0]);
        for_lines(fine, |line, out| {
            let line = &between.rows()[line * stride..][..stride];
            if halved {
                prolong_line(line, out);
                out[nodes..].fill(T::default());
            } else {
                add(out, T::from_f64(1.0), &line[HALO..]);
            }
        });
    }
}

/// Runs over all lines (rows of one component, halo left out) of a vector.
fn for_lines<T: Real>(vector: &mut GridVector<T>, work: impl Fn(usize, &mut [T]) + Sync) {
    let Layout { stride, width, .. } = vector.layout;
    let lines = rows_per_task(stride, OPERATIONS);
    vector.rows_mut().par_chunks_mut(lines * stride).enumerate().for_each(|(task, part)| {
        for (i, line) in part.chunks_exact_mut(stride).enumerate() {
            work(task * lines + i, &mut line[HALO..HALO + width]);
        }
    });
}

fn add<T: Real>(out: &mut [T], weight: T, line: &[T]) {
    for (out, &value) in out.iter_mut().zip(line) {
        *out = weight.fused(value, *out);
    }
}

fn restrict_line<T: Real>(halved: bool, line: &[T], out: &mut [T]) {
    if !halved {
        out.copy_from_slice(&line[HALO..HALO + out.len()]);
        return;
    }
    let weight = REFINE.map(T::from_f64);
    for (out, line) in out.iter_mut().zip(line.windows(5).step_by(2)) {
        let even = weight[0] * (line[0] + line[4]);
        *out = weight[2].fused(line[2], weight[1].fused(line[1] + line[3], even));
    }
}

fn prolong_line<T: Real>(line: &[T], out: &mut [T]) {
    let weight = REFINE.map(T::from_f64);
    // Fine node 2 m takes coarse m + 1 (k = 1) and m (k = 3); node 2 m + 1 takes m + 2, m + 1, m (k = 0, 2, 4).
    for (pair, from) in out.chunks_exact_mut(2).zip(line[HALO..].windows(3)) {
        pair[0] = weight[1].fused(from[0] + from[1], pair[0]);
        pair[1] = weight[2].fused(from[1], weight[0].fused(from[0] + from[2], pair[1]));
    }
}
