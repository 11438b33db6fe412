//! Preconditioned conjugate gradients.

use super::lanczos::{Coefficients, condition};
use super::multigrid::Multigrid;
use super::operator::Operator;
use super::vector::GridVector;
use crate::{Progress, Result};

/// Statistics of a solve.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Solved {
    /// Iterations made.
    pub iterations: usize,
    /// |b - A x| / |b|.
    pub residual: f64,
}

/// A x = b.
pub struct LinearSystem<'a> {
    /// A.
    pub operator: &'a Operator<f64>,
    /// An approximate inverse of A.
    pub preconditioner: &'a mut Multigrid,
    /// An orthonormal basis of the null space of A, to which b is orthogonal.
    pub null: &'a [GridVector<f64>],
    /// b.
    pub right: &'a GridVector<f64>,
}

/// Storage of conjugate gradients for vectors of one shape.
pub struct ConjugateGradients {
    residual: GridVector<f64>,
    previous: GridVector<f64>,
    direction: GridVector<f64>,
    /// -A direction.
    image: GridVector<f64>,
    preconditioned: GridVector<f64>,
    single: [GridVector<f32>; 2],
    /// Of the iterations of the last solve.
    coefficients: Vec<Coefficients>,
}

impl ConjugateGradients {
    /// Storage for vectors like `shape`.
    pub fn new(shape: &GridVector<f64>) -> Self {
        let zero = || GridVector::zero(shape.layout, shape.components);
        let single = || GridVector::zero(shape.layout, shape.components);
        Self {
            residual: zero(),
            previous: zero(),
            direction: zero(),
            image: zero(),
            preconditioned: zero(),
            single: [single(), single()],
            coefficients: Vec::new(),
        }
    }

    /// A lower bound of the preconditioned matrix's condition number from the last solve; none without iterations.
    pub fn condition(&self) -> Option<f64> {
        condition(&self.coefficients)
    }

    /// Improves `x` until |b - A x| <= `tolerance` |b| or `max_iterations` are made. The preconditioner works in single
    /// precision, so it is not quite the same linear map each time: beta is the flexible one (Notay 2000).
    ///
    /// # Errors
    /// `Cancelled`.
    pub fn solve(
        &mut self,
        system: LinearSystem,
        x: &mut GridVector<f64>,
        (tolerance, max_iterations): (f64, usize),
        progress: &Progress,
    ) -> Result<Solved> {
        let LinearSystem { operator, preconditioner, null, right } = system;
        self.coefficients.clear();
        let scale = right.dot(right).sqrt();
        if scale == 0.0 {
            x.clear();
            return Ok(Solved { iterations: 0, residual: 0.0 });
        }
        self.residual.convert(1.0, right);
        operator.subtract_product(x, &mut self.residual);
        self.residual.remove(null);
        let mut norm = self.residual.dot(&self.residual).sqrt();
        let mut rho = 1.0;
        let mut iterations = 0;
        while norm > tolerance * scale && iterations < max_iterations {
            progress.check()?;
            self.single[0].convert(1.0 / norm, &self.residual);
            let [right, solution] = &mut self.single;
            preconditioner.apply(right, solution);
            self.preconditioned.convert(norm, solution);
            let rho_new = self.preconditioned.dot(&self.residual);
            let beta =
                if iterations == 0 { 0.0 } else { (rho_new - self.preconditioned.dot(&self.previous)) / rho };
            if iterations == 0 {
                self.direction.clear();
            }
            self.direction.combine(beta, 1.0, &self.preconditioned);
            self.image.clear();
            operator.subtract_product(&self.direction, &mut self.image);
            let step = self.direction.dot(&self.residual) / -self.direction.dot(&self.image);
            if !(step.is_finite() && rho_new > 0.0) {
                break;
            }
            self.coefficients.push(Coefficients { step, beta });
            x.combine(1.0, step, &self.direction);
            self.previous.convert(1.0, &self.residual);
            self.residual.combine(1.0, step, &self.image);
            // In exact arithmetic it is orthogonal to the null space; rounding errors in it would grow in the preconditioner.
            self.residual.remove(null);
            norm = self.residual.dot(&self.residual).sqrt();
            rho = rho_new;
            iterations += 1;
        }
        Ok(Solved { iterations, residual: norm / scale })
    }
}
