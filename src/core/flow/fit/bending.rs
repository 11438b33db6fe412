//! The bending energy of Terms (4) and (5).
//!
//! Over tensor splines it is exactly a sum of products of one-dimensional integrals. Its natural boundary conditions are
//! the paper's outflow.

use crate::flow::field::Grid;
use crate::math::bspline::Band;
use crate::math::kronecker::Kronecker;

/// H, the diagonal block of B^T B: f^T H f is 1/|D| times the integral of f_xx^2 + 2 f_xy^2 + f_yy^2.
pub fn bending(grid: Grid) -> Kronecker {
    let [x, y] = [0, 1].map(|axis| {
        let width = grid.cell_size()[axis];
        [0, 1, 2].map(|order| Band::gram(grid.cells[axis], width, order))
    });
    let [x0, x1, x2] = x;
    let terms = [(x2, &y[0], 1.0), (x1, &y[1], 2.0), (x0, &y[2], 1.0)];
    Kronecker { terms: terms.map(|(x, y, weight)| (x, y.scaled(weight / grid.area()))).to_vec() }
}
