//! The matching is a bijection, near the optimum, coherent over passes, and survives what files may hold.

use glam::{DVec2, Vec2, vec2};
use lightloom_core::matching::{Matching, TransportMap, dual_bound, transport_map};
use lightloom_core::math::rng::{Purpose, Stream};
use lightloom_core::{Error, Progress};
use proptest::prelude::*;

/// Letters-like shapes in separate parts, uniformly filled.
fn shapes(n: usize, pass: u64) -> Vec<Vec2> {
    let inside = |p: Vec2| {
        let to_ring = p.distance(vec2(0.25, 0.5));
        let ring = to_ring > 0.11 && to_ring < 0.18;
        let stem = (p.x - 0.55).abs() < 0.035 && (p.y - 0.5).abs() < 0.18;
        let foot = (p.x - 0.64).abs() < 0.1 && (p.y - 0.34).abs() < 0.03;
        let cross = ((p.x - 0.855).abs() - (p.y - 0.5).abs() * 0.5).abs() < 0.03 && (p.y - 0.5).abs() < 0.18;
        ring || stem || foot || cross
    };
    (0..n).map(|i| draw(Stream::new(7, Purpose::Target, pass, i as u64), inside, |p| p)).collect()
}

/// Light through a wavy surface: folds, cusps and a smooth rest.
fn caustic(n: usize, pass: u64) -> Vec<Vec2> {
    let mut random = Stream::new(3, Purpose::Trace, 0, 0);
    let waves: Vec<(Vec2, f32, f32)> = (0..14)
        .map(|_| {
            let (angle, k) = (std::f32::consts::TAU * random.f32(), 8.0 + 30.0 * random.f32());
            (Vec2::from_angle(angle) * k, std::f32::consts::TAU * random.f32(), 0.08 / k.powf(1.6))
        })
        .collect();
    let refract = |p: Vec2| {
        p + waves.iter().map(|(k, phase, height)| *k * (height * (k.dot(p) + phase).cos())).sum::<Vec2>()
    };
    let inside = |p: Vec2| p.cmpge(Vec2::ZERO).all() && p.cmple(Vec2::ONE).all();
    (0..n).map(|i| draw(Stream::new(7, Purpose::Trace, pass, i as u64), inside, refract)).collect()
}

fn draw(mut stream: Stream, inside: impl Fn(Vec2) -> bool, map: impl Fn(Vec2) -> Vec2) -> Vec2 {
    loop {
        let p = map(vec2(1.2 * stream.f32() - 0.1, 1.2 * stream.f32() - 0.1));
        if inside(p) {
            return p;
        }
    }
}

fn matched(source: &[Vec2], target: &[Vec2]) -> (TransportMap, Matching) {
    let progress = Progress::new();
    let map = transport_map(source, target, Vec2::ONE, &progress).unwrap();
    let matching = Matching::new(source, target, &map, 1, 0, &progress).unwrap();
    assert!(matching.is_bijection());
    (map, matching)
}

/// The least mean squared distance over all bijections: shortest augmenting paths with potentials (Kuhn 1955, Munkres
/// 1957, in the O(n^3) form of Jonker and Volgenant 1987).
fn optimum(source: &[Vec2], target: &[Vec2]) -> f64 {
    let n = source.len();
    let cost = |i: usize, j: usize| source[i].as_dvec2().distance_squared(target[j].as_dvec2());
    // Column n is where each path begins; row_of[j] is the row that column j is given to.
    let (mut u, mut v, mut row_of) = (vec![0.0; n], vec![0.0; n + 1], vec![usize::MAX; n + 1]);
    for row in 0..n {
        row_of[n] = row;
        let (mut least, mut from) = (vec![f64::INFINITY; n], vec![n; n]);
        let (mut free, mut visited, mut column) = ((0..n).collect::<Vec<_>>(), vec![n], n);
        while row_of[column] != usize::MAX {
            let i = row_of[column];
            let mut best = 0;
            for (place, &j) in free.iter().enumerate() {
                let reduced = cost(i, j) - u[i] - v[j];
                if reduced < least[j] {
                    (least[j], from[j]) = (reduced, column);
                }
                if least[j] < least[free[best]] {
                    best = place;
                }
            }
            let delta = least[free[best]];
            for &j in &visited {
                u[row_of[j]] += delta;
                v[j] -= delta;
            }
            free.iter().for_each(|&j| least[j] -= delta);
            column = free.swap_remove(best);
            visited.push(column);
        }
        while column != n {
            row_of[column] = row_of[from[column]];
            column = from[column];
        }
    }
    (0..n).map(|j| cost(row_of[j], j)).sum::<f64>() / n as f64
}

