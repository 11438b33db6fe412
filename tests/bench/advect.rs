//! Photons carried along given fields, without and with turbulence: 1 M photons on a 128 x 128 grid. The item count is
//! photon-steps.

use glam::Vec2;
use lightloom_core::Progress;
use lightloom_core::flow::field::{Field, Grid};
use lightloom_core::flow::{
    Fade, FieldTrajectories, Fields, Trajectories as _, Turbulence, TurbulenceSettings, spatial_order,
};
use lightloom_core::math::rng::{Purpose, Stream};

const PHOTONS: usize = 1_000_000;
const STEPS: usize = 10;

fn main() {
    divan::main();
}

/// A vortex that turns the other way round at the end, and a target a little beside each photon.
fn fields() -> Fields {
    let grid = Grid { cells: [128, 128], extent: Vec2::ONE };
    let [nx, ny] = grid.nodes();
    let node = |turn: f32| {
        let psi: Vec<f32> = (0..nx * ny)
            .map(|i| {
                let (x, y) = ((i % nx) as f32 / nx as f32, (i / nx) as f32 / ny as f32);
                turn * 0.05 * (6.0 * x).sin() * (5.0 * y).cos()
            })
            .collect();
        Field::from_potentials(grid, &psi, &vec![0.0; nx * ny])
    };
    let nodes = (0..STEPS).map(|n| node(1.0 - n as f32 / STEPS as f32)).collect();
    Fields::from_nodes(nodes, STEPS, Fade::Paper { tau: 0.85 }, 0.1)
}

fn photons(sorted: bool) -> (Vec<Vec2>, Vec<Vec2>) {
    let mut random = Stream::new(1, Purpose::Target, 0, 0);
    let source: Vec<Vec2> = (0..PHOTONS).map(|_| Vec2::new(random.f32(), random.f32())).collect();
    let source = match sorted {
        true => spatial_order(&source).into_iter().map(|i| source[i as usize]).collect(),
        false => source,
    };
    let target = source.iter().map(|p| *p + Vec2::new(0.05, 0.1 * p.x)).collect();
    (source, target)
}

/// All steps; one position column per step, as a frame would ask.
#[divan::bench(args = [true, false], sample_count = 5)]
fn advect(bencher: divan::Bencher, sorted: bool) {
    carry(bencher, &fields(), sorted);
}

fn carry(bencher: divan::Bencher, fields: &Fields, sorted: bool) {
    let (source, target) = photons(sorted);
    let mut out = vec![Vec2::ZERO; PHOTONS];
    let progress = Progress::new();
    bencher.counter(divan::counter::ItemsCount::new(PHOTONS * STEPS)).bench_local(|| {
        let mut carrier = FieldTrajectories::new(fields, &source, &target);
        for n in 0..STEPS {
            carrier.positions_at(n as f64 / STEPS as f64, &mut out, &progress).expect("finite");
        }
        out[0]
    });
}

/// All steps with turbulence on 30 x 30, or on 30 x 30 and 100 x 100 cells: about twice and three times the cost without.
#[divan::bench(args = [1, 2], sample_count = 5)]
fn advect_turbulent(bencher: divan::Bencher, grids: usize) {
    let settings = TurbulenceSettings { grids: [30, 100][..grids].to_vec(), ..Default::default() };
    let fields = fields().with_turbulence(Turbulence::new(&settings, Vec2::ONE, 0));
    carry(bencher, &fields, true);
}

/// Key noises of a segment at the default rate, made orthonormal.
#[divan::bench(args = [30, 100, 512], sample_count = 5)]
fn key_noises(bencher: divan::Bencher, cells: u32) {
    let settings = TurbulenceSettings { grids: vec![cells], ..Default::default() };
    bencher.bench(|| Turbulence::new(&settings, Vec2::ONE, 0));
}

/// One frame between two steps: positions of 1 M photons.
#[divan::bench(sample_count = 20)]
fn positions(bencher: divan::Bencher) {
    let fields = fields();
    let (source, target) = photons(true);
    let mut carrier = FieldTrajectories::new(&fields, &source, &target);
    let mut out = vec![Vec2::ZERO; PHOTONS];
    let progress = Progress::new();
    bencher
        .counter(divan::counter::ItemsCount::new(PHOTONS))
        .bench_local(|| carrier.positions_at(0.03, &mut out, &progress).expect("finite"));
}

/// Order of a pass, once.
#[divan::bench(sample_count = 5)]
fn order(bencher: divan::Bencher) {
    let (source, _) = photons(false);
    bencher.counter(divan::counter::ItemsCount::new(PHOTONS)).bench(|| spatial_order(&source));
}
