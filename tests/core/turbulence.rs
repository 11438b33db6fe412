//! Turbulence: swirls that neither make nor swallow light, keep their strength, follow the law asked for, and let every
//! photon arrive.

use std::f64::consts::{PI, TAU};

use glam::Vec2;
use lightloom_core::flow::field::Field;
use lightloom_core::flow::{
    Fade, FieldTrajectories, Fields, FlowReport, FlowSettings, GridSize, GuideTracks, Segment,
    Trajectories as _, Turbulence, TurbulenceSettings, fit_segment, fit_tracks, metric,
};
use lightloom_core::math::rng::{Purpose, Stream};
use lightloom_core::{Error, Progress};

const EXTENT: Vec2 = Vec2::new(1.0, 0.75);

fn noise(strength: f32, grids: &[u32]) -> TurbulenceSettings {
    TurbulenceSettings { strength, grids: grids.to_vec(), rate: 4.0, ..Default::default() }
}

fn flow(turbulence: impl Into<Option<TurbulenceSettings>>) -> FlowSettings {
    FlowSettings {
        grid: GridSize::Longer(32),
        steps: 10,
        turbulence: turbulence.into(),
        ..Default::default()
    }
}

/// A disc that moves to the right and widens a little.
fn photons(count: usize) -> (Vec<Vec2>, Vec<Vec2>) {
    let mut random = Stream::new(5, Purpose::Target, 0, 0);
    (0..count)
        .map(|_| {
            let offset = Vec2::from_angle(random.f32() * TAU as f32) * random.f32().sqrt();
            (Vec2::new(0.3, 0.35) + 0.15 * offset, Vec2::new(0.6, 0.4) + 0.18 * offset)
        })
        .unzip()
}

fn fitted(settings: &FlowSettings, number: usize) -> (Fields, FlowReport) {
    let (source, target) = photons(2000);
    let course = Segment { number, ..Segment::new(&source, &target, EXTENT, settings) };
    fit_segment(&course, &Progress::new()).unwrap()
}

fn carried(fields: &Fields, times: &[f64]) -> Vec<Vec<Vec2>> {
    let (source, target) = photons(2000);
    let mut carrier = FieldTrajectories::new(fields, &source, &target);
    let mut at = |t: &f64| {
        let mut out = vec![Vec2::ZERO; source.len()];
        carrier.positions_at(*t, &mut out, &Progress::new()).unwrap();
        out
    };
    times.iter().map(&mut at).collect()
}

fn velocity(fields: &[Field], p: [f64; 2]) -> [f64; 2] {
    let each = fields.iter().map(|field| field.velocity_f64(p));
    each.fold([0.0; 2], |sum, u| [sum[0] + u[0], sum[1] + u[1]])
}

/// Root mean square over the plane by the midpoint rule on `side` x `side` points.
fn speed(fields: &[Field], extent: Vec2, side: usize) -> f64 {
    let sum: f64 = (0..side * side)
        .map(|i| {
            let [x, y] = [i % side, i / side].map(|n| (n as f64 + 0.5) / side as f64);
            let [u, v] = velocity(fields, [x * f64::from(extent.x), y * f64::from(extent.y)]);
            u * u + v * v
        })
        .sum();
    (sum / (side * side) as f64).sqrt()
}

#[test]
fn it_has_no_divergence_anywhere_at_any_time() {
    let turbulence = Turbulence::new(&noise(20.0, &[100, 30]), EXTENT, 0).unwrap();
    let mut random = Stream::new(6, Purpose::Target, 0, 0);
    let (h, mut slopes, mut worst) = (1e-6, 0.0, 0.0f64);
    for i in 0..500 {
        let fields = turbulence.at(f64::from(i % 7) / 6.1);
        let [x, y] = [EXTENT.x, EXTENT.y].map(|side| f64::from(side) * (0.01 + 0.98 * random.f64()));
        let (right, left) = (velocity(&fields, [x + h, y]), velocity(&fields, [x - h, y]));
        let (up, down) = (velocity(&fields, [x, y + h]), velocity(&fields, [x, y - h]));
        let (ux, vy) = ((right[0] - left[0]) / (2.0 * h), (up[1] - down[1]) / (2.0 * h));
        slopes += ux * ux / 500.0;
        worst = worst.max((ux + vy).abs());
        let p = Vec2::new(x as f32, y as f32);
        let slope: glam::Mat2 = fields.iter().map(|field| field.gradient(p)).sum();
        // One product in two orders of the factors, summed over two grids in f32.
        assert!((slope.x_axis.x + slope.y_axis.y).abs() < 1e-5 * slope.x_axis.length().max(1.0));
    }
    // Differences are off by h^2/6 u''', with u''' near 0.2 (2 pi 33)^3; the slopes themselves are near 10.
    assert!(worst < 2e-6 && slopes.sqrt() > 3.0, "{worst} of {}", slopes.sqrt());
}