/// Unexplained share of the velocity variance in 64 x 64 cells at time `t`.
fn crossing(source: &[Vec2], target: &[Vec2], matching: &Matching, t: f32) -> f64 {
    let mut cells = vec![(0.0, DVec2::ZERO, 0.0); 64 * 64];
    for (a, &row) in source.iter().zip(&matching.target_of) {
        let b = target[row as usize];
        let cell = (a.lerp(b, t) * 64.0).as_uvec2().min(glam::UVec2::splat(63));
        let (count, sum, squares) = &mut cells[(cell.y * 64 + cell.x) as usize];
        let velocity = (b - *a).as_dvec2();
        (*count, *sum, *squares) = (*count + 1.0, *sum + velocity, *squares + velocity.length_squared());
    }
    let variance =
        |(count, sum, squares): &(f64, DVec2, f64)| squares - sum.length_squared() / f64::max(*count, 1.0);
    let total = cells.iter().fold((0.0, DVec2::ZERO, 0.0), |a, b| (a.0 + b.0, a.1 + b.1, a.2 + b.2));
    cells.iter().map(variance).sum::<f64>() / variance(&total)
}

fn bound(map: &TransportMap, source: &[Vec2], target: &[Vec2]) -> f64 {
    dual_bound(map, source, target, &Progress::new()).unwrap()
}

#[test]
fn two_thousand_points_cost_at_most_two_percent_more_than_the_optimum() {
    let (source, target) = (caustic(2000, 0), shapes(2000, 0));
    let (map, matching) = matched(&source, &target);
    let optimum = optimum(&source, &target);
    let cost = matching.cost(&source, &target);
    println!("ratio {}, bound {}", cost / optimum, bound(&map, &source, &target) / optimum);
    // Rounding of 2000 f64 sums; a cost below the optimum would be a fault of the test.
    assert!(cost >= optimum * (1.0 - 1e-12));
    assert!(cost <= 1.02 * optimum, "{}", cost / optimum);
}

#[test]
fn the_dual_bound_is_below_the_optimum_of_any_points() {
    for seed in 0..6 {
        let (source, target) = (caustic(150, seed), shapes(150, seed));
        let optimum = optimum(&source, &target);
        // The bound holds for any map, even one of other points.
        for map in [matched(&source, &target).0, matched(&target, &caustic(150, 9)).0] {
            assert!(bound(&map, &source, &target) <= optimum * (1.0 + 1e-12));
        }
    }
}

#[test]
fn many_points_come_near_the_dual_bound_and_hardly_cross() {
    let (source, target) = (caustic(200_000, 0), shapes(200_000, 0));
    let (map, matching) = matched(&source, &target);
    let ratio = matching.cost(&source, &target) / bound(&map, &source, &target);
    let crossings = [0.25, 0.5, 0.75].map(|t| crossing(&source, &target, &matching, t));
    println!("ratio {ratio}, crossing {crossings:?}");
    assert!((1.0..1.03).contains(&ratio), "{ratio}");
    // A cell's own width explains a share of the variance of about this size.
    assert!(crossings.iter().all(|share| *share < 0.01), "{crossings:?}");
}

#[test]
fn photons_of_another_pass_go_where_their_neighbours_went() {
    let (source, target) = (caustic(100_000, 0), shapes(100_000, 0));
    let (map, first) = matched(&source, &target);
    let (source_7, target_7) = (caustic(100_000, 7), shapes(100_000, 7));
    let seventh = Matching::new(&source_7, &target_7, &map, 1, 7, &Progress::new()).unwrap();
    let mut apart: Vec<f32> = (0..400)
        .map(|i| {
            let a = source_7[i * 250];
            let nearest = (0..source.len())
                .min_by(|&i, &j| source[i].distance(a).total_cmp(&source[j].distance(a)))
                .unwrap();
            let went = target[first.target_of[nearest] as usize];
            went.distance(target_7[seventh.target_of[i * 250] as usize])
        })
        .collect();
    apart.sort_by(f32::total_cmp);
    println!("median {}, nine tenths within {}", apart[200], apart[360]);
    // Independent matchings disagree by 0.02; the points' own spacing here is 0.001 to 0.003.
    assert!(apart[200] < 0.008, "{}", apart[200]);
}

#[test]
fn equal_sets_cost_next_to_nothing() {
    let points = caustic(20_000, 0);
    let mut mixed = points.clone();
    mixed.reverse();
    let (_, matching) = matched(&points, &mixed);
    // Mean spacing squared is 5e-5: nobody moves further than to a neighbour.
    assert!(matching.cost(&points, &mixed) < 5e-5);
}

