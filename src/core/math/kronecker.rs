//! Sums of products of one matrix along x and one along y: integrals over a rectangle of tensor splines.

use super::bspline::Band;
use super::real::Real;
use super::vector::{GridVector, HALO};

/// Sum over the terms of Y (x) X.
#[derive(Clone, Debug)]
pub struct Kronecker {
    /// Pairs (X, Y); weights are in one of the two.
    pub terms: Vec<(Band, Band)>,
}

impl Kronecker {
    /// Adds `weight` times the entries (node, node + (dx, dy)) of node row `row` to `entries`; dx of either sign.
    pub fn add_entries<T: Real>(&self, weight: f64, row: usize, dx: isize, dy: usize, entries: &mut [T]) {
        for (x, y) in &self.terms {
            let factor = weight * y.diagonals[dy][row];
            let diagonal = &x.diagonals[dx.unsigned_abs()];
            let shift = dx.min(0).unsigned_abs();
            // Entry (i, i + dx) for negative dx stands at i + dx.
            for (entry, value) in entries[shift..].iter_mut().zip(diagonal) {
                *entry = *entry + T::from_f64(factor * value);
            }
        }
    }

    /// Entry of node (x, y) and its neighbour at (x + dx, y + dy).
    pub fn entry(&self, [x, y]: [usize; 2], [dx, dy]: [isize; 2]) -> f64 {
        self.terms.iter().map(|(along_x, along_y)| along_x.entry(x, dx) * along_y.entry(y, dy)).sum()
    }

    /// The same on a coarser grid; an axis whose number of `nodes` stays is left as it is.
    pub fn coarsened(&self, nodes: [usize; 2]) -> Self {
        let coarsen = |band: &Band, nodes| {
            if band.diagonals[0].len() == nodes { band.clone() } else { band.coarsened(nodes) }
        };
        Self { terms: self.terms.iter().map(|(x, y)| (coarsen(x, nodes[0]), coarsen(y, nodes[1]))).collect() }
    }

    /// v^T K v of one component of a vector.
    pub fn quadratic_form(&self, vector: &GridVector<f64>, component: usize) -> f64 {
        let [nx, ny] = vector.layout.nodes;
        let mut sum = 0.0;
        let mut entries = vec![0.0; nx];
        for row in 0..ny {
            for (dx, dy) in super::stencil::offsets() {
                entries.fill(0.0);
                self.add_entries(1.0, row, dx, dy as usize, &mut entries);
                let here = &vector.padded(row + HALO, component)[HALO..];
                let there =
                    &vector.padded(row + HALO + dy as usize, component)[HALO.wrapping_add_signed(dx)..];
                let twice = if (dx, dy) == (0, 0) { 1.0 } else { 2.0 };
                sum += twice * (0..nx).map(|i| entries[i] * here[i] * there[i]).sum::<f64>();
            }
        }
        sum
    }
}
