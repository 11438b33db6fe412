//! The methods to compare with, measured.
#![allow(clippy::unwrap_used)]
use glam::{Vec2, vec2};
use lightloom_core::Progress;
use lightloom_core::flow::{Course, FlowReport, FlowSettings, Paths, fit_segment, watch_paths};
use lightloom_core::matching::{ContinuousMap, StylizedMap, dual_bound, mean_square_distance, transport_map};
use lightloom_core::math::rng::{Purpose, Stream};

fn draw(mut stream: Stream, inside: impl Fn(Vec2) -> bool, map: impl Fn(Vec2) -> Vec2) -> Vec2 {
    loop {
        let p = map(vec2(1.2 * stream.f32() - 0.1, 1.2 * stream.f32() - 0.1));
        if inside(p) {
            return p;
        }
    }
}
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
fn flower(n: usize, pass: u64) -> Vec<Vec2> {
    let inside = |p: Vec2| {
        let p = p - vec2(0.5, 0.5);
        let a = p.y.atan2(p.x);
        let r = p.length() / 0.35;
        let petal = r < 0.45 + 0.55 * (3.0 * a).cos().abs() && r > 0.25;
        petal || r < 0.12
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
fn show(name: &str, r: &FlowReport, cost: f64, bound: f64) {
    println!("{name}: crossing {:.4?} cost {:.3} disp {:.4}", r.crossing_index, cost / bound, r.dispersion);
}
#[test]
fn measure() {
    let n = 100_000;
    let p = Progress::new();
    for (name, source, target) in
        [("shapes", caustic(n, 0), shapes(n, 0)), ("flower", caustic(n, 0), flower(n, 0))]
    {
        let map = transport_map(&source, &target, Vec2::ONE, &p).unwrap();
        let bound = dual_bound(&map, &source, &target, &p).unwrap();
        let settings = FlowSettings::default();
        for (m, map) in [
            ("flow", ContinuousMap::Transport(map.clone())),
            ("linear", ContinuousMap::Transport(map.clone())),
            ("stylized", ContinuousMap::Stylized(StylizedMap::new(&source, &target, &p).unwrap())),
        ] {
            let t0 = std::time::Instant::now();
            let pair = map.pair(&source, &target, 1, 0, &p).unwrap();
            let el = t0.elapsed().as_secs_f32();
            let b: Vec<Vec2> = pair.matching.target_of.iter().map(|&i| target[i as usize]).collect();
            let report = if m == "flow" {
                fit_segment(&Course::new(&source, &b, Vec2::ONE, &settings), &p, None).unwrap().1
            } else {
                watch_paths(&Paths::new(&source, &b, &pair.bows), Vec2::ONE, n, 40, &p).unwrap()
            };
            show(
                &format!("{name} {m} pair {el:.2} s"),
                &report,
                mean_square_distance(&source, b.iter().copied()),
                bound,
            );
        }
    }
}