#[test]
fn a_square_onto_a_smaller_one_is_a_scaling() {
    let grid = |scale: f32, offset: f32| -> Vec<Vec2> {
        (0..400 * 400)
            .map(|i| (vec2((i % 400) as f32, (i / 400) as f32) + 0.5) / 400.0 * scale + offset)
            .collect()
    };
    let map = transport_map(&grid(1.0, 0.0), &grid(0.4, 0.5), Vec2::ONE, &Progress::new()).unwrap();
    for i in 0..100 {
        let p = (vec2((i % 10) as f32, (i / 10) as f32) + 0.5) / 10.0;
        // Two cells of 1/254; the uniform part of the densities (0.1 %) moves the map by less than one.
        assert!(map.apply(p).distance(p * 0.4 + 0.5) < 0.008, "{p} {}", map.apply(p));
    }
}

#[test]
fn threads_do_not_change_the_result() {
    let (source, target) = (caustic(50_000, 0), shapes(50_000, 0));
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let (map, matching) = matched(&source, &target);
            (matching, map.apply_all(&source), bound(&map, &source[..500], &target))
        })
    };
    assert!(on(1) == on(5));
}

#[test]
fn degenerate_sets_are_matched() {
    let line = |n: usize| (0..n).map(|i| vec2(i as f32 / n as f32, 0.5)).collect::<Vec<_>>();
    let spot = |n| vec![vec2(0.3, 0.7); n];
    let cases = [
        (line(1), spot(1)),
        (line(2), spot(2)),
        (line(3), line(3)),
        (spot(5000), spot(5000)),
        (caustic(5000, 0), spot(5000)),
        (spot(5000), shapes(5000, 0)),
        (line(5000), spot(5000)),
        (line(5000), shapes(5000, 0)),
        (caustic(5000, 0).iter().map(|p| *p * 3.0 - 1.0).collect(), shapes(5000, 0)),
        (caustic(5000, 0).iter().map(|p| *p * 1e6).collect(), shapes(5000, 0)),
    ];
    for (source, target) in cases {
        let (map, matching) = matched(&source, &target);
        let (cost, bound) = (matching.cost(&source, &target), bound(&map, &source, &target));
        assert!(cost.is_finite() && bound <= cost + 1e-9 * cost.abs().max(1e-6), "{bound} {cost}");
    }
    let (_, two) = matched(&[vec2(0.1, 0.1), vec2(0.9, 0.9)], &[vec2(0.8, 0.9), vec2(0.2, 0.1)]);
    assert_eq!(two.target_of, [1, 0]);
}

#[test]
fn what_cannot_be_matched_is_refused() {
    let progress = Progress::new();
    let points = caustic(10, 0);
    let map = transport_map(&points, &points, Vec2::ONE, &progress).unwrap();
    let bad = vec![vec2(0.0, f32::NAN); 10];
    let refused = |result: Result<Matching, Error>| matches!(result, Err(Error::Value { .. }));
    assert!(matches!(transport_map(&points, &[], Vec2::ONE, &progress), Err(Error::Value { .. })));
    assert!(matches!(transport_map(&bad, &points, Vec2::ONE, &progress), Err(Error::Value { .. })));
    assert!(refused(Matching::new(&points, &points[..9], &map, 1, 0, &progress)));
    assert!(refused(Matching::new(&points, &bad, &map, 1, 0, &progress)));
    assert!(refused(Matching::given(3, 4)));
    assert_eq!(Matching::given(3, 3).unwrap().target_of, [0, 1, 2]);
    progress.cancel();
    assert!(matches!(transport_map(&points, &points, Vec2::ONE, &progress), Err(Error::Cancelled)));
    assert!(matches!(Matching::new(&points, &points, &map, 1, 0, &progress), Err(Error::Cancelled)));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]
    #[test]
    fn any_two_sets_of_equal_size_are_matched_one_to_one(
        points in prop::collection::vec((0_u8..20, 0_u8..20, -1.0_f32..2.0, -1.0_f32..2.0), 1..200),
    ) {
        // Coarse coordinates repeat, fine ones do not.
        let source: Vec<Vec2> = points.iter().map(|p| vec2(f32::from(p.0), f32::from(p.1)) / 20.0).collect();
        let target: Vec<Vec2> = points.iter().map(|p| vec2(p.2, p.3)).collect();
        let (map, matching) = matched(&source, &target);
        prop_assert!(bound(&map, &source, &target) <= matching.cost(&source, &target) * (1.0 + 1e-9) + 1e-12);
    }
}
