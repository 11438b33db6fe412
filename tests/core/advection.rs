//! Photons along fitted fields: where they end, how exactly they get there, and that every pass moves alike.

use std::f32::consts::TAU;

use glam::{DVec2, Vec2, Vec3};
use lightloom_core::flow::field::{Field, Grid};
use lightloom_core::flow::flux;
use lightloom_core::flow::{
    Fade, FieldTrajectories, Fields, FlowReport, FlowSettings, GridSize, GuideTracks, Segment,
    Trajectories as _, fit_segment, fit_tracks, metric, spatial_order,
};
use lightloom_core::math::rng::{Purpose, Stream};
use lightloom_core::{Error, Progress};

const GAMMAS: [f32; 5] = [0.0, 1e-6, 0.25, 0.5, 1.0];

fn settings(gamma: f32, steps: u32) -> FlowSettings {
    FlowSettings { gamma, steps, grid: GridSize::Longer(32), ..FlowSettings::default() }
}

/// A disc that becomes a ring with four lobes, each photon led along its radius and turned a little: what no
/// divergence-free field can do, in a plane of 1 x 0.75.
fn disc_to_lobes(count: usize) -> (Vec<Vec2>, Vec<Vec2>) {
    let mut random = Stream::new(3, Purpose::Target, 0, 0);
    let center = Vec2::new(0.5, 0.375);
    (0..count)
        .map(|_| {
            let (radius, angle) = (random.f32().sqrt(), TAU * random.f32());
            let lobes = 0.12 + 0.15 * radius + 0.06 * (4.0 * angle).cos();
            let turned = angle + 0.3;
            (center + Vec2::from_angle(angle) * 0.2 * radius, center + Vec2::from_angle(turned) * lobes)
        })
        .unzip()
}

const EXTENT: Vec2 = Vec2::new(1.0, 0.75);

fn course<'a>(source: &'a [Vec2], target: &'a [Vec2], settings: &'a FlowSettings) -> Segment<'a> {
    Segment::new(source, target, EXTENT, settings)
}

fn fitted(source: &[Vec2], target: &[Vec2], settings: &FlowSettings) -> (Fields, FlowReport) {
    fit_segment(&course(source, target, settings), &Progress::new()).unwrap()
}

fn positions(fields: &Fields, source: &[Vec2], target: &[Vec2], times: &[f64]) -> Vec<Vec<Vec2>> {
    let mut carrier = FieldTrajectories::new(fields, source, target);
    let mut at = |t: &f64| {
        let mut out = vec![Vec2::ZERO; source.len()];
        carrier.positions_at(*t, &mut out, &Progress::new()).unwrap();
        out
    };
    times.iter().map(&mut at).collect()
}

fn rms_distance(a: &[Vec2], b: &[Vec2]) -> f64 {
    let sum: f64 = a.iter().zip(b).map(|(a, b)| f64::from(a.distance_squared(*b))).sum();
    (sum / a.len() as f64).sqrt()
}

#[test]
fn every_photon_ends_at_its_target_for_every_gamma_and_number_of_steps() {
    let (source, target) = disc_to_lobes(3000);
    for fade in [Fade::default(), Fade::Paper { tau: 0.85 }, Fade::Paper { tau: 0.0 }] {
        for gamma in GAMMAS {
            for steps in [1, 2, 7] {
                let (fields, report) =
                    fitted(&source, &target, &FlowSettings { fade, ..settings(gamma, steps) });
                let end = &positions(&fields, &source, &target, &[1.0])[0];
                // b - 0 v is b exactly.
                assert_eq!(end, &target, "{fade:?} gamma {gamma} steps {steps}");
                assert_eq!(report.endpoint_error, 0.0);
            }
        }
    }
}

