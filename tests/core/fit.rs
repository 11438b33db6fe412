//! The fit: against a Cholesky factorisation of independent rows, the energy's differences, and in extreme cases.

use glam::Vec2;
use lightloom_core::Progress;
use lightloom_core::flow::field::{Field, Grid};
use lightloom_core::flow::fit::{
    Assembly, Blend, FitReport, FitSettings, Fitter, NoPenetrationRows, Rows, energy,
};
use lightloom_core::math::rng::{Purpose, Stream};

use crate::fit_reference::{Points, apart, reference};

pub(crate) fn settings(cells: [usize; 2], gamma: f64, alpha: f64) -> FitSettings {
    let longer = cells[0].max(cells[1]) as f32;
    let extent = Vec2::new(cells[0] as f32 / longer, cells[1] as f32 / longer);
    let grid = Grid { cells, extent };
    FitSettings { grid, gamma, alpha, blend: Blend::Joint, tolerance: 1e-10, max_iterations: 100 }
}

/// Photons as caustics have them: most on a ring, the others anywhere, and a few beyond the rectangle.
pub(crate) fn photons(count: u64, extent: Vec2) -> (Vec<Vec2>, Vec<Vec2>) {
    (0..count)
        .map(|i| {
            let mut random = Stream::new(1, Purpose::Trace, 0, i);
            let p = if random.f32() < 0.6 {
                Vec2::new(0.5, 0.5) + (0.25 + 0.03 * random.f32()) * Vec2::from_angle(6.3 * random.f32())
            } else {
                Vec2::new(1.02 * random.f32() - 0.01, 1.02 * random.f32() - 0.01)
            };
            let noise = Vec2::new(random.f32(), random.f32()) - 0.5;
            let wave = Vec2::new((7.0 * p.y).sin() + 0.5 * (5.0 * p.x).cos(), (6.0 * p.x * p.y).cos() - 0.4);
            (p * extent, wave + 0.3 * noise)
        })
        .unzip()
}

fn fit(settings: FitSettings, positions: &[Vec2], velocities: &[Vec2]) -> (Field, FitReport) {
    Fitter::new(settings).unwrap().fit(positions, velocities, &Progress::new()).unwrap()
}

pub(crate) fn points(grid: Grid) -> impl Iterator<Item = Vec2> {
    (0..200).map(move |i| {
        let mut random = Stream::new(2, Purpose::Trace, 0, i);
        Vec2::new(random.f32(), random.f32()) * grid.extent
    })
}

/// Largest difference of two fields over the largest velocity, at random points.
fn difference(a: &Field, b: &Field) -> f64 {
    let largest = points(a.grid()).map(|p| a.velocity(p).length()).fold(0.0, f32::max);
    let apart = points(a.grid()).map(|p| a.velocity(p).distance(b.velocity(p))).fold(0.0, f32::max);
    f64::from(apart / largest.max(1e-30))
}

#[test]
fn the_fit_agrees_with_a_cholesky_factorisation_of_independent_rows() {
    for (cells, gamma, alpha) in [([16, 16], 0.5, 1e-3), ([17, 11], 0.3, 1e-4), ([9, 14], 0.9, 1e-2)] {
        let settings = settings(cells, gamma, alpha);
        let (positions, velocities) = photons(3000, settings.grid.extent);
        let mut fitter = Fitter::new(settings).unwrap();
        let (field, report) = fitter.fit(&positions, &velocities, &Progress::new()).unwrap();
        assert!(report.error <= 1e-10);
        let [psi, phi] = reference(&settings, &[Points::photons(&positions, &velocities)]);
        let (fitted_psi, fitted_phi) = fitter.potentials();
        let apart =
            Field::from_potentials(settings.grid, &apart(&fitted_psi, &psi), &apart(&fitted_phi, &phi));
        let largest = |f: &Field| points(f.grid()).map(|p| f.velocity(p).length()).fold(0.0, f32::max);
        // In units of 1e-6 of the velocity: the solver stops at 1e-10, the condition number does the rest.
        assert!(largest(&apart) < largest(&field), "{cells:?} {gamma} {alpha}: {} e-6", largest(&apart));
    }
}

