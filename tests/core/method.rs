//! The methods to compare with: their pairs, their ways, and that the vector field is the better one.

use glam::{Vec2, vec2};
use lightloom_core::flow::{
    FlowReport, FlowSettings, GridSize, PathTrajectories, Segment, fit_segment, path_report,
};
use lightloom_core::matching::{ContinuousMap, Pairing, StylizedMap, transport_map};
use lightloom_core::math::rng::{Purpose, Stream};
use lightloom_core::{Error, Progress};
use proptest::prelude::*;

/// Light through a wavy surface: folds and cusps.
fn caustic(count: usize, pass: u64) -> Vec<Vec2> {
    let waves = [(23.0, 9.0, 0.3), (-11.0, 27.0, 1.9), (31.0, -16.0, 4.0), (7.0, 35.0, 5.2)];
    let refract = |p: Vec2| {
        let bend = |&(x, y, phase): &(f32, f32, f32)| vec2(x, y) * 1.1e-3 * (vec2(x, y).dot(p) + phase).cos();
        p + waves.iter().map(bend).sum::<Vec2>()
    };
    let draw = |i: usize| {
        let mut random = Stream::new(7, Purpose::Trace, pass, i as u64);
        refract(vec2(0.1 + 0.8 * random.f32(), 0.1 + 0.8 * random.f32()))
    };
    (0..count).map(draw).collect()
}

/// A heart, apart from it six petals, and a stem.
fn flower(count: usize, pass: u64) -> Vec<Vec2> {
    let inside = |p: Vec2| {
        let from_heart = p - vec2(0.5, 0.6);
        let (angle, radius) = (from_heart.to_angle(), from_heart.length() / 0.3);
        let petal = radius > 0.35 && radius < 0.5 + 0.5 * (3.0 * angle).cos().abs();
        petal || radius < 0.25 || ((p.x - 0.5).abs() < 0.02 && p.y < 0.35 && p.y > 0.05)
    };
    let draw = |i: usize| {
        let mut random = Stream::new(7, Purpose::Target, pass, i as u64);
        loop {
            let p = vec2(random.f32(), random.f32());
            if inside(p) {
                return p;
            }
        }
    };
    (0..count).map(draw).collect()
}

fn stylized(source: &[Vec2], target: &[Vec2]) -> Pairing {
    let progress = Progress::new();
    let map = ContinuousMap::Stylized(StylizedMap::new(source, target, &progress).unwrap());
    map.pair(source, target, 1, 0, &progress).unwrap()
}

fn permuted(points: &[Vec2], pairing: &Pairing) -> Vec<Vec2> {
    pairing.matching.target_of.iter().map(|&row| points[row as usize]).collect()
}

fn watched(source: &[Vec2], target: &[Vec2], bows: &[Vec2]) -> FlowReport {
    path_report(&PathTrajectories::new(source, target, bows), Vec2::ONE, source.len(), 20, &Progress::new())
        .unwrap()
}

#[test]
fn the_vector_field_lets_at_most_a_fifth_of_the_light_cross() {
    let (source, target) = (caustic(40_000, 0), flower(40_000, 0));
    let progress = Progress::new();
    let before = stylized(&source, &target);
    let before = watched(&source, &permuted(&target, &before), &before.midpoint_offsets);
    let map = ContinuousMap::Transport(transport_map(&source, &target, Vec2::ONE, &progress).unwrap());
    let paired = permuted(&target, &map.pair(&source, &target, 1, 0, &progress).unwrap());
    let settings = FlowSettings { grid: GridSize::Longer(64), steps: 20, ..FlowSettings::default() };
    let (_, ours) = fit_segment(&Segment::new(&source, &paired, Vec2::ONE, &settings), &progress).unwrap();
    println!("stylized {:.4?}, field {:.4?}", before.crossing_index, ours.crossing_index);
    for (ours, before) in ours.crossing_index.iter().zip(before.crossing_index) {
        assert!(5.0 * ours <= before, "{ours} against {before}");
    }
    assert_eq!((before.endpoint_error, before.fits, before.field_share), (0.0, 0, 0.0));
}

#[test]
fn a_stylized_way_bows_by_a_tenth_of_what_the_warp_misses() {
    let (source, target) = (caustic(3000, 0), flower(3000, 0));
    let progress = Progress::new();
    let map = StylizedMap::new(&source, &target, &progress).unwrap();
    let (matching, bows) = map.pair(&source, &target, &progress).unwrap();
    let warped = map.apply_all(&source);
    for (i, &row) in matching.target_of.iter().enumerate() {
        let (a, b, f) = (source[i], target[row as usize], warped[i]);
        // q = (1-w) (a + b)/2 + w (a + f)/2 with w = 0.2; sums of numbers around 1 in f32.
        let q = 0.8 * (a + b) / 2.0 + 0.2 * (a + f) / 2.0;
        assert!(((a + b) / 2.0 + bows[i]).distance(q) < 1e-6);
    }
}