#[test]
fn it_grows_from_nothing_does_not_pulse_and_is_gone_before_the_target_forms() {
    for (grids, extent) in [(&[8u32, 16][..], Vec2::ONE), (&[9, 13, 30], EXTENT), (&[6], Vec2::new(0.3, 1.0))]
    {
        for number in [0, 3] {
            let turbulence = Turbulence::new(&noise(30.0, grids), extent, number).unwrap();
            let at = |i: i32| speed(&turbulence.at(f64::from(i) / 40.0), extent, 150);
            for i in 6..=16 {
                // Asked for are 5 %; it is exact up to the midpoint rule with five points a cell, some 1e-3.
                assert!((at(i) / 0.3 - 1.0).abs() < 3e-3, "{grids:?} at {i}: {}", at(i));
            }
            let rising = (0..6).map(at).collect::<Vec<_>>();
            let falling = (16..=32).map(at).collect::<Vec<_>>();
            assert!(rising[0] == 0.0 && rising.is_sorted(), "{rising:?}");
            assert!(falling[16] < 1e-6 && falling.iter().rev().is_sorted(), "{falling:?}");
        }
    }
}

#[test]
fn neither_strength_nor_swirls_jump_at_a_key_noise() {
    let settings = TurbulenceSettings { rate: 5.0, ..noise(20.0, &[10]) };
    let turbulence = Turbulence::new(&settings, EXTENT, 0).unwrap();
    let at = |t: f64| velocity(&turbulence.at(t), [0.4, 0.3])[0];
    let change = |a: f64, b: f64| (at(b) - at(a)) / (b - a);
    let usual =
        (0..100).map(|i| change(f64::from(i) / 100.0, f64::from(i + 1) / 100.0).abs()).fold(0.0, f64::max);
    for key in 1..5 {
        let t = f64::from(key) / 5.0;
        let (before, after) = (change(t - 1e-3, t), change(t, t + 1e-3));
        // It stands still there: smoothstep is 3 x^2 near its ends, with x = 5e-3, against a slope of 1.5 midway; the
        // velocities are in f32.
        assert!(before.abs().max(after.abs()) < 0.05 * usual, "{before} {after} of {usual}");
    }
}

#[test]
fn time_goes_on_from_segment_to_segment() {
    for rate in [0.0, 0.7, 3.0, 4.5] {
        let settings = TurbulenceSettings { rate, ..noise(20.0, &[7, 20]) };
        for number in 0..4 {
            let [end, begin] = [(number, 1.0), (number + 1, 0.0)]
                .map(|(number, t)| Turbulence::new(&settings, EXTENT, number).unwrap().at(t));
            for i in 0..50 {
                let p = [f64::from(i % 7) / 7.0, f64::from(i) / 70.0];
                let (a, b) = (velocity(&end, p), velocity(&begin, p));
                // One and the same time, rounded once in f64.
                assert!((a[0] - b[0]).abs() + (a[1] - b[1]).abs() < 1e-6, "rate {rate}, segment {number}");
            }
        }
    }
}

/// Energy of the velocity per whole number of waves over the unit square, by a Fourier transform under Hann's window.
fn spectrum(fields: &[Field], waves: usize, energy: &mut [f64]) {
    let side = 6 * waves;
    let samples: Vec<[f64; 2]> = (0..side * side)
        .map(|i| {
            let [x, y] = [i % side, i / side].map(|n| (n as f64 + 0.5) / side as f64);
            let window = (PI * x).sin().powi(2) * (PI * y).sin().powi(2);
            velocity(fields, [x, y]).map(|u| window * u)
        })
        .collect();
    let wave = |k: isize, n: usize| (TAU * k as f64 * (n as f64 + 0.5) / side as f64).sin_cos();
    let all = waves as isize;
    for component in 0..2 {
        for kx in -all..=all {
            // Along x first, then along y.
            let rows: Vec<[f64; 2]> = samples
                .chunks_exact(side)
                .map(|row| {
                    row.iter().enumerate().fold([0.0; 2], |sum, (n, u)| {
                        let (sin, cos) = wave(kx, n);
                        [sum[0] + cos * u[component], sum[1] - sin * u[component]]
                    })
                })
                .collect();
            for ky in 0..=all {
                let [re, im] = rows.iter().enumerate().fold([0.0; 2], |sum, (n, [re, im])| {
                    let (sin, cos) = wave(ky, n);
                    [sum[0] + cos * re + sin * im, sum[1] + cos * im - sin * re]
                });
                let k = ((kx * kx + ky * ky) as f64).sqrt().round() as usize;
                if k < energy.len() {
                    energy[k] += re * re + im * im;
                }
            }
        }
    }
}

