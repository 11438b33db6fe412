//! Unknowns on the nodes of a grid: one or two components, surrounded by zeros so that no stencil asks for a border.

use rayon::prelude::*;

use super::real::Real;
use super::tasks::rows_per_task;

/// Zeros on every side: how far a cubic spline reaches.
pub const HALO: usize = 3;
/// Operations for each number of a vector in a sum or product of vectors.
const OPERATIONS: usize = 2;

/// The nodes of a grid and the memory layout of a row.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Layout {
    /// Nodes along x and y.
    pub nodes: [usize; 2],
    /// Nodes along x, rounded up to whole vector registers. What lies beyond `nodes[0]` stays zero.
    pub width: usize,
    /// Numbers from one row to the next: halo, width, halo.
    pub stride: usize,
}

impl Layout {
    /// The layout of a grid with these nodes along x and y.
    pub fn new(nodes: [usize; 2]) -> Self {
        let width = nodes[0].next_multiple_of(8);
        Self { nodes, width, stride: (width + 2 * HALO).next_multiple_of(8) }
    }
}

/// `components` numbers per node, a row of each after the other.
#[derive(Clone, Debug, PartialEq)]
pub struct GridVector<T> {
    /// Where the nodes lie.
    pub layout: Layout,
    /// Numbers per node.
    pub components: usize,
    values: Vec<T>,
}

impl<T: Real> GridVector<T> {
    /// Zeros.
    pub fn zero(layout: Layout, components: usize) -> Self {
        let rows = layout.nodes[1] + 2 * HALO;
        Self { layout, components, values: vec![T::default(); rows * components * layout.stride] }
    }

    /// Numbers in one row of all components.
    pub fn row_len(&self) -> usize {
        self.components * self.layout.stride
    }

    /// Nodes of a row and component and the halo around: node 0 is at index `HALO`. Row `row` counts from the first
    /// halo row, so node row r is r + HALO.
    #[inline(always)]
    pub fn padded(&self, row: usize, component: usize) -> &[T] {
        let start = (row * self.components + component) * self.layout.stride;
        &self.values[start..start + self.layout.stride]
    }

    /// The number at node (x, y).
    pub fn at(&self, component: usize, x: usize, y: usize) -> T {
        self.padded(y + HALO, component)[x + HALO]
    }

    /// Sets the number at node (x, y).
    pub fn set(&mut self, component: usize, x: usize, y: usize, value: T) {
        let start = ((y + HALO) * self.components + component) * self.layout.stride;
        self.values[start + HALO + x] = value;
    }

    /// All node rows, halo rows left out.
    pub fn rows(&self) -> &[T] {
        let len = self.row_len();
        &self.values[HALO * len..(HALO + self.layout.nodes[1]) * len]
    }

    /// All node rows, halo rows left out.
    pub fn rows_mut(&mut self) -> &mut [T] {
        let len = self.row_len();
        &mut self.values[HALO * len..(HALO + self.layout.nodes[1]) * len]
    }

    /// All zeros again.
    pub fn clear(&mut self) {
        self.values.fill(T::default());
    }

    fn task_len(&self) -> usize {
        self.row_len() * rows_per_task(self.row_len(), OPERATIONS)
    }

    /// The scalar product, summed in an order that does not depend on the threads.
    pub fn dot(&self, other: &Self) -> f64 {
        let len = self.task_len();
        let sums: Vec<f64> = (self.rows().par_chunks(len).zip(other.rows().par_chunks(len)))
            .map(|(a, b)| {
                let mut lanes = [0.0f64; 8];
                for (a, b) in a.chunks_exact(8).zip(b.chunks_exact(8)) {
                    for i in 0..8 {
                        lanes[i] = a[i].to_f64().mul_add(b[i].to_f64(), lanes[i]);
                    }
                }
                lanes.iter().sum()
            })
            .collect();
        sums.iter().sum()
    }

    /// self = `scale` self + `factor` other.
    pub fn combine(&mut self, scale: T, factor: T, other: &Self) {
        let len = self.task_len();
        self.rows_mut().par_chunks_mut(len).zip(other.rows().par_chunks(len)).for_each(|(a, b)| {
            for (a, b) in a.iter_mut().zip(b) {
                *a = factor.fused(*b, scale * *a);
            }
        });
    }

    /// Projects out some orthonormal vectors.
    pub fn remove(&mut self, vectors: &[Self]) {
        for vector in vectors {
            let share = self.dot(vector);
            self.combine(T::from_f64(1.0), T::from_f64(-share), vector);
        }
    }

    /// self = `factor` other, in this vector's type.
    pub fn convert<U: Real>(&mut self, factor: f64, other: &GridVector<U>) {
        let len = self.task_len();
        self.rows_mut().par_chunks_mut(len).zip(other.rows().par_chunks(len)).for_each(|(a, b)| {
            for (a, b) in a.iter_mut().zip(b) {
                *a = T::from_f64(factor * b.to_f64());
            }
        });
    }

    /// Component `component` = `factor` times component `from` of `other`.
    pub fn set_component(&mut self, component: usize, factor: T, other: &Self, from: usize) {
        let (len, stride) = (self.row_len(), self.layout.stride);
        for (y, row) in self.rows_mut().chunks_exact_mut(len).enumerate() {
            let out = &mut row[component * stride..][..stride];
            for (out, &value) in out.iter_mut().zip(other.padded(y + HALO, from)) {
                *out = factor * value;
            }
        }
    }
}
