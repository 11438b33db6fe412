//! Exact solves for nodes of a grid, by the multifrontal Cholesky factorisation (Duff, Reid 1983): each front of the
//! [`Dissection`] is a dense matrix of its pivots and its border; what is left of the border goes on to the front above.

use super::dissection::{Dissection, Front};

/// The factor L of a symmetric positive definite matrix, A = L L^T, over nodes of a grid.
#[derive(Clone, Debug)]
pub(super) struct SparseCholesky {
    pub(super) dissection: Dissection,
    components: usize,
    /// Of each front: the rows of its pivots and of its border, the columns of its pivots.
    factors: Vec<Vec<f64>>,
}

/// The least pivot of a matrix with a unit diagonal: smaller ones are lost to rounding, and their unknowns are held at zero.
const LEAST: f64 = 1e-13;

impl SparseCholesky {
    /// Factors the matrix over these nodes with `components` unknowns each. `entry` is that of two unknowns: positions,
    /// offset of the second, components; the diagonal is about 1.
    pub(super) fn new(
        dissection: Dissection,
        components: usize,
        entry: impl Fn([usize; 2], [isize; 2], [usize; 2]) -> f64,
    ) -> Self {
        let mut factors = Vec::with_capacity(dissection.fronts.len());
        let mut left: Vec<Vec<f64>> = Vec::new();
        for front in &dissection.fronts {
            let pivots = components * front.pivots.len();
            let size = pivots + components * front.border.len();
            let mut matrix = vec![0.0; size * size];
            assemble(&dissection, front, components, &mut matrix, &entry);
            for &part in &front.parts {
                let rest = std::mem::take(&mut left[part]);
                extend(&dissection.fronts[part].border, front, components, &rest, &mut matrix);
            }
            eliminate(&mut matrix, size, pivots);
            left.push(rest_of(&matrix, size, pivots));
            factors.push(matrix.chunks_exact(size.max(1)).flat_map(|row| &row[..pivots]).copied().collect());
        }
        Self { dissection, components, factors }
    }

    /// Overwrites the right side `b`, by position and component, with the solution.
    pub(super) fn solve(&self, b: &mut [f64]) {
        let mut border = Vec::new();
        let fronts = || self.dissection.fronts.iter().zip(&self.factors);
        for (front, factor) in fronts() {
            let (size, span) = self.span(front);
            let (pivots, rest) = factor.split_at(size * size);
            let own = &mut b[span];
            for (i, row) in pivots.chunks_exact(size.max(1)).enumerate() {
                own[i] = (own[i] - dot(&row[..i], &own[..i])) / row[i];
            }
            border.clear();
            border.extend(rest.chunks_exact(size.max(1)).map(|row| dot(row, own)));
            self.unknowns(&front.border).zip(&border).for_each(|(to, value)| b[to] -= value);
        }
        for (front, factor) in fronts().rev() {
            let (size, span) = self.span(front);
            let (pivots, rest) = factor.split_at(size * size);
            border.clear();
            border.extend(self.unknowns(&front.border).map(|from| b[from]));
            let own = &mut b[span];
            for (row, value) in rest.chunks_exact(size.max(1)).zip(&border) {
                own.iter_mut().zip(row).for_each(|(own, l)| *own = (-value).mul_add(*l, *own));
            }
            for (i, row) in pivots.chunks_exact(size.max(1)).enumerate().rev() {
                own[i] /= row[i];
                let value = own[i];
                own[..i].iter_mut().zip(row).for_each(|(own, l)| *own = (-value).mul_add(*l, *own));
            }
        }
    }

    /// Unknowns of the pivots: their number and their places.
    fn span(&self, front: &Front) -> (usize, std::ops::Range<usize>) {
        let (start, end) = (self.components * front.pivots.start, self.components * front.pivots.end);
        (end - start, start..end)
    }

    fn unknowns<'a>(&self, positions: &'a [usize]) -> impl Iterator<Item = usize> + use<'a> {
        let components = self.components;
        positions.iter().flat_map(move |position| (0..components).map(move |k| components * position + k))
    }
}

/// Place of a position in a front: pivots first.
fn place(front: &Front, position: usize) -> usize {
    if position < front.pivots.end {
        position - front.pivots.start
    } else {
        front.pivots.len() + front.border.partition_point(|other| *other < position)
    }
}

/// Writes the entries of the pivots into the lower triangle of a front.
fn assemble(
    dissection: &Dissection,
    front: &Front,
    components: usize,
    matrix: &mut [f64],
    entry: &impl Fn([usize; 2], [isize; 2], [usize; 2]) -> f64,
) {
    let size = components * (front.pivots.len() + front.border.len());
    for pivot in front.pivots.clone() {
        let column = components * (pivot - front.pivots.start);
        for (other, offset) in dissection.links(pivot).filter(|(other, _)| *other >= pivot) {
            let row = components * place(front, other);
            for (i, k) in (0..components).flat_map(|i| (0..components).map(move |k| (i, k))) {
                matrix[(row + k) * size + column + i] = entry([pivot, other], offset, [i, k]);
            }
        }
    }
}