/// The walls' own term from velocities alone, so that it shares nothing with its assembly.
#[test]
fn with_walls_the_energy_has_its_minimum_at_the_fit_too() {
    for (gamma, blend) in
        [(0.0, Blend::Joint), (0.4, Blend::Joint), (1.0, Blend::Joint), (0.0, Blend::Separate)]
    {
        let settings = FitSettings { blend, ..settings([12, 10], gamma, 1e-3) };
        let (positions, velocities) = photons(500, settings.grid.extent);
        let places: Vec<Vec2> = (0..40).map(|i| Vec2::new(0.2 + 0.015 * i as f32, 0.3)).collect();
        let normals: Vec<Vec2> = (0..40).map(|i| Vec2::from_angle(0.15 * i as f32)).collect();
        let weight = 0.05;
        let mut fitter = Fitter::new(settings).unwrap();
        fitter.set_no_penetration(Some(NoPenetrationRows { positions: &places, normals: &normals, weight }));
        let (field, report) = fitter.fit(&positions, &velocities, &Progress::new()).unwrap();
        assert!(report.error <= 1e-10);
        let at = |potentials: &[Vec<f32>; 2]| {
            let field = Field::from_potentials(settings.grid, &potentials[0], &potentials[1]);
            let through = |(p, n): (&Vec2, &Vec2)| {
                let [x, y] = field.velocity_f64([f64::from(p.x), f64::from(p.y)]);
                (x * f64::from(n.x) + y * f64::from(n.y)).powi(2)
            };
            let walls: f64 = places.iter().zip(&normals).map(through).sum();
            energy(&field, &settings, &positions, &velocities) + 0.5 * weight * walls
        };
        let (psi, phi) = field.potentials();
        let fitted = [psi, phi];
        let base = at(&fitted);
        let active: &[usize] = if gamma == 0.0 {
            &[0]
        } else if gamma == 1.0 {
            &[1]
        } else {
            &[0, 1]
        };
        for (&potential, i) in
            active.iter().flat_map(|p| (0..fitted[0].len()).step_by(7).map(move |i| (p, i)))
        {
            let moved = |by: f32| {
                let mut both = fitted.clone();
                both[potential][i] += by;
                at(&both)
            };
            let (up, down) = (moved(0.125), moved(-0.125));
            let (slope, curvature) = ((up - down) / 0.25, (up + down - 2.0 * base) / 0.015625);
            // As without walls: the rounding of f32 coefficients near 1.
            assert!(
                slope.abs() < 1e-6 * curvature,
                "gamma {gamma}, {i}: slope {slope}, curvature {curvature}"
            );
        }
    }
}

#[test]
fn the_energy_rises_quadratically_around_the_solution() {
    let settings = settings([12, 10], 0.4, 1e-3);
    let (positions, velocities) = photons(500, settings.grid.extent);
    let (field, _) = fit(settings, &positions, &velocities);
    let (psi, phi) = field.potentials();
    let at = |psi: &[f32], phi: &[f32]| {
        energy(&Field::from_potentials(settings.grid, psi, phi), &settings, &positions, &velocities)
    };
    let base = at(&psi, &phi);
    for i in (0..psi.len()).step_by(7) {
        for potential in 0..2 {
            let moved = |by: f32| {
                let mut both = [psi.clone(), phi.clone()];
                both[potential][i] += by;
                at(&both[0], &both[1])
            };
            let (up, down) = (moved(0.125), moved(-0.125));
            // A quadratic: the central difference is the slope, the second difference the curvature.
            let (slope, curvature) = ((up - down) / 0.25, (up + down - 2.0 * base) / 0.015625);
            assert!(curvature > 0.0);
            // Its minimum along this coefficient is where the fit is, to the rounding of f32 coefficients near 1.
            assert!(slope.abs() < 1e-6 * curvature, "{i}: slope {slope}, curvature {curvature}");
        }
    }
}

