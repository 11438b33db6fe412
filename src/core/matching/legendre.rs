//! The c-transform of a potential for the cost |x - y|^2 / 2, in linear time.

use rayon::prelude::*;

use super::lattice::Lattice;
use super::poisson::transpose;
use crate::math::tasks::rows_per_task;

/// Operations for each value of an envelope.
const OPERATIONS: usize = 20;

/// phi^c(x) = min over cells y of |x - y|^2 / 2 - phi(y), at every cell x; cell units.
///
/// The squared distance separates, so the lower envelopes of parabolas of all rows, then of all columns, are the
/// transform (Felzenszwalb and Huttenlocher, *Distance Transforms of Sampled Functions*, 2012).
pub(super) fn c_transform(lattice: &Lattice, potential: &[f64]) -> Vec<f64> {
    let [width, height] = lattice.size;
    let mut rows = vec![0.0; potential.len()];
    let negative: Vec<f64> = potential.iter().map(|value| -value).collect();
    envelopes(&negative, &mut rows, width);
    let columns = transpose(&rows, width);
    let mut transformed = rows;
    envelopes(&columns, &mut transformed, height);
    transpose(&transformed, height)
}

/// `out[i] = min_j (i - j)^2 / 2 + f[j]` in every row of `width`.
fn envelopes(f: &[f64], out: &mut [f64], width: usize) {
    let part = width * rows_per_task(width, OPERATIONS);
    f.par_chunks(part).zip(out.par_chunks_mut(part)).for_each(|(f, out)| {
        let mut hull = Vec::with_capacity(width);
        for (f, out) in f.chunks_exact(width).zip(out.chunks_exact_mut(width)) {
            envelope(f, out, &mut hull);
        }
    });
}

/// One parabola of a lower envelope.
struct Parabola {
    /// Its vertex.
    at: usize,
    /// It is the lowest from here on to the next one.
    from: f64,
}

fn envelope(f: &[f64], out: &mut [f64], hull: &mut Vec<Parabola>) {
    hull.clear();
    for (at, value) in f.iter().enumerate() {
        let mut from = f64::NEG_INFINITY;
        while let Some(last) = hull.last() {
            // Where parabola `at` goes below the last one.
            let gap = (at - last.at) as f64;
            from = (value - f[last.at]) / gap + 0.5 * (at + last.at) as f64;
            if from > last.from {
                break;
            }
            hull.pop();
            from = f64::NEG_INFINITY;
        }
        hull.push(Parabola { at, from });
    }
    let mut lowest = 0;
    for (i, out) in out.iter_mut().enumerate() {
        while lowest + 1 < hull.len() && hull[lowest + 1].from <= i as f64 {
            lowest += 1;
        }
        let at = hull[lowest].at;
        let distance = i as f64 - at as f64;
        *out = 0.5 * distance * distance + f[at];
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::rng::{Purpose, Stream};

    #[test]
    fn it_is_the_minimum_over_all_cells() {
        let lattice = Lattice { size: [16, 32], origin: glam::DVec2::ZERO, cell: 1.0 };
        let mut stream = Stream::new(1, Purpose::Match, 0, 0);
        let potential: Vec<f64> = (0..lattice.len()).map(|_| 100.0 * stream.f64()).collect();
        let fast = c_transform(&lattice, &potential);
        let place = |i: usize| glam::DVec2::new((i % 16) as f64, (i / 16) as f64);
        for (x, &fast) in fast.iter().enumerate() {
            let cost = |y: usize| place(x).distance_squared(place(y)) / 2.0 - potential[y];
            let slow = (0..lattice.len()).map(cost).fold(f64::INFINITY, f64::min);
            // Sums of numbers below 1e3: rounding only.
            assert!((fast - slow).abs() < 1e-11, "{fast} {slow}");
        }
    }
}