#[test]
fn no_photon_jumps_at_the_end_or_between_steps() {
    let (source, target) = disc_to_lobes(2000);
    let (fields, report) = fitted(&source, &target, &settings(0.0, 10));
    let times: Vec<f64> = (0..=400).map(|i| f64::from(i) / 400.0).collect();
    let tracks = positions(&fields, &source, &target, &times);
    let fastest = report.peak_speed_ratio * report.mean_straight;
    for (n, pair) in tracks.windows(2).enumerate() {
        let mut ways: Vec<f32> = pair[0].iter().zip(&pair[1]).map(|(a, b)| a.distance(*b)).collect();
        ways.sort_by(f32::total_cmp);
        // The report samples speeds at the steps and their middles: 5 % for what lies between.
        let way = f64::from(ways[ways.len() * 998 / 1000]);
        assert!(way <= 1.05 * fastest / 400.0 + 1e-6, "{way} at {n}, {}", fastest / 400.0);
    }
}

#[test]
fn halving_the_step_divides_the_error_by_four_or_more() {
    let (source, target) = disc_to_lobes(2000);
    for fade in [Fade::default(), Fade::Smooth { start: 0.0, end: 1.0, limit: 1000.0 }] {
        let middle = |steps| {
            // A tight solver: its error must lie below that of the steps.
            let settings = FlowSettings { tolerance: 1e-7, fade, ..settings(0.3, steps) };
            let (fields, _) = fitted(&source, &target, &settings);
            positions(&fields, &source, &target, &[0.5, 0.75])
        };
        let reference = middle(320);
        let errors: Vec<f64> = [10, 20, 40]
            .map(|steps| middle(steps).iter().zip(&reference).map(|(a, b)| rms_distance(a, b)).sum())
            .to_vec();
        // Second order by the extrapolated field; 1.8 leaves room for the reference's own error and the speed limit's kinks.
        for pair in errors.windows(2) {
            assert!((pair[0] / pair[1]).log2() > 1.8, "{fade:?}: {errors:?}");
        }
    }
}

/// Nodes of a field that turns and grows linearly in time, which the extrapolation between nodes gives back exactly but
/// for the first step.
fn growing(steps: usize, fade: Fade, t_of_first: f32) -> Fields {
    let grid = Grid { cells: [32, 24], extent: EXTENT };
    let [nx, ny] = grid.nodes();
    let node = |t: f32| {
        let wave = |i: usize, phase: f32| {
            let (x, y) = ((i % nx) as f32 / nx as f32, (i / nx) as f32 / ny as f32);
            0.03 * (1.0 + t) * (5.0 * x + phase).sin() * (4.0 * y).cos()
        };
        let psi: Vec<f32> = (0..nx * ny).map(|i| wave(i, 0.0)).collect();
        let phi: Vec<f32> = (0..nx * ny).map(|i| wave(i, 1.0)).collect();
        Field::from_potentials(grid, &psi, &phi)
    };
    let nodes = (0..steps).map(|n| node((n as f32 / steps as f32).max(t_of_first))).collect();
    Fields::from_nodes(nodes, steps, fade, 0.2)
}

/// c(t) by very small steps of the paper's own equation in f64, the field taken between its nodes as the carrier does.
fn paper_by_small_steps(fields: &Fields, tau: f64, a: Vec2, b: Vec2, until: f64) -> Vec2 {
    let (steps, small) = (fields.steps(), 200);
    let mut c = a.as_dvec2();
    let slope = |n: usize, t: f64, c: DVec2| {
        let x = t * steps as f64 - n as f64;
        let [now, before] = [&fields.nodes()[n], &fields.nodes()[n.saturating_sub(1)]];
        let (now, before) = (now.velocity(c.as_vec2()).as_dvec2(), before.velocity(c.as_vec2()).as_dvec2());
        let u = now + x * (now - before);
        let s = ((t - tau) / (1.0 - tau)).clamp(0.0, 1.0);
        (1.0 - s) * u + s * (b.as_dvec2() - c) / (1.0 - t)
    };
    let h = 1.0 / (steps * small) as f64;
    for i in 0..(until * (steps * small) as f64).round() as usize {
        let (n, t) = (i / small, i as f64 * h);
        let half = c + 0.5 * h * slope(n, t, c);
        c += h * slope(n, t + 0.5 * h, half);
    }
    c.as_vec2()
}

