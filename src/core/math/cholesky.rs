//! Small dense systems, symmetric and positive definite.

/// The factor L of a symmetric positive definite matrix, A = L L^T, by rows.
#[derive(Clone, Debug)]
pub struct Cholesky {
    size: usize,
    lower: Vec<f64>,
}

impl Cholesky {
    /// Factors the matrix whose lower triangle is in `lower`, `size` rows. A pivot lost to rounding is set to a
    /// small positive one: the factor then belongs to a matrix close by.
    pub fn new(size: usize, mut lower: Vec<f64>) -> Self {
        let largest = (0..size).map(|i| lower[i * size + i]).fold(0.0, f64::max);
        let floor = (largest * 1e-14).max(f64::MIN_POSITIVE);
        for i in 0..size {
            let (above, row) = lower.split_at_mut(i * size);
            for k in 0..i {
                let partial = dot(&row[..k], &above[k * size..k * size + k]);
                row[k] = (row[k] - partial) / above[k * size + k];
            }
            row[i] = (row[i] - dot(&row[..i], &row[..i])).max(floor).sqrt();
        }
        Self { size, lower }
    }

    /// Overwrites the right side `b` with the solution.
    pub fn solve(&self, b: &mut [f64]) {
        let n = self.size;
        for i in 0..n {
            let row = &self.lower[i * n..];
            b[i] = (b[i] - dot(&row[..i], &b[..i])) / row[i];
        }
        for i in (0..n).rev() {
            let row = &self.lower[i * n..];
            b[i] /= row[i];
            let value = b[i];
            for (b, l) in b[..i].iter_mut().zip(row) {
                *b -= value * l;
            }
        }
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
