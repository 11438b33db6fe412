//! Exact solves of the matrix of Eq. (7) for some nodes of a grid, the others at rest.

use super::dissection::Dissection;
use super::normal_blocks::{NormalBlocks, Weights};
use super::real::Real;
use super::sparse_cholesky::SparseCholesky;
use super::vector::GridVector;

/// A factored matrix over some nodes.
pub(super) struct Direct {
    components: usize,
    /// One over the square root of the diagonal: a spline of which only a corner lies on the grid counts like any other.
    scale: Vec<f64>,
    /// Of the scaled matrix.
    factor: SparseCholesky,
    /// The null space of the scaled matrix, orthonormal.
    null: Vec<Vec<f64>>,
    numbers: Vec<f64>,
}

impl Direct {
    /// Factors the matrix over the nodes of `dissection`. `null` spans its null space; it is empty where nodes are left out.
    pub(super) fn new(
        dissection: Dissection,
        components: usize,
        (blocks, weights): (&NormalBlocks, Weights),
        null: &[GridVector<f64>],
    ) -> Self {
        let order = &dissection.order;
        let all = || order.iter().flat_map(|&at| (0..components).map(move |k| (k, at)));
        let unit = |(k, at)| {
            let diagonal = blocks.entry(weights, [k, k], at, [0, 0]);
            if diagonal > 0.0 { 1.0 / diagonal.sqrt() } else { 1.0 }
        };
        let scale: Vec<f64> = all().map(unit).collect();
        let over = |vector: &GridVector<f64>| {
            all().zip(&scale).map(|((k, [x, y]), s)| vector.at(k, x, y) / s).collect::<Vec<f64>>()
        };
        let null = orthonormal(null.iter().map(over));
        let held = held(&null);
        let order = dissection.order.clone();
        let entry = |[from, to]: [usize; 2], offset: [isize; 2], [i, k]: [usize; 2]| {
            let (row, column) = (components * from + i, components * to + k);
            let value = blocks.entry(weights, [i, k], order[from], offset) * scale[row] * scale[column];
            // A spring at one unknown for each null vector; a right side without share in them does not pull at it.
            value + f64::from(u8::from(row == column && held.contains(&row)))
        };
        let factor = SparseCholesky::new(dissection, components, entry);
        Self { components, numbers: vec![0.0; scale.len()], scale, factor, null }
    }

    /// Writes the solution for `right` at its nodes into `solution`, with which other nodes have nothing to do. What lies in
    /// the null space is rounding error, and is removed: it would be amplified.
    pub(super) fn solve(&mut self, right: &GridVector<f32>, solution: &mut GridVector<f32>) {
        for (i, scale) in self.scale.iter().enumerate() {
            let (k, [x, y]) = self.unknown(i);
            self.numbers[i] = scale * f64::from(right.at(k, x, y));
        }
        self.null.iter().for_each(|vector| remove(&mut self.numbers, vector));
        self.factor.solve(&mut self.numbers);
        self.null.iter().for_each(|vector| remove(&mut self.numbers, vector));
        self.write(1.0, solution);
    }

    /// Writes `factor` times the last solution.
    pub(super) fn write<T: Real>(&self, factor: f64, out: &mut GridVector<T>) {
        for (i, (scale, value)) in self.scale.iter().zip(&self.numbers).enumerate() {
            let (k, [x, y]) = self.unknown(i);
            out.set(k, x, y, T::from_f64(factor * scale * value));
        }
    }

    /// Sets its nodes to zero.
    pub(super) fn clear(&self, vector: &mut GridVector<f32>) {
        for i in 0..self.scale.len() {
            let (k, [x, y]) = self.unknown(i);
            vector.set(k, x, y, 0.0);
        }
    }

    fn unknown(&self, i: usize) -> (usize, [usize; 2]) {
        (i % self.components, self.factor.dissection.order[i / self.components])
    }
}

fn orthonormal(vectors: impl Iterator<Item = Vec<f64>>) -> Vec<Vec<f64>> {
    let mut out: Vec<Vec<f64>> = Vec::new();
    for mut vector in vectors {
        out.iter().for_each(|other| remove(&mut vector, other));
        let norm = vector.iter().map(|a| a * a).sum::<f64>().sqrt();
        vector.iter_mut().for_each(|a| *a /= norm);
        out.push(vector);
    }
    out
}

/// As many unknowns as there are vectors, at which these differ most: once they are held, none of them is free.
fn held(vectors: &[Vec<f64>]) -> Vec<usize> {
    let mut rest = vectors.to_vec();
    let mut held = Vec::new();
    while let Some(first) = rest.first() {
        let square = |i: usize| rest.iter().map(|vector| vector[i] * vector[i]).sum::<f64>();
        let place = (0..first.len()).max_by(|&a, &b| square(a).total_cmp(&square(b))).unwrap_or_default();
        let by = (0..rest.len()).max_by(|&a, &b| rest[a][place].abs().total_cmp(&rest[b][place].abs()));
        let pivot = rest.swap_remove(by.unwrap_or_default());
        for vector in &mut rest {
            let share = vector[place] / pivot[place];
            vector.iter_mut().zip(&pivot).for_each(|(a, b)| *a -= share * b);
        }
        held.push(place);
    }
    held
}

/// Takes the share in `unit`, of length 1, out of `vector`.
fn remove(vector: &mut [f64], unit: &[f64]) {
    let share: f64 = vector.iter().zip(unit).map(|(a, b)| a * b).sum();
    vector.iter_mut().zip(unit).for_each(|(a, b)| *a -= share * b);
}