#[test]
fn the_spectrum_has_the_slope_asked_for() {
    let grids = [8, 16, 32, 64];
    for slope in [-5.0f32 / 3.0, -3.0, 0.0] {
        let mut energy = vec![0.0; 25];
        for seed in 0..4 {
            let settings = TurbulenceSettings { slope, seed, ..noise(100.0, &grids) };
            let turbulence = Turbulence::new(&settings, Vec2::ONE, 0).unwrap();
            spectrum(&turbulence.at(0.4), 25, &mut energy);
        }
        // The noise of n cells peaks at 0.33 n waves: between the first and the last peak every k has its octave.
        let points: Vec<[f64; 2]> = (3..=21).map(|k| [(k as f64).ln(), energy[k].ln()]).collect();
        let weight = |k: usize| 1.0 / (k + 3) as f64; // Evenly over ln k.
        let sum = |f: &dyn Fn([f64; 2]) -> f64| -> f64 {
            points.iter().enumerate().map(|(i, p)| weight(i) * f(*p)).sum()
        };
        let (n, x, y) = (sum(&|_| 1.0), sum(&|p| p[0]), sum(&|p| p[1]));
        let measured = (sum(&|p| p[0] * p[1]) - x * y / n) / (sum(&|p| p[0] * p[0]) - x * x / n);
        // Four draws scatter by some 0.05; the window mixes in the neighbouring k, and each end misses an octave.
        assert!((measured - f64::from(slope)).abs() < 0.2, "asked {slope}, measured {measured}: {energy:?}");
    }
}

#[test]
fn weights_take_the_place_of_the_slope() {
    let with = |weights: &[f32]| {
        let settings =
            TurbulenceSettings { weights: Some(weights.to_vec()), rate: 4.0, ..noise(20.0, &[8, 40]) };
        Turbulence::new(&settings, Vec2::ONE, 0).unwrap().at(0.25)
    };
    let fields = with(&[3.0, 4.0]);
    let [coarse, fine] = [&fields[..1], &fields[1..]].map(|field| speed(field, Vec2::ONE, 240));
    // A key's two grids have the shares 0.6 and 0.8 up to the small part they have in common.
    assert!((coarse / fine - 0.75).abs() < 1e-3, "{coarse} {fine}");
    assert!(speed(&with(&[0.0, 1.0])[..1], Vec2::ONE, 20) == 0.0);
}

#[test]
fn strength_zero_gives_the_same_bytes_as_no_turbulence() {
    let times = [0.0, 0.23, 0.5, 0.85, 1.0];
    let (absent, report) = fitted(&flow(None), 0);
    let (zero, zero_report) = fitted(&flow(noise(0.0, &[30, 100])), 0);
    assert!(carried(&absent, &times) == carried(&zero, &times));
    assert!(absent.nodes() == zero.nodes() && report == zero_report);
    assert!(zero.turbulence().is_none() && zero.noise(0.5).is_empty());
}

#[test]
fn every_photon_arrives_whatever_the_strength() {
    let (_, target) = photons(2000);
    for fade in [Fade::default(), Fade::Paper { tau: 0.85 }] {
        for (strength, grids) in [(20.0, &[30u32][..]), (100.0, &[100, 30]), (1000.0, &[512, 4])] {
            for gamma in [0.0, 0.5, 1.0] {
                let settings = FlowSettings { gamma, fade, ..flow(noise(strength, grids)) };
                let (fields, report) = fitted(&settings, 1);
                let tracks = carried(&fields, &[0.5, 0.9, 1.0]);
                assert!(tracks.iter().flatten().all(|p| p.is_finite()));
                // b - 0 v is b exactly.
                assert_eq!((&tracks[2], report.endpoint_error), (&target, 0.0));
                assert!((report.turbulence_rms - f64::from(strength) / 100.0).abs() < 1e-6);
            }
        }
    }
}

#[test]
fn the_photons_are_stirred_and_the_more_the_stronger() {
    let still = carried(&fitted(&flow(None), 0).0, &[0.5]).remove(0);
    let stirred = |settings| {
        let now = carried(&fitted(&flow(settings), 0).0, &[0.5]).remove(0);
        let sum: f64 = now.iter().zip(&still).map(|(a, b)| f64::from(a.distance_squared(*b))).sum();
        (sum / now.len() as f64).sqrt()
    };
    let [weak, strong] = [2.0, 20.0].map(|strength| stirred(noise(strength, &[15])));
    // Half the time at 0.02 and 0.2: less than the whole way, as the swirls turn; more than a tenth of it.
    assert!(
        (0.001..0.01).contains(&weak) && (0.01..0.1).contains(&strong) && strong > 4.0 * weak,
        "{weak} {strong}"
    );
}