#[test]
fn the_papers_fade_is_the_papers_equation() {
    let (source, target) = disc_to_lobes(40);
    // tau at a step's begin: a kink inside a step would cost the order.
    let fields = growing(40, Fade::Paper { tau: 0.85 }, 0.0);
    let times = [0.3, 0.85, 0.95, 0.99];
    for (t, at) in times.iter().zip(positions(&fields, &source, &target, &times)) {
        for i in 0..source.len() {
            let expected = paper_by_small_steps(&fields, 0.85, source[i], target[i], *t);
            // f32 positions, RK4 at h = 0.025; t = 0.99 lies within a step, where the cubic is of order 3.
            assert!(at[i].distance(expected) < 1e-5, "t {t}: {} {expected}", at[i]);
        }
    }
}

#[test]
fn runge_kutta_has_fourth_order_in_a_given_field() {
    let (source, target) = disc_to_lobes(200);
    // The field stands still, so that only the integration is measured; no limit and no end inside the run.
    let fade = Fade::Smooth { start: 0.0, end: 1.0, limit: 1000.0 };
    let at = |steps| positions(&growing(steps, fade, 1.0), &source, &target, &[0.5]).remove(0);
    let reference = at(128);
    let errors = [2, 4].map(|steps| rms_distance(&at(steps), &reference));
    // B-splines have a jump in u''': measured orders lie between 3.3 and 4.
    assert!((errors[0] / errors[1]).log2() > 3.0, "{errors:?}");
}

#[test]
fn a_guide_photon_moves_alike_in_every_later_pass() {
    let (source, target) = disc_to_lobes(3000);
    let settings = FlowSettings { guides: 500, ..settings(0.4, 6) };
    let GuideTracks { fields, report, positions: tracks, .. } =
        fit_tracks(&course(&source, &target, &settings), &Progress::new()).unwrap();
    assert_eq!((report.guides, tracks.len()), (500, 7));
    let mut carrier = FieldTrajectories::new(&fields, &source, &target);
    let mut now = vec![Vec2::ZERO; source.len()];
    for (n, track) in tracks.iter().enumerate().skip(1) {
        // Guides are photographed at the end of the step before.
        carrier.advance_to(n - 1, &Progress::new()).unwrap();
        carrier.positions_at(n as f64 / 6.0, &mut now, &Progress::new()).unwrap();
        for (guide, row) in (0..3000).step_by(6).enumerate() {
            // A step's end and the next one's begin differ by rounding.
            assert!(track[guide].distance(now[row]) < 3e-7, "step {n}");
        }
    }
}

#[test]
fn one_thread_and_two_give_the_same_bits() {
    let (source, target) = disc_to_lobes(20_000);
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let (fields, report) = fitted(&source, &target, &settings(0.5, 5));
            (positions(&fields, &source, &target, &[0.3, 0.77]), report)
        })
    };
    assert_eq!(run(1), run(2));
}

#[test]
fn times_may_be_asked_in_any_order() {
    let (source, target) = disc_to_lobes(300);
    let (fields, _) = fitted(&source, &target, &settings(0.5, 8));
    let ascending = positions(&fields, &source, &target, &[0.1, 0.4, 0.9]);
    let mut descending = positions(&fields, &source, &target, &[0.9, 0.4, 0.1]);
    descending.reverse();
    assert_eq!(ascending, descending);
}

#[test]
fn degenerate_photons_run() {
    let center = Vec2::new(0.5, 0.3);
    let (disc, lobes) = disc_to_lobes(100);
    let outside: Vec<Vec2> = disc.iter().map(|p| *p * 5.0 - 2.0).collect();
    let cases = [
        (vec![center], vec![Vec2::new(0.9, 0.7)]),
        (vec![center; 100], lobes.clone()),
        (disc, vec![center; 100]),
        (vec![center; 100], vec![center; 100]),
        (outside, lobes),
    ];
    for (source, target) in cases {
        for gamma in GAMMAS {
            for steps in [1, 3] {
                let (fields, report) = fitted(&source, &target, &settings(gamma, steps));
                let track = positions(&fields, &source, &target, &[0.0, 0.5, 1.0]);
                assert!(track.iter().flatten().all(|c| c.is_finite()));
                assert_eq!(track[2], target);
                assert!(report.endpoint_error == 0.0 && report.peak_speed_ratio.is_finite());
            }
        }
    }
}

