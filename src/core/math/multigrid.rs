//! One multigrid V-cycle as a preconditioner (Galerkin grids, Chebyshev smoothing, a direct solve at the end).
//!
//! Chebyshev smoothing by the diagonal: Adams, Brezina, Hu, Tuminaro, "Parallel multigrid smoothing: polynomial versus
//! Gauss-Seidel", J. Comput. Phys. 188 (2003). It is symmetric, needs only products with the matrix, and gives the
//! same bits for any number of threads.

use rayon::prelude::*;

use super::cholesky::Cholesky;
use super::normal_blocks::{NormalBlocks, Weights};
use super::null_space::NullSpace;
use super::operator::Operator;
use super::real::Real;
use super::transfer::{Transfer, coarse_nodes};
use super::vector::{GridVector, Layout};

/// Axes with fewer nodes than this are not coarsened further: 4 cells and the 3 functions that reach beyond.
const COARSEST: usize = 7;
/// Degree of the smoother: products with the matrix on each side of the coarse grid.
const DEGREE: usize = 3;
/// The smoother acts on the eigenvalues of the scaled matrix from here to 1, their upper bound.
const SMOOTHED: f64 = 0.06;

/// A hierarchy of grids for one matrix.
pub struct Multigrid {
    levels: Vec<Level>,
    coarsest: Coarsest,
}

struct Level {
    operator: Operator<f32>,
    transfer: Transfer<f32>,
    solution: GridVector<f32>,
    residual: GridVector<f32>,
    steps: [GridVector<f32>; 2],
    coarse_right: GridVector<f32>,
    coarse_solution: GridVector<f32>,
}

struct Coarsest {
    layout: Layout,
    null: Vec<GridVector<f64>>,
    /// One over the square root of the diagonal: a spline of which only a corner lies on the grid counts like any other.
    scale: Vec<f64>,
    /// Of the scaled matrix.
    factor: Cholesky,
    /// The null space of the scaled matrix, orthonormal.
    scaled_null: Vec<Vec<f64>>,
    numbers: Vec<f64>,
}

impl Multigrid {
    /// The hierarchy below a grid of `layout` with such cells, for a matrix that is zero on `null` and nowhere else.
    pub fn new(mut layout: Layout, mut cell: [f64; 2], null: &NullSpace) -> Self {
        let mut levels = Vec::new();
        // Each grid has fewer nodes than the one before.
        loop {
            let nodes = next_nodes(layout.nodes, cell);
            if nodes == layout.nodes {
                return Self { levels, coarsest: Coarsest::new(layout, null.vectors(layout, cell)) };
            }
            levels.push(Level::new(layout, Layout::new(nodes), null.components()));
            cell = [0, 1]
                .map(|axis| if nodes[axis] == layout.nodes[axis] { cell[axis] } else { 2.0 * cell[axis] });
            layout = Layout::new(nodes);
        }
    }

    /// Sets the matrix on all grids.
    pub fn set(&mut self, blocks: &NormalBlocks, weights: Weights) {
        let mut coarse: Option<NormalBlocks> = None;
        for level in &mut self.levels {
            let fine = coarse.as_ref().unwrap_or(blocks);
            level.operator.set(fine, weights);
            coarse = Some(fine.coarsened(level.coarse_right.layout.nodes));
        }
        self.coarsest.set(coarse.as_ref().unwrap_or(blocks), weights);
    }

    /// `solution` = V-cycle for `right`, from zero.
    pub fn apply(&mut self, right: &GridVector<f32>, solution: &mut GridVector<f32>) {
        cycle(&mut self.levels, &mut self.coarsest, right, solution);
    }
}