#[test]
fn later_passes_reuse_the_warp() {
    let progress = Progress::new();
    let map = StylizedMap::new(&caustic(4000, 0), &flower(4000, 0), &progress).unwrap();
    let cost = |pass: u64| {
        let (source, target) = (caustic(4000, pass), flower(4000, pass));
        let (matching, _) = map.pair(&source, &target, &progress).unwrap();
        assert!(matching.is_bijection());
        matching.cost(&source, &target)
    };
    let first = cost(0);
    // The points of the passes are other draws of the same light.
    for pass in 1..4 {
        assert!((cost(pass) / first - 1.0).abs() < 0.1, "pass {pass}: {} {first}", cost(pass));
    }
}

#[test]
fn one_thread_and_two_give_the_same_bits() {
    let (source, target) = (caustic(20_000, 0), flower(20_000, 0));
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let pairing = stylized(&source, &target);
            let report = watched(&source, &permuted(&target, &pairing), &pairing.midpoint_offsets);
            (pairing, report)
        })
    };
    assert!(on(1) == on(2));
}

#[test]
fn what_cannot_be_paired_is_refused() {
    let progress = Progress::new();
    let points = caustic(10, 0);
    let map = StylizedMap::new(&points, &points, &progress).unwrap();
    let bad = [vec2(0.0, f32::NAN); 10];
    let refused = |source: &[Vec2], target: &[Vec2]| {
        matches!(map.pair(source, target, &progress), Err(Error::Value { .. }))
    };
    assert!(refused(&points, &points[..9]) && refused(&points, &bad) && refused(&[], &[]));
    assert!(matches!(StylizedMap::new(&bad, &points, &progress), Err(Error::Value { .. })));
    progress.cancel();
    assert!(matches!(StylizedMap::new(&points, &points, &progress), Err(Error::Cancelled)));
    assert!(matches!(map.pair(&points, &points, &progress), Err(Error::Cancelled)));
}

#[test]
fn large_degenerate_sets_are_paired() {
    let line = |n: usize| (0..n).map(|i| vec2(i as f32 / n as f32, 0.5)).collect::<Vec<_>>();
    let spot = |n: usize| vec![vec2(0.3, 0.7); n];
    let far: Vec<Vec2> = caustic(3000, 0).iter().map(|p| *p * 1e6).collect();
    let cases = [
        (spot(3000), spot(3000)),
        (caustic(3000, 0), spot(3000)),
        (spot(3000), flower(3000, 0)),
        (line(3000), flower(3000, 0)),
        (caustic(3000, 0), line(3000)),
        (far, flower(3000, 0)),
    ];
    for (source, target) in cases {
        let pairing = stylized(&source, &target);
        assert!(
            pairing.matching.is_bijection() && pairing.midpoint_offsets.iter().all(|bow| bow.is_finite())
        );
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 256, failure_persistence: None, ..ProptestConfig::default() })]
    #[test]
    fn any_two_sets_of_equal_size_are_paired_one_to_one(
        points in prop::collection::vec((0_u8..4, 0_u8..4, -1.0_f32..2.0, -1.0_f32..2.0), 1..21),
        in_line in any::<[bool; 2]>(),
    ) {
        // Coarse coordinates repeat, fine ones do not; either may lie on a line.
        let on = |line: bool, p: Vec2| if line { vec2(p.x, 0.3 + 0.5 * p.x) } else { p };
        let source: Vec<Vec2> =
            points.iter().map(|p| on(in_line[0], vec2(f32::from(p.0), f32::from(p.1)) / 4.0)).collect();
        let target: Vec<Vec2> = points.iter().map(|p| on(in_line[1], vec2(p.2, p.3))).collect();
        for (source, target) in [(&source, &target), (&target, &source), (&source, &source)] {
            let pairing = stylized(source, target);
            prop_assert!(pairing.matching.is_bijection());
            prop_assert!(pairing.midpoint_offsets.len() == source.len() && pairing.midpoint_offsets.iter().all(|bow| bow.is_finite()));
            let report = watched(source, &permuted(target, &pairing), &pairing.midpoint_offsets);
            prop_assert!(report.endpoint_error == 0.0 && report.peak_speed_ratio.is_finite());
        }
    }
}
