//! Small dense systems without any structure to rely on.

use glam::DVec2;

/// Solves A x = b for two right sides at once, by elimination with row pivots: `matrix` holds the n x n numbers of A by rows
/// and is used up, `right` holds b and becomes x. False, with `right` spoilt, where A is singular to rounding.
///
/// # Panics
/// When `matrix` has not n^2 numbers for the n rows of `right`.
pub fn solve(matrix: &mut [f64], right: &mut [DVec2]) -> bool {
    let n = right.len();
    assert_eq!(matrix.len(), n * n, "a square matrix of as many rows as the right side");
    let largest = matrix.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
    for k in 0..n {
        let size = |row: usize| matrix[row * n + k].abs();
        let pivot = (k + 1..n).fold(k, |best, row| if size(row) > size(best) { row } else { best });
        // NaN is not larger, and so singular, too.
        let regular = size(pivot) > f64::EPSILON * largest;
        if !regular {
            return false;
        }
        if pivot != k {
            let (upper, lower) = matrix.split_at_mut(pivot * n);
            upper[k * n..][..n].swap_with_slice(&mut lower[..n]);
            right.swap(k, pivot);
        }
        let (done, rest) = matrix.split_at_mut((k + 1) * n);
        let row = &done[k * n..];
        for (i, other) in rest.chunks_exact_mut(n).enumerate() {
            let factor = other[k] / row[k];
            for (value, above) in other[k..].iter_mut().zip(&row[k..]) {
                *value -= factor * above;
            }
            let taken = right[k] * factor;
            right[k + 1 + i] -= taken;
        }
    }
    for k in (0..n).rev() {
        let row = &matrix[k * n..][..n];
        let known: DVec2 = row[k + 1..].iter().zip(&right[k + 1..]).map(|(a, x)| *x * *a).sum();
        right[k] = (right[k] - known) / row[k];
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::dvec2;

    #[test]
    fn the_solution_fulfils_the_equations() {
        // A zero on the diagonal: without pivots this fails at once.
        let matrix = [0.0, 2.0, 1.0, 1.0, 1.0, 0.0, 3.0, 0.0, 1.0];
        let right = [dvec2(3.0, 1.0), dvec2(2.0, 0.0), dvec2(4.0, -2.0)];
        let mut x = right;
        assert!(solve(&mut matrix.clone(), &mut x));
        for (row, b) in matrix.chunks(3).zip(right) {
            let sum: DVec2 = row.iter().zip(x).map(|(a, x)| x * *a).sum();
            // Three products of numbers around 1.
            assert!((sum - b).length() < 1e-14, "{sum} {b}");
        }
    }

    #[test]
    fn a_singular_matrix_is_noticed() {
        assert!(!solve(&mut [1.0, 2.0, 2.0, 4.0], &mut [DVec2::ONE; 2]));
        assert!(!solve(&mut [f64::NAN], &mut [DVec2::ONE]));
        assert!(!solve(&mut [0.0], &mut [DVec2::ONE]));
        assert!(solve(&mut [], &mut []));
    }
}
