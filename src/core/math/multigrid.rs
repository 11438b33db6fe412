//! One multigrid V-cycle as a preconditioner: Galerkin grids, Chebyshev smoothing, a direct solve at the end, and on every
//! grid direct solves of the stiff nodes around the smoothing, where they are asked for.
//!
//! Chebyshev smoothing by the diagonal: Adams, Brezina, Hu, Tuminaro, "Parallel multigrid smoothing: polynomial versus
//! Gauss-Seidel", J. Comput. Phys. 188 (2003). It is symmetric, needs only products with the matrix, and gives the
//! same bits for any number of threads.

use rayon::prelude::*;

use super::direct::Direct;
use super::dissection::Dissection;
use super::normal_blocks::{NormalBlocks, Weights};
use super::null_space::NullSpace;
use super::operator::Operator;
use super::stiff_nodes::stiff_nodes;
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
    null: NullSpace,
    levels: Vec<Level>,
    coarsest: Coarsest,
    single: [GridVector<f32>; 2],
}

struct Level {
    cell: [f64; 2],
    operator: Operator<f32>,
    /// The nodes that are solved exactly.
    exact: Option<Direct>,
    transfer: Transfer<f32>,
    solution: GridVector<f32>,
    residual: GridVector<f32>,
    steps: [GridVector<f32>; 2],
    coarse_right: GridVector<f32>,
    coarse_solution: GridVector<f32>,
}

/// The coarsest grid, solved exactly.
struct Coarsest {
    layout: Layout,
    null: Vec<GridVector<f64>>,
    solver: Option<Direct>,
}

impl Multigrid {
    /// The hierarchy below a grid of `layout` with such cells, for a matrix that is zero on `null` and nowhere else.
    pub fn new(mut layout: Layout, mut cell: [f64; 2], null: &NullSpace) -> Self {
        let mut levels = Vec::new();
        let single = [(); 2].map(|()| GridVector::zero(layout, null.components()));
        // Each grid has fewer nodes than the one before.
        loop {
            let nodes = next_nodes(layout.nodes, cell);
            if nodes == layout.nodes {
                let coarsest = Coarsest { layout, null: null.vectors(layout, cell), solver: None };
                return Self { null: null.clone(), levels, coarsest, single };
            }
            levels.push(Level::new((layout, cell), Layout::new(nodes), null.components()));
            cell = [0, 1]
                .map(|axis| if nodes[axis] == layout.nodes[axis] { cell[axis] } else { 2.0 * cell[axis] });
            layout = Layout::new(nodes);
        }
    }

    /// Sets the matrix on all grids; its stiff nodes are solved exactly if `exact`.
    pub fn set(&mut self, blocks: &NormalBlocks, weights: Weights, exact: bool) {
        let mut coarse: Option<NormalBlocks> = None;
        for level in &mut self.levels {
            let fine = coarse.as_ref().unwrap_or(blocks);
            level.operator.set(fine, weights);
            let grid = (level.operator.layout, level.cell);
            level.exact = if exact { stiff_nodes(grid, fine, weights, &self.null) } else { None };
            coarse = Some(fine.coarsened(level.coarse_right.layout.nodes));
        }
        self.coarsest.set(coarse.as_ref().unwrap_or(blocks), weights);
    }

    /// `solution` = V-cycle for `right`, of length `norm`, from zero.
    pub fn apply(&mut self, right: &GridVector<f64>, norm: f64, solution: &mut GridVector<f64>) {
        let [single, solved] = &mut self.single;
        single.convert(1.0 / norm, right);
        cycle(&mut self.levels, &mut self.coarsest, single, solved);
        solution.convert(norm, solved);
        // Single precision would pull at the stiff rows again.
        if let Some(exact) = self.levels.first().and_then(|finest| finest.exact.as_ref()) {
            exact.write(norm, solution);
        }
    }
}

fn cycle(
    levels: &mut [Level],
    coarsest: &mut Coarsest,
    right: &GridVector<f32>,
    solution: &mut GridVector<f32>,
) {
    let Some((level, coarser)) = levels.split_first_mut() else {
        if let Some(solver) = &mut coarsest.solver {
            solver.solve(right, solution);
        }
        return;
    };
    level.begin(right);
    level.smooth();
    level.operator.subtract_product(&level.steps[0], &mut level.residual);
    level.transfer.restrict(&level.residual, &mut level.coarse_right);
    cycle(coarser, coarsest, &level.coarse_right, &mut level.coarse_solution);
    level.steps[0].clear();
    level.transfer.prolong_add(&level.coarse_solution, &mut level.steps[0]);
    level.solution.combine(1.0, 1.0, &level.steps[0]);
    level.operator.subtract_product(&level.steps[0], &mut level.residual);
    level.smooth();
    level.end(right);
    solution.convert(1.0, &level.solution);
}

/// Nodes of the next grid: the axes with the narrower cells are coarsened, so that cells become square. Where these are few
/// already, a grid along the other axis would see the weak couplings only: it is the coarsest.
fn next_nodes(nodes: [usize; 2], cell: [f64; 2]) -> [usize; 2] {
    let narrowest = cell[0].min(cell[1]);
    [0, 1].map(|axis| {
        let narrow = nodes[axis] > COARSEST && cell[axis] < 1.5 * narrowest;
        if narrow { coarse_nodes(nodes[axis]) } else { nodes[axis] }
    })
}

impl Coarsest {
    fn set(&mut self, blocks: &NormalBlocks, weights: Weights) {
        let [nx, ny] = self.layout.nodes;
        let nodes = (0..ny).flat_map(|y| (0..nx).map(move |x| [x, y])).collect();
        let dissection = Dissection::new(nodes, self.layout.nodes);
        self.solver = Some(Direct::new(dissection, self.null[0].components, (blocks, weights), &self.null));
    }
}

impl Level {
    fn new((fine, cell): (Layout, [f64; 2]), coarse: Layout, components: usize) -> Self {
        let zero = |layout| GridVector::zero(layout, components);
        Self {
            cell,
            operator: Operator::zero(fine, components),
            exact: None,
            transfer: Transfer::new(fine, coarse, components),
            solution: zero(fine),
            residual: zero(fine),
            steps: [zero(fine), zero(fine)],
            coarse_right: zero(coarse),
            coarse_solution: zero(coarse),
        }
    }

    /// Begins with the exact solution of the stiff nodes, or at zero.
    fn begin(&mut self, right: &GridVector<f32>) {
        self.residual.convert(1.0, right);
        self.solution.clear();
        if let Some(exact) = &mut self.exact {
            exact.solve(right, &mut self.solution);
            self.operator.subtract_product(&self.solution, &mut self.residual);
            // Rounding of large products.
            exact.clear(&mut self.residual);
        }
    }

    /// Solves the stiff nodes anew, whatever their values, with the others as they are. So no product with a stiff entry
    /// has to be exact.
    fn end(&mut self, right: &GridVector<f32>) {
        if let Some(exact) = &mut self.exact {
            exact.clear(&mut self.solution);
            self.residual.convert(1.0, right);
            self.operator.subtract_product(&self.solution, &mut self.residual);
            exact.solve(&self.residual, &mut self.solution);
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
        let (len, rows) = (old.row_len(), operator.rows_per_task());
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
