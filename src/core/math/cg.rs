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
    /// Error of the solution as the preconditioner M sees it, sqrt(r^T M^-1 r / energy) with the residual r. For an exact M it is that
    /// of x in the norm of A.
    pub error: f64,
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
    /// The square of a length that errors are relative to, in the norm of A.
    pub energy: f64,
}

/// Storage of conjugate gradients for vectors of one shape.
pub struct ConjugateGradients {
    residual: GridVector<f64>,
    previous: GridVector<f64>,
    direction: GridVector<f64>,
    /// -A direction.
    image: GridVector<f64>,
    preconditioned: GridVector<f64>,
    /// Of the iterations of the last solve.
    coefficients: Vec<Coefficients>,
}

impl ConjugateGradients {
    /// Storage for vectors like `shape`.
    pub fn new(shape: &GridVector<f64>) -> Self {
        let zero = || GridVector::zero(shape.layout, shape.components);
        Self {
            residual: zero(),
            previous: zero(),
            direction: zero(),
            image: zero(),
            preconditioned: zero(),
            coefficients: Vec::new(),
        }
    }

    /// A lower bound of the preconditioned matrix's condition number from the last solve; none without iterations.
    pub fn condition(&self) -> Option<f64> {
        condition(&self.coefficients)
    }

    /// Improves `x` until its error is at most `tolerance` or `max_iterations` are made. The residual alone tells little: where
    /// some rows weigh a million times what others do, it is theirs. The preconditioner works in single precision, so it is
    /// not quite the same linear map each time: beta is the flexible one (Notay 2000).
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
        let LinearSystem { operator, preconditioner, null, right, energy } = system;
        self.coefficients.clear();
        if right.dot(right) == 0.0 {
            x.clear();
            return Ok(Solved { iterations: 0, error: 0.0 });
        }
        self.residual.convert(1.0, right);
        operator.subtract_product(x, &mut self.residual);
        self.residual.remove(null);
        let mut rho = 1.0;
        let mut iterations = 0;
        loop {
            progress.check()?;
            let norm = self.residual.dot(&self.residual).sqrt();
            if norm == 0.0 {
                return Ok(Solved { iterations, error: 0.0 });
            }
            preconditioner.apply(&self.residual, norm, &mut self.preconditioned);
            let rho_new = self.preconditioned.dot(&self.residual);
            let error = (rho_new.abs() / energy).sqrt();
            if error <= tolerance || iterations >= max_iterations {
                return Ok(Solved { iterations, error });
            }
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
                return Ok(Solved { iterations, error });
            }
            self.coefficients.push(Coefficients { step, beta });
            x.combine(1.0, step, &self.direction);
            self.previous.convert(1.0, &self.residual);
            self.residual.combine(1.0, step, &self.image);
            // In exact arithmetic it is orthogonal to the null space; rounding errors in it would grow in the preconditioner.
            self.residual.remove(null);
            rho = rho_new;
            iterations += 1;
        }
    }
}