#[test]
fn the_paper_form_of_the_energy_is_what_the_fit_minimises() {
    // A worse field by any other alpha has a larger energy.
    let chosen = settings([16, 16], 0.5, 1e-3);
    let (positions, velocities) = photons(800, chosen.grid.extent);
    let best = energy(&fit(chosen, &positions, &velocities).0, &chosen, &positions, &velocities);
    for other in [1e-4, 5e-4, 2e-3, 1e-2] {
        let (field, _) = fit(FitSettings { alpha: other, ..chosen }, &positions, &velocities);
        assert!(best < energy(&field, &chosen, &positions, &velocities));
    }
}

#[test]
fn iterations_do_not_grow_with_the_grid() {
    for gamma in [0.0, 0.5] {
        let (positions, velocities) = photons(50_000, Vec2::ONE);
        let iterations: Vec<_> = [32, 64, 128, 256]
            .map(|n| {
                let settings = FitSettings { tolerance: 1e-8, ..settings([n, n], gamma, 1e-3) };
                fit(settings, &positions, &velocities).1.iterations
            })
            .into();
        let (least, most) = (iterations.iter().min().unwrap(), iterations.iter().max().unwrap());
        assert!(most - least <= 2 && *most <= 12, "{iterations:?}");
    }
}

#[test]
fn odd_and_stretched_grids_take_few_iterations_too() {
    let (positions, velocities) = photons(20_000, Vec2::ONE);
    for cells in
        [[127, 127], [100, 100], [33, 33], [7, 5], [100, 25], [25, 100], [9, 96], [37, 53], [99, 33], [64, 8]]
    {
        let grid = Grid { cells, extent: Vec2::ONE };
        let settings = FitSettings { grid, tolerance: 1e-8, ..settings([16, 16], 0.5, 1e-3) };
        let report = fit(settings, &positions, &velocities).1;
        // 8 on square cells, whatever their number; 10 on cells of 4:1, 15 on those of 10:1.
        assert!(report.iterations <= 16, "{cells:?}: {report:?}");
    }
}

#[test]
fn the_matrix_of_points_is_symmetric_and_coarsens_exactly() {
    // R A R^T of the fine grid's matrix is the coarse grid's own matrix, as spline spaces are nested.
    for cells in [[16, 16], [12, 20], [15, 9]] {
        let fine_grid = settings(cells, 0.5, 1.0).grid;
        let coarse_cells = cells.map(|n: usize| n.div_ceil(2));
        // The coarse rectangle of an odd number of cells is larger; points stay where they are.
        let extent = Vec2::new(
            (2 * coarse_cells[0]) as f32 * fine_grid.cell_size()[0] as f32,
            (2 * coarse_cells[1]) as f32 * fine_grid.cell_size()[1] as f32,
        );
        let coarse_grid = Grid { cells: coarse_cells, extent };
        let (positions, velocities) = photons(400, fine_grid.extent * 0.95);
        let positions: Vec<_> = positions.iter().map(|p| p.max(Vec2::ZERO).min(fine_grid.extent)).collect();
        let assemble = |grid| {
            let mut assembly = Assembly::new(grid, true);
            assembly.add(Rows { positions: &positions, velocities: &velocities, weight: 1.0 / 400.0 });
            assembly
        };
        let coarse = assemble(coarse_grid).blocks;
        let parts = assemble(fine_grid).blocks.coarsened(coarse_grid.nodes());
        let [nx, ny] = coarse_grid.nodes();
        let (mut largest, mut apart) = (0.0f64, 0.0f64);
        for (y, x) in (0..ny).flat_map(|y| (0..nx).map(move |x| (y, x))) {
            for (dy, dx) in (-3..4).flat_map(|dy| (-3..4).map(move |dx| (dy, dx))) {
                let (a, b) = (parts.ata.entry(x, y, dx, dy, 1.0), coarse.ata.entry(x, y, dx, dy, 1.0));
                let cross = |parts: &lightloom_core::math::normal_blocks::NormalBlocks| {
                    parts.ata_cross.as_ref().unwrap().entry(x, y, dx, dy, -1.0)
                };
                largest = largest.max(b.abs());
                apart = apart.max((a - b).abs()).max((cross(&parts) - cross(&coarse)).abs());
            }
        }
        // Both grids place the points in single precision.
        assert!(apart < 2e-5 * largest, "{cells:?}: {apart} of {largest}");
    }
}

