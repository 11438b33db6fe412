//! Integrals of products of splines that live on grids of different cell width.

use super::bspline::{self, EXTRA, GAUSS};

/// One axis of a grid that begins at 0.
#[derive(Clone, Copy, Debug)]
pub struct Axis {
    /// Cells, 1 or more.
    pub cells: usize,
    /// Width of a cell, > 0.
    pub width: f64,
}

/// Entry (i, j) is the integral over `[0, length]` of function i of one axis times function j of another.
#[derive(Clone, Debug)]
pub struct MixedGram {
    /// Of each row: its first column, and the entries from there on.
    rows: Vec<(usize, Vec<f64>)>,
}

impl MixedGram {
    /// Exact integrals of the products of derivatives of `order` 0, 1 or 2. The last cells may reach beyond `length`, which
    /// both axes must cover.
    pub fn new(a: Axis, b: Axis, length: f64, order: usize) -> Self {
        let derivative = [bspline::values, bspline::slopes, bspline::curvatures][order];
        let scale = (a.width * b.width).powi(-(order as i32));
        let mut rows: Vec<(usize, Vec<f64>)> = vec![(usize::MAX, Vec::new()); a.cells + EXTRA];
        for (from, to) in pieces(a, b, length) {
            let half = 0.5 * (to - from);
            // Within a piece both factors are polynomials of degree 3 at most.
            let cell = |axis: Axis| (((from + half) / axis.width) as usize).min(axis.cells - 1);
            let (in_a, in_b) = (cell(a), cell(b));
            for (x, weight) in GAUSS {
                let x = from + half * (1.0 + x);
                let at_a = derivative(x / a.width - in_a as f64);
                let at_b = derivative(x / b.width - in_b as f64);
                for i in 0..4 {
                    let (first, entries) = &mut rows[in_a + i];
                    *first = in_b.min(*first);
                    let start = in_b - *first;
                    entries.resize(entries.len().max(start + 4), 0.0);
                    for k in 0..4 {
                        entries[start + k] += half * weight * scale * at_a[i] * at_b[k];
                    }
                }
            }
        }
        // Functions that end before `length` have no entries.
        rows.iter_mut().filter(|(_, entries)| entries.is_empty()).for_each(|(first, _)| *first = 0);
        Self { rows }
    }

    /// Row `i`: its first column, and the entries from there on.
    #[inline]
    pub fn row(&self, i: usize) -> (usize, &[f64]) {
        let (first, entries) = &self.rows[i];
        (*first, entries)
    }

    /// Rows of the matrix: functions of the first axis.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Whether there are no rows; an axis has at least four functions.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }
}

/// The parts of `[0, length]` between the knots of both axes.
fn pieces(a: Axis, b: Axis, length: f64) -> Vec<(f64, f64)> {
    let knots = |axis: Axis| (1..axis.cells).map(move |i| i as f64 * axis.width);
    let mut ends: Vec<f64> = knots(a).chain(knots(b)).filter(|knot| *knot < length).collect();
    ends.push(length);
    ends.sort_unstable_by(f64::total_cmp);
    let begins = [0.0].into_iter().chain(ends.iter().copied());
    begins.zip(ends.iter().copied()).filter(|(from, to)| to > from).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::bspline::Band;

    #[test]
    fn on_one_grid_it_is_the_gram_matrix() {
        let axis = Axis { cells: 9, width: 0.3 };
        for order in 0..3 {
            let (mixed, band) = (MixedGram::new(axis, axis, 9.0 * 0.3, order), Band::gram(9, 0.3, order));
            let largest = band.diagonals[0].iter().copied().fold(0.0, f64::max);
            for i in 0..mixed.len() {
                let (first, entries) = mixed.row(i);
                for (j, value) in (first..).zip(entries) {
                    let wanted =
                        if i.abs_diff(j) <= 3 { band.entry(i, j as isize - i as isize) } else { 0.0 };
                    // The same sums up to rounding.
                    assert!((value - wanted).abs() < 1e-13 * largest, "order {order}: {i} {j}");
                }
            }
        }
    }

    #[test]
    fn splines_that_sum_to_one_or_to_x_integrate_as_polynomials() {
        let (a, b) = (Axis { cells: 7, width: 0.15 }, Axis { cells: 4, width: 0.25 });
        let length = 0.9;
        // Coefficients h (i - 1) give the function x.
        let sum = |gram: &MixedGram, left: &dyn Fn(f64) -> f64, right: &dyn Fn(f64) -> f64| -> f64 {
            (0..gram.len())
                .map(|i| {
                    let (first, entries) = gram.row(i);
                    let row: f64 = (first..).zip(entries).map(|(j, v)| v * right(j as f64)).sum();
                    left(i as f64) * row
                })
                .sum()
        };
        let one = |_: f64| 1.0;
        let x_on = |axis: Axis| move |i: f64| axis.width * (i - 1.0);
        let values = MixedGram::new(a, b, length, 0);
        let slopes = MixedGram::new(a, b, length, 1);
        assert!((sum(&values, &one, &one) - length).abs() < 1e-14);
        assert!((sum(&values, &x_on(a), &x_on(b)) - length.powi(3) / 3.0).abs() < 1e-14);
        assert!((sum(&slopes, &x_on(a), &x_on(b)) - length).abs() < 1e-14);
        assert!(sum(&slopes, &one, &x_on(b)).abs() < 1e-14);
    }
}