fn cycle(
    levels: &mut [Level],
    coarsest: &mut Coarsest,
    right: &GridVector<f32>,
    solution: &mut GridVector<f32>,
) {
    let Some((level, coarser)) = levels.split_first_mut() else {
        return coarsest.solve(right, solution);
    };
    level.residual.convert(1.0, right);
    level.solution.clear();
    level.smooth();
    level.operator.subtract_product(&level.steps[0], &mut level.residual);
    level.transfer.restrict(&level.residual, &mut level.coarse_right);
    cycle(coarser, coarsest, &level.coarse_right, &mut level.coarse_solution);
    level.steps[0].clear();
    level.transfer.prolong_add(&level.coarse_solution, &mut level.steps[0]);
    level.solution.combine(1.0, 1.0, &level.steps[0]);
    level.operator.subtract_product(&level.steps[0], &mut level.residual);
    level.smooth();
    solution.convert(1.0, &level.solution);
}

/// Nodes of the next grid: the axes with the narrower cells are coarsened, so that cells become square.
fn next_nodes(nodes: [usize; 2], cell: [f64; 2]) -> [usize; 2] {
    let width = [0, 1].map(|axis| if nodes[axis] > COARSEST { cell[axis] } else { f64::INFINITY });
    let narrowest = width[0].min(width[1]);
    [0, 1].map(|axis| {
        let narrow = width[axis].is_finite() && width[axis] < 1.5 * narrowest;
        if narrow { coarse_nodes(nodes[axis]) } else { nodes[axis] }
    })
}

impl Level {
    fn new(fine: Layout, coarse: Layout, components: usize) -> Self {
        let zero = |layout| GridVector::zero(layout, components);
        Self {
            operator: Operator::zero(fine, components),
            transfer: Transfer::new(fine, coarse, components),
            solution: zero(fine),
            residual: zero(fine),
            steps: [zero(fine), zero(fine)],
            coarse_right: zero(coarse),
            coarse_solution: zero(coarse),
        }
    }

    /// Improves the solution by a Chebyshev polynomial in the residual. The last step is left in `steps[0]`, not yet
    /// taken off the residual.
    fn smooth(&mut self) {
        let (centre, half) = (0.5 * (1.0 + SMOOTHED), 0.5 * (1.0 - SMOOTHED));
        let mut rho = half / centre;
        self.step(0.0, 1.0 / centre);
        for _ in 1..DEGREE {
            let next = 1.0 / (2.0 * centre / half - rho);
            self.step(next * rho, 2.0 * next / half);
            rho = next;
        }
    }

    /// residual -= M step; step = keep step + factor diag^-1 residual; solution += step.
    fn step(&mut self, keep: f64, factor: f64) {
        let (operator, inverse) = (&self.operator, &self.operator.inverse_diagonal);
        let [old, new] = &mut self.steps;
        let (len, rows) = (old.row_len(), operator.layout.rows_per_task());
        let (old_rows, old, keep, factor) = (old.rows(), &*old, keep as f32, factor as f32);
        let parts = self.residual.rows_mut().par_chunks_mut(len * rows);
        let parts = parts.zip(new.rows_mut().par_chunks_mut(len * rows));
        let parts = parts.zip(self.solution.rows_mut().par_chunks_mut(len * rows)).enumerate();
        parts.for_each(|(task, ((residual, new), solution))| {
            let parts = residual.chunks_exact_mut(len).zip(new.chunks_exact_mut(len));
            let parts = parts.zip(solution.chunks_exact_mut(len)).enumerate();
            for (i, ((residual, new), solution)) in parts {
                let row = task * rows + i;
                let span = row * len..(row + 1) * len;
                let (old_row, inverse) = (&old_rows[span.clone()], &inverse.rows()[span]);
                if keep != 0.0 {
                    operator.subtract_row::<false>(row, old, residual);
                }
                for i in 0..len {
                    let old = if keep != 0.0 { keep * old_row[i] } else { 0.0 };
                    new[i] = (factor * inverse[i]).mul_add(residual[i], old);
                    solution[i] += new[i];
                }
            }
        });
        self.steps.swap(0, 1);
    }
}

impl Coarsest {
    fn new(layout: Layout, null: Vec<GridVector<f64>>) -> Self {
        let size = null[0].components * layout.nodes[0] * layout.nodes[1];
        let (factor, zeros) = (Cholesky::new(0, Vec::new()), vec![0.0; size]);
        Self { layout, null, scale: zeros.clone(), factor, scaled_null: Vec::new(), numbers: zeros }
    }