#[test]
fn a_warm_start_takes_few_iterations_and_ends_at_the_same_field() {
    let settings = FitSettings { tolerance: 1e-4, ..settings([64, 64], 0.5, 1e-3) };
    let (mut positions, velocities) = photons(20_000, Vec2::ONE);
    let mut fitter = Fitter::new(settings).unwrap();
    let cold = fitter.fit(&positions, &velocities, &Progress::new()).unwrap().1.iterations;
    for (p, v) in positions.iter_mut().zip(&velocities) {
        *p += 0.01 * *v;
    }
    let (field, report) = fitter.fit(&positions, &velocities, &Progress::new()).unwrap();
    assert!(report.iterations <= 4 && report.iterations <= cold, "{cold} then {}", report.iterations);
    let (fresh, _) = fit(FitSettings { tolerance: 1e-10, ..settings }, &positions, &velocities);
    assert!(difference(&fresh, &field) < 1e-3, "{}", difference(&fresh, &field));
    fitter.reset();
    assert_eq!(
        fitter.fit(&positions, &velocities, &Progress::new()).unwrap().0,
        fit(settings, &positions, &velocities).0
    );
}

#[test]
fn extreme_settings_and_photons_stay_finite_and_are_solved() {
    let crowd = photons(300, Vec2::ONE);
    let one = (vec![Vec2::new(0.3, 0.6)], vec![Vec2::new(1.0, -2.0)]);
    let same = (vec![Vec2::splat(0.5); 50], (0..50).map(|i| Vec2::new(i as f32, 1.0)).collect::<Vec<_>>());
    let outside = (vec![Vec2::new(-5.0, 9.0), Vec2::new(1e30, -1e30)], vec![Vec2::X, Vec2::Y]);
    let none = (Vec::new(), Vec::new());
    for (positions, velocities) in [&crowd, &one, &same, &outside, &none] {
        for gamma in [0.0, 1e-12, 0.5, 1.0 - 1e-12, 1.0] {
            for alpha in [1e-12, 1e-6, 1.0, 1e6] {
                let chosen =
                    FitSettings { tolerance: 1e-6, max_iterations: 300, ..settings([16, 16], gamma, alpha) };
                let (field, report) = fit(chosen, positions, velocities);
                let place = (positions.len(), gamma, alpha, report);
                // At 1e-12 an empty cell weighs 1e-12 of a lit one: twelve digits apart, three are left to ask for.
                let reachable = if alpha > 1e-9 { 1e-6 } else { 1e-3 };
                assert!(report.error <= reachable, "{place:?}");
                assert!(points(field.grid()).all(|p| field.velocity(p).is_finite()), "{place:?}");
            }
        }
    }
}

#[test]
fn one_photon_moves_the_whole_plane_with_it() {
    // Constant velocity costs no bending.
    let v = Vec2::new(1.0, -2.0);
    for gamma in [0.0, 0.5, 1.0] {
        let (field, _) = fit(settings([16, 16], gamma, 1e-3), &[Vec2::new(0.3, 0.6)], &[v]);
        assert!(points(field.grid()).all(|p| field.velocity(p).distance(v) < 1e-4));
    }
}

