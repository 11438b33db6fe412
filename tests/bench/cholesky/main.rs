//! The equations of a fit step solved by sparse Cholesky factorisation, beside the bench `fit`.

use divan::Bencher;
use faer::linalg::solvers::Solve;
use faer::sparse::linalg::solvers::{Llt, SymbolicLlt};
use faer::sparse::{SparseColMat, Triplet};
use glam::Vec2;
use lightloom_core::flow::field::Grid;
use lightloom_core::flow::fit::{Assembly, Rows};
use lightloom_core::math::normal_blocks::Weights;
use lightloom_core::math::rng::{Purpose, Stream};

fn main() {
    divan::main();
}

const PHOTONS: u64 = 100_000;

/// A caustic's ring and photons around it.
fn photons() -> (Vec<Vec2>, Vec<Vec2>) {
    (0..PHOTONS)
        .map(|i| {
            let mut random = Stream::new(1, Purpose::Trace, 0, i);
            let p = if random.f32() < 0.6 {
                Vec2::splat(0.5) + (0.25 + 0.03 * random.f32()) * Vec2::from_angle(6.3 * random.f32())
            } else {
                Vec2::new(random.f32(), random.f32())
            };
            let v = Vec2::new((7.0 * p.y).sin() + 0.5 * (5.0 * p.x).cos(), (6.0 * p.x * p.y).cos() - 0.4);
            (p, v)
        })
        .unzip()
}

/// Numeric factorisation and one solve with faer, symbolic part and assembly not counted.
#[divan::bench(args = [64, 128, 256], sample_count = 5)]
fn sparse_cholesky(bencher: Bencher, n: usize) {
    let grid = Grid { cells: [n, n], extent: Vec2::ONE };
    let (positions, velocities) = photons();
    let mut assembly = Assembly::new(grid, true);
    assembly.add(Rows { positions: &positions, velocities: &velocities, weight: 1e-5 });
    let weights = Weights { psi: 0.5, phi: 0.5, cross: 0.5, alpha: 1e-3, no_penetration: -1.0 };
    let [nx, ny] = grid.nodes();
    let mut triplets = Vec::new();
    for (y, x) in (0..ny).flat_map(|y| (0..nx).map(move |x| (y, x))) {
        for (i, k) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            for (dy, dx) in (-3..4).flat_map(|dy| (-3..4).map(move |dx| (dy, dx))) {
                let (to_x, to_y) = (x.wrapping_add_signed(dx), y.wrapping_add_signed(dy));
                let (row, column) = (2 * (y * nx + x) + i, 2 * (to_y.min(ny) * nx + to_x) + k);
                if to_x < nx && to_y < ny && row >= column {
                    let ridge = if row == column { 1e-9 } else { 0.0 };
                    let entry = assembly.blocks.entry(weights, [i, k], [x, y], [dx, dy]);
                    triplets.push(Triplet::new(row, column, entry + ridge));
                }
            }
        }
    }
    let size = 2 * nx * ny;
    let matrix = SparseColMat::<usize, f64>::try_new_from_triplets(size, size, &triplets).expect("a matrix");
    let symbolic = SymbolicLlt::try_new(matrix.symbolic(), faer::Side::Lower).expect("a pattern");
    let right = faer::Mat::<f64>::from_fn(size, 1, |i, _| (i % 7) as f64);
    bencher.bench_local(|| {
        Llt::try_new_with_symbolic(symbolic.clone(), matrix.as_ref(), faer::Side::Lower)
            .expect("positive definite")
            .solve(&right)
    });
}
