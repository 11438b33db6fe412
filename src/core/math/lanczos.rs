//! Extreme eigenvalues from conjugate gradients, whose coefficients are those of Lanczos' tridiagonal matrix
//! (Saad, *Iterative Methods for Sparse Linear Systems*, 2nd ed., Sec. 6.7.3).

/// The two scalars of one iteration of conjugate gradients.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coefficients {
    /// Length of the step along the direction.
    pub step: f64,
    /// Weight of the previous direction; 0 in the first iteration.
    pub beta: f64,
}

/// Bisections of an interval of eigenvalues: to all digits of a double, whose exponent and mantissa have 64 bits.
const BISECTIONS: usize = 64;

/// A lower bound of the preconditioned matrix's condition number from these iterations. None without iterations, or where
/// rounding left no eigenvalue positive.
pub fn condition(iterations: &[Coefficients]) -> Option<f64> {
    let (diagonal, squares) = tridiagonal(iterations);
    // Gershgorin: no eigenvalue is larger than the largest sum of a row.
    let off = |i: usize| squares.get(i).copied().unwrap_or_default().sqrt();
    let row = |(i, d): (usize, &f64)| d + off(i) + i.checked_sub(1).map_or(0.0, off);
    let most = diagonal.iter().enumerate().map(row).fold(0.0, f64::max);
    if !(most.is_finite() && most > 0.0) {
        return None;
    }
    // The k-th smallest lies where k - 1 are below and k are not; by their logarithm, for they may be far apart.
    let kth = |k: usize| {
        let (mut low, mut high) = ((most * f64::EPSILON.powi(2)).ln(), most.ln());
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (low + high);
            if below(&diagonal, &squares, middle.exp()) < k { low = middle } else { high = middle }
        }
        high.exp()
    };
    let (smallest, largest) = (kth(1), kth(diagonal.len()));
    (smallest > 0.0).then_some(largest / smallest)
}

/// The diagonal, and the squares beside it.
fn tridiagonal(iterations: &[Coefficients]) -> (Vec<f64>, Vec<f64>) {
    let mut before: Option<Coefficients> = None;
    let (mut diagonal, mut squares) = (Vec::new(), Vec::new());
    for &this in iterations {
        // The flexible beta may be negative by rounding once the residual is lost in it.
        let beta = this.beta.max(0.0);
        if let Some(before) = before {
            squares.push(beta / (before.step * before.step));
        }
        diagonal.push(1.0 / this.step + before.map_or(0.0, |before| beta / before.step));
        before = Some(this);
    }
    (diagonal, squares)
}

/// The number of eigenvalues below `value`: negative pivots of the matrix minus `value` (Sylvester).
fn below(diagonal: &[f64], squares: &[f64], value: f64) -> usize {
    let (mut pivot, mut count) = (1.0, 0);
    for (i, d) in diagonal.iter().enumerate() {
        let taken = if i == 0 { 0.0 } else { squares[i - 1] / pivot };
        pivot = d - value - taken;
        if pivot == 0.0 {
            pivot = -f64::MIN_POSITIVE;
        }
        count += usize::from(pivot < 0.0);
    }
    count
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// Conjugate gradients without preconditioner on a diagonal matrix, right side 1, so many iterations.
    fn iterate(matrix: &[f64], count: usize) -> Vec<Coefficients> {
        let (mut residual, mut direction) = (vec![1.0; matrix.len()], vec![0.0; matrix.len()]);
        let mut beta = 0.0;
        let square = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>();
        (0..count)
            .map(|_| {
                direction.iter_mut().zip(&residual).for_each(|(d, r)| *d = beta * *d + r);
                let energy: f64 = direction.iter().zip(matrix).map(|(d, a)| a * d * d).sum();
                let (before, this) = (square(&residual), beta);
                let step = before / energy;
                let image = direction.iter().zip(matrix).map(|(d, a)| a * d);
                residual.iter_mut().zip(image).for_each(|(r, image)| *r -= step * image);
                beta = square(&residual) / before;
                Coefficients { step, beta: this }
            })
            .collect()
    }

    #[test]
    fn as_many_iterations_as_eigenvalues_find_them_all() {
        for matrix in [vec![2.0], vec![1.0, 10.0], vec![0.01, 1.0, 2.0, 50.0], vec![1e-6, 1.0, 3.0]] {
            let (least, most) = (matrix[0], matrix[matrix.len() - 1]);
            let found = condition(&iterate(&matrix, matrix.len())).unwrap();
            // Rounding of the residual, times the condition.
            assert!((found / (most / least) - 1.0).abs() < 1e-9 * most / least, "{found} for {matrix:?}");
        }
    }

    #[test]
    fn fewer_iterations_see_less() {
        let matrix: Vec<f64> = (1..=40).map(f64::from).collect();
        let seen: Vec<f64> = (1..=30).map(|count| condition(&iterate(&matrix, count)).unwrap()).collect();
        // Eigenvalues interlace, so each iteration sees at least as much.
        assert!(seen.windows(2).all(|w| w[1] >= w[0] * (1.0 - 1e-12)), "{seen:?}");
        assert!(seen[0] == 1.0 && seen[29] > 39.0 && seen[29] < 40.0 + 1e-9, "{seen:?}");
    }

    #[test]
    fn no_iterations_and_spoilt_ones_tell_nothing() {
        assert_eq!(condition(&[]), None);
        assert_eq!(condition(&[Coefficients { step: f64::NAN, beta: 0.0 }]), None);
        assert_eq!(condition(&[Coefficients { step: -1.0, beta: 0.0 }]), None);
    }
}
