//! The linear assignment problem: shortest augmenting paths with dual potentials.
//!
//! R. Jonker, A. Volgenant, *A Shortest Augmenting Path Algorithm for Dense and Sparse Linear Assignment Problems*,
//! Computing 38 (1987): columns are reduced, rows take their best column where it is free, and each row that is left is
//! assigned along the cheapest path of exchanges. Exact; at worst of order n^3, for costs of points in a plane far less.

use crate::{Progress, Result};

/// No row or column.
const NONE: usize = usize::MAX;

/// A cheapest assignment.
pub(super) struct Assignment {
    /// The column of each row.
    pub(super) column_of: Vec<usize>,
    /// The dual price of each column: to every row, its own column has the least cost - price of all.
    pub(super) price: Vec<f64>,
}

/// A cheapest assignment of rows to columns; `costs` are n x n, row by row, finite.
///
/// # Errors
/// `Cancelled`.
///
/// # Panics
/// When `costs` has not n x n values.
pub(super) fn assign(costs: &[f64], n: usize, progress: &Progress) -> Result<Assignment> {
    assert_eq!(costs.len(), n * n, "one cost for each pair");
    let mut problem = Problem::new(costs, n);
    let mut search = Search::new(n);
    for row in 0..n {
        if problem.column_of[row] == NONE {
            progress.check()?;
            problem.augment(row, &mut search);
        }
    }
    Ok(Assignment { column_of: problem.column_of, price: problem.price })
}

struct Problem<'a> {
    costs: &'a [f64],
    n: usize,
    /// Dual potential of each column.
    price: Vec<f64>,
    row_of: Vec<usize>,
    column_of: Vec<usize>,
}

/// A search for the cheapest path, as Dijkstra's, over the columns.
struct Search {
    distance: Vec<f64>,
    /// The row from which a column is reached.
    before: Vec<usize>,
    done: Vec<bool>,
    scanned: Vec<usize>,
}

impl Search {
    fn new(n: usize) -> Self {
        Self { distance: vec![0.0; n], before: vec![NONE; n], done: vec![false; n], scanned: Vec::new() }
    }
}

impl<'a> Problem<'a> {
    fn new(costs: &'a [f64], n: usize) -> Self {
        let mut price = vec![f64::INFINITY; n];
        for row in costs.chunks_exact(n.max(1)) {
            for (price, cost) in price.iter_mut().zip(row) {
                *price = price.min(*cost);
            }
        }
        let mut problem = Self { costs, n, price, row_of: vec![NONE; n], column_of: vec![NONE; n] };
        for row in 0..n {
            let reduced = |column: usize| problem.reduced(row, column);
            let best = (0..n).min_by(|&a, &b| reduced(a).total_cmp(&reduced(b)));
            if let Some(column) = best.filter(|&column| problem.row_of[column] == NONE) {
                (problem.row_of[column], problem.column_of[row]) = (row, column);
            }
        }
        problem
    }

    fn reduced(&self, row: usize, column: usize) -> f64 {
        self.costs[row * self.n + column] - self.price[column]
    }

    /// Assigns `row` along the cheapest path to a free column.
    fn augment(&mut self, row: usize, search: &mut Search) {
        let n = self.n;
        search.done.fill(false);
        search.scanned.clear();
        for column in 0..n {
            search.distance[column] = self.reduced(row, column);
            search.before[column] = row;
        }
        // At most n rounds: costs are finite, so each takes one more column, and some column is free.
        let (end, length) = loop {
            let mut nearest = (f64::INFINITY, NONE);
            for column in 0..n {
                if !search.done[column] && search.distance[column] < nearest.0 {
                    nearest = (search.distance[column], column);
                }
            }
            let (distance, column) = nearest;
            search.done[column] = true;
            let taken_by = self.row_of[column];
            if taken_by == NONE {
                break (column, distance);
            }
            search.scanned.push(column);
            let offset = distance - self.reduced(taken_by, column);
            let costs = &self.costs[taken_by * n..(taken_by + 1) * n];
            for other in 0..n {
                let through = costs[other] - self.price[other] + offset;
                if !search.done[other] && through < search.distance[other] {
                    (search.distance[other], search.before[other]) = (through, taken_by);
                }
            }
        };
        for &column in &search.scanned {
            self.price[column] += search.distance[column] - length;
        }
        let mut column = end;
        loop {
            let from = search.before[column];
            self.row_of[column] = from;
            std::mem::swap(&mut self.column_of[from], &mut column);
            if from == row {
                return;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::math::rng::{Purpose, Stream};

    /// The cheapest of all permutations.
    fn cheapest(costs: &[f64], n: usize, row: usize, taken: &mut Vec<bool>) -> f64 {
        if row == n {
            return 0.0;
        }
        let mut best = f64::INFINITY;
        for column in 0..n {
            if !taken[column] {
                taken[column] = true;
                best = best.min(costs[row * n + column] + cheapest(costs, n, row + 1, taken));
                taken[column] = false;
            }
        }
        best
    }

    #[test]
    fn no_permutation_is_cheaper() {
        for i in 0..200 {
            let mut random = Stream::new(7, Purpose::Match, 0, i);
            let n = 1 + i as usize % 7;
            // Few different values: many ties.
            let costs: Vec<f64> = (0..n * n).map(|_| (random.f64() * 6.0).floor()).collect();
            let Assignment { column_of: columns, price } = assign(&costs, n, &Progress::new()).unwrap();
            for (row, &own) in columns.iter().enumerate() {
                let reduced = |column: usize| costs[row * n + column] - price[column];
                assert!((0..n).all(|other| reduced(own) <= reduced(other) + 1e-9), "prices that hold");
            }
            let cost: f64 = columns.iter().enumerate().map(|(row, &column)| costs[row * n + column]).sum();
            let mut taken = columns.clone();
            taken.sort_unstable();
            assert!(taken.iter().copied().eq(0..n), "a permutation");
            assert_eq!(cost, cheapest(&costs, n, 0, &mut vec![false; n]));
        }
    }

    #[test]
    fn nothing_is_assigned_to_nothing() {
        assert!(assign(&[], 0, &Progress::new()).unwrap().column_of.is_empty());
    }
}