#[test]
fn a_linear_potential_comes_back_on_any_grid() {
    // u = (y - .5, .5 - x) is divergence-free, u = (x, -y) irrotational; both bend, so alpha is small: along the
    // border it draws the velocity towards a constant by a few times its square root, 3e-4.
    for cells in [[8, 8], [31, 17], [64, 16]] {
        let grid_settings = settings(cells, 0.5, 1e-7);
        let (positions, _) = photons(5000, grid_settings.grid.extent);
        let positions: Vec<_> =
            positions.iter().map(|p| p.clamp(Vec2::ZERO, grid_settings.grid.extent)).collect();
        for (gamma, wanted) in [
            (0.0, (|p| Vec2::new(p.y - 0.5, 0.5 - p.x)) as fn(Vec2) -> Vec2),
            (0.5, |p| Vec2::new(p.x + p.y, p.x - 0.3)),
            (1.0, |p| Vec2::new(p.x, -p.y)),
        ] {
            let velocities: Vec<_> = positions.iter().map(|&p| wanted(p)).collect();
            let (field, _) = fit(FitSettings { gamma, ..grid_settings }, &positions, &velocities);
            let apart =
                points(field.grid()).map(|p| field.velocity(p).distance(wanted(p))).fold(0.0, f32::max);
            assert!(apart < 3e-3, "{cells:?} {gamma}: {apart}");
        }
    }
}

#[test]
fn the_thread_count_changes_no_bit() {
    let settings = settings([48, 40], 0.5, 1e-3);
    let (positions, velocities) = photons(20_000, settings.grid.extent);
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| fit(settings, &positions, &velocities))
    };
    assert_eq!(run(1), run(2));
}

#[test]
fn separate_potentials_blend_linearly_between_the_pure_fits() {
    let joint = settings([24, 24], 0.3, 1e-3);
    let (positions, velocities) = photons(5000, Vec2::ONE);
    let (separate, report) = fit(FitSettings { blend: Blend::Separate, ..joint }, &positions, &velocities);
    let pure = |gamma| fit(FitSettings { gamma, ..joint }, &positions, &velocities).0;
    let mut blended = Field::zero(joint.grid);
    Field::blend(&pure(0.0), 0.7, &pure(1.0), 0.3, &mut blended);
    assert!(difference(&blended, &separate) < 1e-5);
    assert_eq!(report.unknowns, 2 * 27 * 27);
    // The joint fit follows the photons better; it is another field.
    assert!(difference(&fit(joint, &positions, &velocities).0, &separate) > 1e-2);
}

#[test]
fn bad_settings_and_columns_are_refused() {
    let good = settings([16, 16], 0.5, 1e-3);
    let flat = Grid { cells: [16, 16], extent: Vec2::new(1.0, 0.0) };
    let few = Grid { cells: [2, 16], extent: Vec2::ONE };
    for bad in [
        FitSettings { gamma: 1.5, ..good },
        FitSettings { gamma: f64::NAN, ..good },
        FitSettings { alpha: 0.0, ..good },
        FitSettings { tolerance: f64::INFINITY, ..good },
        FitSettings { grid: flat, ..good },
        FitSettings { grid: few, ..good },
    ] {
        assert!(Fitter::new(bad).is_err(), "{bad:?}");
    }
    let mut fitter = Fitter::new(good).unwrap();
    let progress = Progress::new();
    assert!(fitter.fit(&[Vec2::ZERO], &[], &progress).is_err());
    assert!(fitter.fit(&[Vec2::NAN], &[Vec2::X], &progress).is_err());
    assert!(fitter.fit(&[Vec2::ZERO], &[Vec2::INFINITY], &progress).is_err());
    progress.cancel();
    assert!(fitter.fit(&[Vec2::ZERO], &[Vec2::X], &progress).is_err());
}