#[test]
fn nothing_moves_where_source_and_target_are_one() {
    let (source, _) = disc_to_lobes(500);
    let (fields, report) = fitted(&source, &source, &settings(0.5, 4));
    for at in positions(&fields, &source, &source, &[0.0, 0.3, 1.0]) {
        assert_eq!(at, source);
    }
    assert_eq!((report.peak_speed_ratio, report.dispersion, report.field_share), (0.0, 0.0, 0.0));
}

#[test]
fn the_default_fade_does_not_snap() {
    let (source, target) = disc_to_lobes(20_000);
    let report = |gamma, fade| fitted(&source, &target, &FlowSettings { fade, ..settings(gamma, 30) }).1;
    for gamma in GAMMAS {
        let smooth = report(gamma, Fade::default());
        let limit = if gamma < 0.25 { 6.0 } else { 3.0 };
        assert!(smooth.peak_speed_ratio < limit, "gamma {gamma}: {smooth:?}");
        assert!(smooth.dispersion_max < 0.1, "gamma {gamma}: {smooth:?}");
    }
    // The measure sees the snap where there is one.
    let paper = report(0.0, Fade::Paper { tau: 0.85 });
    assert!(paper.peak_speed_ratio > 6.0, "{paper:?}");
}

#[test]
fn flux_keeps_its_total_on_the_way() {
    let mut random = Stream::new(5, Purpose::Target, 0, 0);
    let mut color = || Vec3::new(random.f32(), 0.3 * random.f32(), 2.0 * random.f32()) * 1e-6;
    let source: Vec<Vec3> = (0..100_000).map(|_| color()).collect();
    let colors: Vec<Vec3> = (0..100_000).map(|_| color() * 1e6).collect();
    let before = flux::total(&source);
    let count = source.len();
    let targets = [flux::share_out(before, &[], count), flux::share_out(before, &colors, count)];
    for (target, by_channel) in targets.iter().zip([true, false]) {
        for t in [0.0, 0.25, 0.5, 0.999, 1.0] {
            let mut now = vec![Vec3::ZERO; count];
            flux::blend(&source, target, t, &mut now);
            let ratio = flux::total(&now) / before;
            let whole = flux::total(&now).element_sum() / before.element_sum();
            assert!((whole - 1.0).abs() < 1e-6, "{whole} at {t}");
            assert!(!by_channel || (ratio - 1.0).abs().max_element() < 1e-6, "{ratio} at {t}");
        }
    }
}

#[test]
fn colours_that_let_no_light_through_leave_it_white() {
    let total = flux::total(&[Vec3::new(1.0, 0.0, 0.0)]);
    let shared = flux::share_out(total, &[Vec3::Y, Vec3::Z], 2);
    assert_eq!(shared, [Vec3::new(0.5, 0.0, 0.0); 2]);
}

#[test]
fn a_cancelled_run_says_so() {
    let (source, target) = disc_to_lobes(200);
    let cancelled = Progress::new();
    cancelled.cancel();
    let fit = fit_segment(&course(&source, &target, &settings(0.5, 4)), &cancelled);
    assert!(matches!(fit, Err(Error::Cancelled)));
    let (fields, _) = fitted(&source, &target, &settings(0.5, 4));
    let mut out = vec![Vec2::ZERO; source.len()];
    let carried = FieldTrajectories::new(&fields, &source, &target).positions_at(0.5, &mut out, &cancelled);
    assert!(matches!(carried, Err(Error::Cancelled)));
}

#[test]
fn photons_that_are_no_longer_finite_are_counted_not_spread() {
    let grid = Grid { cells: [8, 8], extent: Vec2::ONE };
    let nodes = grid.nodes()[0] * grid.nodes()[1];
    let broken = Field::from_potentials(grid, &vec![f32::NAN; nodes], &vec![0.0; nodes]);
    let fields = Fields::from_nodes(vec![broken], 1, Fade::Paper { tau: 0.5 }, 0.1);
    let (source, target) = disc_to_lobes(7);
    let mut out = vec![Vec2::ZERO; 7];
    let error =
        FieldTrajectories::new(&fields, &source, &target).positions_at(0.5, &mut out, &Progress::new());
    assert!(error.unwrap_err().to_string().contains("7 of 7 photons"));
}

