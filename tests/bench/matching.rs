//! The matching of a million photons: the map, the bijection, both, and the picture's points.
#![allow(clippy::unwrap_used)]

use std::hint::black_box;

use divan::Bencher;
use glam::{Vec2, vec2};
use lightloom_core::Progress;
use lightloom_core::matching::{Matching, dual_bound, transport_map};
use lightloom_core::math::rng::{Purpose, Stream};
use lightloom_core::targets::{ImageTarget, PictureSampler};

const MILLION: usize = 1_000_000;

fn main() {
    divan::main();
}

/// A cusped caustic: uniform light through a wavy surface.
fn source(n: usize) -> Vec<Vec2> {
    let photon = |i: usize| {
        let mut stream = Stream::new(1, Purpose::Trace, 0, i as u64);
        let p = vec2(stream.f32(), stream.f32());
        let wave = vec2((11.0 * p.x + 5.0 * p.y).cos(), (7.0 * p.y - 9.0 * p.x).sin());
        (p + 0.09 * wave).clamp(Vec2::ZERO, Vec2::ONE)
    };
    (0..n).map(photon).collect()
}

/// Two rings and a bar.
fn picture() -> PictureSampler {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("target.png");
    let lit = |x: u32, y: u32| {
        let p = vec2(x as f32, y as f32) / 512.0;
        let ring = |centre: Vec2| (0.1..0.17).contains(&p.distance(centre));
        ring(vec2(0.25, 0.6)) || ring(vec2(0.75, 0.6)) || (0.2..0.25).contains(&p.y)
    };
    image::GrayImage::from_fn(512, 512, |x, y| image::Luma([if lit(x, y) { 255 } else { 0 }]))
        .save(&path)
        .unwrap();
    PictureSampler::load(&path, &ImageTarget::new("target.png"), Vec2::ONE, "target").unwrap()
}

fn sets(n: usize) -> (Vec<Vec2>, Vec<Vec2>) {
    (source(n), picture().sample(1, 0, n).positions)
}

#[divan::bench(args = [20_000, MILLION])]
fn sample_picture(bencher: Bencher, n: usize) {
    let picture = picture();
    bencher.bench_local(|| picture.sample(1, 0, black_box(n)));
}

#[divan::bench(args = [20_000, MILLION])]
fn map(bencher: Bencher, n: usize) {
    let (source, target) = sets(n);
    bencher.bench_local(|| transport_map(&source, &target, Vec2::ONE, &Progress::new()).unwrap());
}

#[divan::bench(args = [20_000, MILLION])]
fn bijection(bencher: Bencher, n: usize) {
    let (source, target) = sets(n);
    let map = transport_map(&source, &target, Vec2::ONE, &Progress::new()).unwrap();
    bencher.bench_local(|| Matching::new(&source, &target, &map, 1, 0, &Progress::new()).unwrap());
}

#[divan::bench(args = [20_000, MILLION])]
fn map_and_bijection(bencher: Bencher, n: usize) {
    let (source, target) = sets(n);
    bencher.bench_local(|| {
        let map = transport_map(&source, &target, Vec2::ONE, &Progress::new()).unwrap();
        Matching::new(&source, &target, &map, 1, 0, &Progress::new()).unwrap()
    });
}

#[divan::bench]
fn bound_of_20_000(bencher: Bencher) {
    let (source, target) = sets(20_000);
    let map = transport_map(&source, &target, Vec2::ONE, &Progress::new()).unwrap();
    bencher.bench_local(|| dual_bound(&map, &source, &target, &Progress::new()));
}
