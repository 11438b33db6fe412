//! Rays and landed photons per second. `photons` counts items: divan prints them per second.
#![allow(missing_docs, clippy::unwrap_used)]

#[path = "../scenes/mod.rs"]
mod scenes;

use divan::Bencher;
use divan::counter::ItemsCount;
use glam::Vec3;
use lightloom_core::Progress;
use lightloom_core::math::rng::{Purpose, Stream};
use lightloom_core::photon::{EmissionGuiding, Tracer};
use lightloom_core::scene::LightDesc;
use lightloom_core::scene::light::SpotLight;
use lightloom_core::scene::{Ray, Scene};
use scenes::{Stage, glass, icosphere, obj, point, square_lamp, wine_glass_obj};

fn main() {
    // One thread: the numbers are per core.
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global().unwrap();
    divan::main();
}

/// A thin wine glass of 50 k triangles, a point light beside and above it: the receiver lies in its caustic.
fn wine_scene() -> Scene {
    let mut stage = Stage::new();
    stage.mesh("wine glass", wine_glass_obj(128, 196), glass(1.5));
    stage.desc.lights.push(point(10.0, [-0.25, 0.45, 0.1]));
    stage.desc.receiver.size = [0.8, 0.8];
    stage.load()
}

/// A displaced sphere, rays of which half start inside: as in comparisons with other tracers.
fn rough_sphere(levels: usize) -> (Scene, Vec<Ray>) {
    let (unit, faces) = icosphere(levels);
    let vertices: Vec<Vec3> = unit
        .iter()
        .map(|v| *v * (1.0 + 0.05 * (9.0 * v.x).sin() * (11.0 * v.y).sin() * (7.0 * v.z).sin()))
        .collect();
    let mut stage = Stage::new();
    stage.mesh("sphere", obj(&vertices, None, &faces), glass(1.5));
    stage.desc.receiver.centre = [0.0, -100.0, 0.0];
    let mut rng = Stream::new(1, Purpose::Trace, 0, 0);
    let mut ball = || loop {
        let v = Vec3::new(rng.f32(), rng.f32(), rng.f32()) * 2.0 - 1.0;
        if v.length_squared() < 1.0 {
            return v;
        }
    };
    let rays = (0..200_000)
        .map(|i| {
            let origin = if i % 2 == 0 { ball() * 0.6 } else { ball().normalize() * 3.0 };
            Ray::new(origin, (ball() - if i % 2 == 0 { Vec3::ZERO } else { origin }).normalize())
        })
        .collect();
    (stage.load(), rays)
}

#[divan::bench(args = [6, 8], sample_count = 10)]
fn rays(bencher: Bencher, levels: usize) {
    let (scene, rays) = rough_sphere(levels);
    bencher
        .counter(ItemsCount::new(rays.len()))
        .bench_local(|| rays.iter().filter(|ray| scene.intersect(ray).is_some()).count());
}

#[divan::bench(sample_count = 10)]
fn aim(bencher: Bencher) {
    let scene = wine_scene();
    bencher.bench_local(|| Tracer::new(&scene, 1, &Progress::new()).unwrap().landing_rate());
}

/// A glass of the examples, 50 k triangles, in the light of a lamp that stands as far as one in a room.
fn lit_glass((glass, lamp): (&str, &str)) -> Scene {
    let file = format!("{}/../../assets/meshes/{glass}.obj", env!("CARGO_MANIFEST_DIR"));
    let mut stage = Stage::new();
    stage.mesh(glass, std::fs::read(file).unwrap(), scenes::glass(1.5));
    let position = [-3.9, 2.2, -1.0];
    stage.desc.lights.push(match lamp {
        "point" => point(10.0, position),
        "spot" => LightDesc::Spot(SpotLight {
            watts: 10.0,
            position,
            target: [0.0, 0.1, 0.0],
            angle_deg: 8.0,
            ..SpotLight::default()
        }),
        _ => square_lamp(),
    });
    stage.desc.receiver.centre = [0.1, 0.0, 0.06];
    stage.desc.receiver.size = [0.5, 0.5];
    stage.load()
}

/// `square` is a lamp of 10 cm: README's figure is for the goblet in its light.
#[divan::bench(sample_count = 3, args = [("goblet", "point"), ("goblet", "spot"), ("goblet", "square"),
    ("wine_glass", "point"), ("wine_glass", "spot"), ("wine_glass", "square")])]
fn photons(bencher: Bencher, scene: (&str, &str)) {
    let scene = lit_glass(scene);
    let tracer = Tracer::new(&scene, 1, &Progress::new()).unwrap();
    let mut pass = 0;
    bencher.counter(ItemsCount::new(1_000_000_usize)).bench_local(|| {
        pass += 1;
        tracer.trace(pass, 1_000_000, &Progress::new()).unwrap()
    });
}

#[divan::bench(sample_count = 10)]
fn photons_aimed_at_bounds(bencher: Bencher) {
    let scene = wine_scene();
    let tracer = Tracer::with_guiding(&scene, EmissionGuiding::Bounds, 1, &Progress::new()).unwrap();
    bencher
        .counter(ItemsCount::new(50_000_usize))
        .bench_local(|| tracer.trace(0, 50_000, &Progress::new()).unwrap());
}
