//! The fit: one step cold and warm, its assembly, and velocities.
//! Budget: 60 ms for a warm step of 100 k photons on 128 x 128 cells with both potentials, 0.6 of it with one.

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use glam::Vec2;
use lightloom_core::Progress;
use lightloom_core::flow::field::{Field, Grid};
use lightloom_core::flow::fit::{Assembly, Blend, FitSettings, Fitter, Rows};
use lightloom_core::math::rng::{Purpose, Stream};

fn main() {
    divan::main();
}

const PHOTONS: u64 = 100_000;
const SIZES: [usize; 3] = [64, 128, 256];
const CASES: [(usize, f64); 9] = {
    let mut cases = [(0, 0.0); 9];
    let mut i = 0;
    while i < 9 {
        cases[i] = (SIZES[i / 3], [0.5, 0.0, 1.0][i % 3]);
        i += 1;
    }
    cases
};

fn grid(n: usize) -> Grid {
    Grid { cells: [n, n], extent: Vec2::ONE }
}

/// A caustic's ring and photons around it, on their way by `t`.
fn photons(t: f32) -> (Vec<Vec2>, Vec<Vec2>) {
    (0..PHOTONS)
        .map(|i| {
            let mut random = Stream::new(1, Purpose::Trace, 0, i);
            let p = if random.f32() < 0.6 {
                Vec2::splat(0.5) + (0.25 + 0.03 * random.f32()) * Vec2::from_angle(6.3 * random.f32())
            } else {
                Vec2::new(random.f32(), random.f32())
            };
            let v = Vec2::new((7.0 * p.y).sin() + 0.5 * (5.0 * p.x).cos(), (6.0 * p.x * p.y).cos() - 0.4);
            (p + t * v, v)
        })
        .unzip()
}

fn fitter(n: usize, gamma: f64, tolerance: f64) -> Fitter {
    let grid = grid(n);
    let settings =
        FitSettings { grid, gamma, alpha: 1e-3, blend: Blend::Joint, tolerance, max_iterations: 100 };
    Fitter::new(settings).expect("good settings")
}

#[divan::bench(args = CASES)]
fn cold(bencher: Bencher, (n, gamma): (usize, f64)) {
    let (positions, velocities) = photons(0.0);
    let (mut fitter, progress) = (fitter(n, gamma, 1e-8), Progress::new());
    bencher.bench_local(|| {
        fitter.reset();
        fitter.fit(&positions, &velocities, &progress).expect("a field")
    });
}

/// Steps of 1/100 to and fro, to 1e-4.
#[divan::bench(args = CASES)]
fn warm(bencher: Bencher, (n, gamma): (usize, f64)) {
    let steps = [photons(0.0), photons(0.01)];
    let (mut fitter, progress) = (fitter(n, gamma, 1e-4), Progress::new());
    let mut turn = 0;
    bencher.bench_local(|| {
        turn += 1;
        let (positions, velocities) = &steps[turn % 2];
        fitter.fit(positions, velocities, &progress).expect("a field")
    });
}

#[divan::bench(args = [(64, true), (128, true), (256, true), (128, false)])]
fn assembly(bencher: Bencher, (n, coupled): (usize, bool)) {
    let (positions, velocities) = photons(0.0);
    let mut assembly = Assembly::new(grid(n), coupled);
    bencher.bench_local(|| {
        assembly.clear();
        assembly.add(Rows { positions: &positions, velocities: &velocities, weight: 1e-5 });
    });
}

#[divan::bench(args = SIZES)]
fn velocity(bencher: Bencher, n: usize) {
    let (positions, velocities) = photons(0.0);
    let (field, _) = fitter(n, 0.5, 1e-4).fit(&positions, &velocities, &Progress::new()).expect("a field");
    bencher
        .counter(ItemsCount::new(positions.len()))
        .bench_local(|| positions.iter().map(|&p| black_box(&field).velocity(p)).sum::<Vec2>());
}

/// Blending two fields in time.
#[divan::bench(args = SIZES)]
fn blend(bencher: Bencher, n: usize) {
    let (a, b, mut out) = (Field::zero(grid(n)), Field::zero(grid(n)), Field::zero(grid(n)));
    bencher.bench_local(|| Field::blend(black_box(&a), 1.5, black_box(&b), -0.5, &mut out));
}