/// Adds what is left of a part, over its `border`.
fn extend(border: &[usize], front: &Front, components: usize, rest: &[f64], matrix: &mut [f64]) {
    let size = components * (front.pivots.len() + front.border.len());
    let places: Vec<usize> = border.iter().map(|&position| place(front, position)).collect();
    let unknown = |i: usize| components * places[i / components] + i % components;
    for (i, row) in rest.chunks_exact((components * border.len()).max(1)).enumerate() {
        let to = &mut matrix[unknown(i) * size..][..size];
        row[..=i].iter().enumerate().for_each(|(k, value)| to[unknown(k)] += value);
    }
}

/// Factors the first `pivots` columns of the lower triangle and takes their products off the rest.
fn eliminate(matrix: &mut [f64], size: usize, pivots: usize) {
    for i in 0..size {
        let (above, row) = matrix.split_at_mut(i * size);
        for k in 0..pivots.min(i) {
            let other = &above[k * size..][..=k];
            row[k] = (row[k] - dot(&row[..k], &other[..k])) / other[k];
        }
        if i < pivots {
            let pivot = row[i] - dot(&row[..i], &row[..i]);
            // What is divided by this is nothing.
            row[i] = if pivot > LEAST { pivot.sqrt() } else { f64::INFINITY };
            continue;
        }
        let (known, rest) = row.split_at_mut(pivots);
        for (k, value) in rest[..=i - pivots].iter_mut().enumerate() {
            // The row itself comes after those above.
            let other = above.get((pivots + k) * size..).and_then(|rows| rows.get(..pivots));
            *value -= dot(known, other.unwrap_or(known));
        }
    }
}

/// The lower triangle beyond the pivots, as a matrix of its own.
fn rest_of(matrix: &[f64], size: usize, pivots: usize) -> Vec<f64> {
    matrix.chunks_exact(size.max(1)).skip(pivots).flat_map(|row| &row[pivots..]).copied().collect()
}

/// Products summed in an order of their own, so that they run in vector registers.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    const LANES: usize = 16;
    let mut lanes = [0.0f64; LANES];
    let ((whole_a, rest_a), (whole_b, rest_b)) = (a.as_chunks::<LANES>(), b.as_chunks::<LANES>());
    for (a, b) in whole_a.iter().zip(whole_b) {
        for i in 0..LANES {
            lanes[i] = a[i].mul_add(b[i], lanes[i]);
        }
    }
    let rest: f64 = rest_a.iter().zip(rest_b).map(|(a, b)| a * b).sum();
    lanes.iter().sum::<f64>() + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_solution_fulfils_the_equations_on_nodes_of_any_shape() {
        let size = [31, 17];
        let all = || (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| [x, y]));
        let shapes: [fn(usize, usize) -> bool; 4] = [
            |_, _| true,
            |x, y| x.abs_diff(15) < 4 || y.abs_diff(8) < 4,
            |x, y| (x * 7 + y * 13) % 5 < 2,
            |x, y| x < 3 || (x > 20 && y > 10),
        ];
        for (keep, components) in shapes.into_iter().flat_map(|shape| [(shape, 1), (shape, 2)]) {
            let nodes: Vec<_> = all().filter(|[x, y]| keep(*x, *y)).collect();
            // Symmetric in (place, component): a graph's Laplacian with a coupling, and little more than singular.
            let entry = |offset: [isize; 2], [i, k]: [usize; 2]| {
                let far = (offset[0].abs() + 2 * offset[1].abs()) as f64;
                let sign = if i == k { 1.0 } else { 0.1 * offset[0] as f64 * (i as f64 - k as f64) };
                if far == 0.0 && i == k { 1.0 } else { -sign * 0.02 / (1.0 + far) }
            };
            let dissection = Dissection::new(nodes, size);
            let factor = SparseCholesky::new(dissection, components, |_, offset, pair| entry(offset, pair));
            let count = components * factor.dissection.order.len();
            let x: Vec<f64> = (0..count).map(|i| ((i * 37 % 101) as f64 - 50.0) / 50.0).collect();
            let mut b = vec![0.0; count];
            for position in 0..factor.dissection.order.len() {
                for (other, offset) in factor.dissection.links(position) {
                    for (i, k) in (0..components).flat_map(|i| (0..components).map(move |k| (i, k))) {
                        b[components * position + i] += entry(offset, [i, k]) * x[components * other + k];
                    }
                }
            }
            factor.solve(&mut b);
            let apart = b.iter().zip(&x).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            // Rounding, times a condition number below 1000.
            assert!(apart < 1e-12, "{components} components, {count} unknowns: {apart}");
        }
    }

    #[test]
    fn unknowns_lost_to_rounding_are_held() {
        let nodes = (0..12).flat_map(|y| (0..12).map(move |x| [x, y])).collect();
        // All ones within reach of a node that sees all others: of rank one there.
        let factor = SparseCholesky::new(Dissection::new(nodes, [12, 12]), 1, |_, _, _| 1.0);
        let mut b = vec![1.0; 144];
        factor.solve(&mut b);
        assert!(b.iter().all(|x| x.is_finite() && x.abs() < 10.0), "{b:?}");
        assert!(b.contains(&0.0));
    }
}