    fn set(&mut self, blocks: &NormalBlocks, weights: Weights) {
        let ([nx, ny], components, size) = (self.layout.nodes, self.null[0].components, self.numbers.len());
        let mut operator = Operator::<f64>::zero(self.layout, components);
        operator.set(blocks, weights);
        let mut matrix = vec![0.0; size * size];
        let index = |component: usize, x: usize, y: usize| (component * ny + y) * nx + x;
        for (i, k) in (0..components).flat_map(|i| (0..components).map(move |k| (i, k))) {
            for (y, x) in (0..ny).flat_map(|y| (0..nx).map(move |x| (y, x))) {
                for (dy, dx) in (-3..4).flat_map(|dy| (-3..4).map(move |dx| (dy, dx))) {
                    let (to_x, to_y) = (x.wrapping_add_signed(dx), y.wrapping_add_signed(dy));
                    if to_x < nx && to_y < ny {
                        matrix[index(i, x, y) * size + index(k, to_x, to_y)] =
                            operator.entry([i, k], x, y, dx, dy);
                    }
                }
            }
        }
        for (i, scale) in self.scale.iter_mut().enumerate() {
            let diagonal = matrix[i * size + i];
            *scale = if diagonal > 0.0 { 1.0 / diagonal.sqrt() } else { 1.0 };
        }
        self.scaled_null = scaled(&self.null, &self.scale);
        for (row, (i, scale)) in matrix.chunks_exact_mut(size).zip(self.scale.iter().enumerate()) {
            for (k, value) in row.iter_mut().enumerate() {
                // The null space gets eigenvalues of 1; nothing else changes.
                let null: f64 = self.scaled_null.iter().map(|vector| vector[i] * vector[k]).sum();
                *value = *value * scale * self.scale[k] + null;
            }
        }
        self.factor = Cholesky::new(size, matrix);
    }

    /// The part of `right` in the null space, which is rounding error, is removed: it would be amplified.
    fn solve(&mut self, right: &GridVector<f32>, solution: &mut GridVector<f32>) {
        for (i, value) in self.numbers.iter_mut().enumerate() {
            *value = self.scale[i] * f64::from(number(right, i));
        }
        for vector in &self.scaled_null {
            remove(&mut self.numbers, vector);
        }
        self.factor.solve(&mut self.numbers);
        let [nx, ny] = self.layout.nodes;
        for (i, &value) in self.numbers.iter().enumerate() {
            solution.set(i / (nx * ny), i % nx, i / nx % ny, (self.scale[i] * value) as f32);
        }
    }
}

/// The vectors over `scale`, orthonormal.
fn scaled(vectors: &[GridVector<f64>], scale: &[f64]) -> Vec<Vec<f64>> {
    let mut out: Vec<Vec<f64>> = Vec::new();
    for vector in vectors {
        let mut scaled: Vec<f64> = scale.iter().enumerate().map(|(i, s)| number(vector, i) / s).collect();
        out.iter().for_each(|other| remove(&mut scaled, other));
        let norm = scaled.iter().map(|a| a * a).sum::<f64>().sqrt();
        scaled.iter_mut().for_each(|a| *a /= norm);
        out.push(scaled);
    }
    out
}

/// Takes the share in `unit`, of length 1, out of `vector`.
fn remove(vector: &mut [f64], unit: &[f64]) {
    let share: f64 = vector.iter().zip(unit).map(|(a, b)| a * b).sum();
    vector.iter_mut().zip(unit).for_each(|(a, b)| *a -= share * b);
}

/// The `i`-th unknown: components one after the other, each row by row.
fn number<T: Real>(vector: &GridVector<T>, i: usize) -> T {
    let [nx, ny] = vector.layout.nodes;
    vector.at(i / (nx * ny), i % nx, i / nx % ny)
}