#[test]
fn bad_photons_are_refused() {
    let refuse = |source: &[Vec2], target: &[Vec2], said: &str| {
        let error = fit_segment(&course(source, target, &settings(0.5, 2)), &Progress::new());
        let message = error.err().unwrap().to_string();
        assert!(message.contains(said), "{message}");
    };
    refuse(&[], &[], "no photons");
    refuse(&[Vec2::ZERO], &[], "1 photons but 0 targets");
    refuse(&[Vec2::ZERO, Vec2::NAN], &[Vec2::ZERO; 2], "photon 1");
}

#[test]
fn settings_out_of_range_are_named_and_the_rest_accepted() {
    let default = FlowSettings::default;
    default().check("flow").unwrap();
    let bad: [(FlowSettings, &str); 12] = [
        (FlowSettings { gamma: -0.1, ..default() }, "flow.gamma"),
        (FlowSettings { gamma: f32::NAN, ..default() }, "flow.gamma"),
        (FlowSettings { alpha: 0.0, ..default() }, "flow.alpha"),
        (FlowSettings { alpha: 1e30, ..default() }, "flow.alpha"),
        (FlowSettings { steps: 0, ..default() }, "flow.steps"),
        (FlowSettings { rho: 0.0, ..default() }, "flow.rho"),
        (FlowSettings { guides: 0, ..default() }, "flow.guides"),
        (FlowSettings { tolerance: 1.0, ..default() }, "flow.tolerance"),
        (FlowSettings { fade: Fade::Paper { tau: 1.0 }, ..default() }, "flow.fade.tau"),
        (FlowSettings { grid: GridSize::Both([0, 0]), ..default() }, "at least 8 x 8"),
        (FlowSettings { grid: GridSize::Both([1, 64]), ..default() }, "at least 8 x 8"),
        (FlowSettings { grid: GridSize::Longer(100_000), ..default() }, "GiB"),
    ];
    for (settings, said) in bad {
        let message = settings.check("flow").unwrap_err().to_string();
        assert!(message.contains(said), "{message}");
    }
    FlowSettings { grid: GridSize::Both([4096, 8]), ..default() }.check("flow").unwrap();
    FlowSettings { fade: Fade::Paper { tau: 0.0 }, gamma: 1.0, steps: 1, ..default() }.check("flow").unwrap();
    assert_eq!(GridSize::Longer(128).cells(Vec2::new(1.0, 0.5)), [128, 64]);
    assert_eq!(GridSize::Longer(128).cells(Vec2::new(0.001, 1.0)), [8, 128]);
}

#[test]
fn neighbours_that_move_alike_have_no_dispersion_and_crossing_ones_have_all() {
    let mut random = Stream::new(9, Purpose::Target, 0, 0);
    let places: Vec<Vec2> = (0..50_000).map(|_| Vec2::new(random.f32(), random.f32())).collect();
    let alike = metric::NeighbourVariance::new(&places, &vec![Vec2::X; 50_000], Vec2::ONE);
    assert!(alike.dispersion() < 1e-12);
    let signs: Vec<Vec2> = (0..50_000).map(|i| if i % 2 == 0 { Vec2::X } else { -Vec2::X }).collect();
    let crossing = metric::NeighbourVariance::new(&places, &signs, Vec2::ONE);
    // Without bias both are 1; 50 000 samples scatter by 1 %.
    assert!((crossing.dispersion() - 1.0).abs() < 0.02 && (crossing.crossing_index() - 1.0).abs() < 0.02);
}

#[test]
fn the_spatial_order_is_a_permutation_of_neighbours() {
    let (points, _) = disc_to_lobes(5000);
    let order = spatial_order(&points);
    let mut rows = order.clone();
    rows.sort_unstable();
    assert!(rows.into_iter().eq(0..5000));
    let walk: f32 = order.windows(2).map(|w| points[w[0] as usize].distance(points[w[1] as usize])).sum();
    let unsorted: f32 = points.windows(2).map(|w| w[0].distance(w[1])).sum();
    assert!(walk < 0.1 * unsorted, "{walk} {unsorted}");
}