#[test]
fn photons_with_nowhere_to_go_are_stirred_too_and_come_back() {
    let (source, _) = photons(500);
    let settings = flow(noise(20.0, &[20]));
    let course = Segment::new(&source, &source, EXTENT, &settings);
    let (fields, report) = fit_segment(&course, &Progress::new()).unwrap();
    let mut carrier = FieldTrajectories::new(&fields, &source, &source);
    let mut now = source.clone();
    carrier.positions_at(0.5, &mut now, &Progress::new()).unwrap();
    let moved = metric::endpoint_error(&now, &source);
    assert!(moved > 0.01 && report.endpoint_error == 0.0, "{moved}");
}

#[test]
fn a_seed_is_its_swirls() {
    let at = |seed: u64| {
        let settings = TurbulenceSettings { seed, ..noise(20.0, &[12, 30]) };
        carried(&fitted(&flow(settings), 0).0, &[0.5])
    };
    assert!(at(1) == at(1));
    assert!(at(1) != at(2));
}

#[test]
fn one_thread_and_two_give_the_same_bits() {
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| carried(&fitted(&flow(noise(40.0, &[30, 100])), 0).0, &[0.3, 0.8]))
    };
    assert!(with(1) == with(2));
}

#[test]
fn a_guide_photon_moves_alike_in_every_later_pass() {
    let (source, target) = photons(2000);
    let settings = FlowSettings { guides: 400, ..flow(noise(20.0, &[30])) };
    let course = Segment::new(&source, &target, EXTENT, &settings);
    let GuideTracks { fields, positions: tracks, .. } = fit_tracks(&course, &Progress::new()).unwrap();
    let times: Vec<f64> = (0..=10).map(|n| f64::from(n) / 10.0).collect();
    for (now, guides) in carried(&fields, &times).iter().zip(&tracks) {
        for (guide, row) in guides.iter().zip((0..2000).step_by(5)) {
            // A step's end and the next one's begin differ by rounding, which the swirls stretch.
            assert!(guide.distance(now[row]) < 3e-6);
        }
    }
}

#[test]
fn divergence_and_curl_of_the_report_include_it() {
    let settings = |turbulence| FlowSettings { gamma: 0.0, ..flow(turbulence) };
    let report = fitted(&settings(Some(noise(20.0, &[30]))), 0).1;
    let calm = fitted(&settings(None), 0).1;
    assert!(report.divergence_rms < 1e-4, "{}", report.divergence_rms);
    // Swirls of 0.2 with some 10 waves on the plane.
    assert!(report.curl_rms > 5.0 && calm.curl_rms < 5.0, "{} {}", report.curl_rms, calm.curl_rms);
}

#[test]
fn settings_out_of_range_are_named() {
    let good = TurbulenceSettings::default;
    let grids = |grids: &[u32]| TurbulenceSettings { grids: grids.to_vec(), ..good() };
    let weights = |weights: &[f32]| TurbulenceSettings { weights: Some(weights.to_vec()), ..grids(&[8, 16]) };
    let bad = [
        (TurbulenceSettings { strength: -1.0, ..good() }, "flow.turbulence.strength: is -1"),
        (TurbulenceSettings { strength: f32::NAN, ..good() }, "flow.turbulence.strength: is NaN"),
        (TurbulenceSettings { strength: 1001.0, ..good() }, "0 to 1000"),
        (TurbulenceSettings { slope: 11.0, ..good() }, "flow.turbulence.slope"),
        (TurbulenceSettings { rate: 101.0, ..good() }, "flow.turbulence.rate"),
        (TurbulenceSettings { rate: f32::INFINITY, ..good() }, "flow.turbulence.rate"),
        (TurbulenceSettings { seed: 1 << 53, ..good() }, "flow.turbulence.seed"),
        (grids(&[]), "flow.turbulence.grids: has 0 grids"),
        (grids(&[4, 5, 6, 7, 8, 9, 10, 11, 12]), "has 9 grids"),
        (grids(&[30, 3]), "flow.turbulence.grids[1]: is 3, must be 4 to 512 cells"),
        (grids(&[513]), "4 to 512"),
        (grids(&[30, 8, 30]), "flow.turbulence.grids[2]: is 30 cells once more"),
        (weights(&[1.0]), "flow.turbulence.weights: has 1 values for 2 grids"),
        (weights(&[1.0, -1.0]), "flow.turbulence.weights[1]"),
        (weights(&[0.0, 0.0]), "are all 0"),
        (TurbulenceSettings { rate: 100.0, ..grids(&[512, 511, 510, 509, 508, 507]) }, "GiB"),
    ];
    for (settings, said) in bad {
        let error = flow(settings).check("flow").unwrap_err();
        assert!(matches!(error, Error::Value { .. } | Error::Limit { .. }));
        assert!(error.to_string().contains(said), "{error}");
    }
    flow(good()).check("flow").unwrap();
    flow(TurbulenceSettings { rate: 0.0, ..grids(&[4, 512]) }).check("flow").unwrap();
}
