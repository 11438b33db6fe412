//! Photons: as many as asked for, the right flux, the same on any machine.

use std::f32::consts::PI;

use crate::scenes::{Stage, box_obj, glass, mirror, point, sphere_obj, square_lamp, wine_glass_obj};
use glam::{DVec3, Vec3};
use lightloom_core::math::rng::{Purpose, Stream};
use lightloom_core::photon::{EmissionGuiding, LightPart, Photons, Tracer};
use lightloom_core::scene::light::{
    DirectionalLight, LightRole, PointLight, RectangleLight, Sphere, SphereLight, SpotLight,
};
use lightloom_core::scene::material::{Diffuse, Glass, Material};
use lightloom_core::scene::{LightDesc, Ray, Scene};
use lightloom_core::{Error, Progress};

/// Two casters, three lights of different colour and kind.
fn crowded() -> Scene {
    let mut stage = Stage::new();
    stage.mesh("wine glass", wine_glass_obj(48, 80), glass(1.5));
    let ball = sphere_obj(4, Vec3::new(0.12, 0.05, 0.05), 0.05);
    let amber = Glass { absorption: [1.0, 8.0, 40.0], dispersion: Some(30.0), ior: 1.6 };
    stage.mesh("amber ball", ball, Some(Material::Glass(amber)));
    stage.mesh(
        "wall",
        box_obj(Vec3::new(-0.3, 0.0, -0.3), Vec3::new(-0.28, 0.1, 0.3)),
        Some(Material::Diffuse(Diffuse::default())),
    );
    stage.desc.lights.push(point(3.0, [-0.3, 0.5, 0.1]));
    stage.desc.lights.push(LightDesc::Rectangle(RectangleLight {
        colour: [1.0, 0.3, 0.1],
        position: [0.3, 0.4, 0.2],
        size: [0.1, 0.05],
        ..Default::default()
    }));
    stage.desc.lights.push(LightDesc::Spot(SpotLight {
        watts: 1.0,
        position: [0.0, 0.6, -0.4],
        target: [0.05, 0.1, 0.0],
        ..Default::default()
    }));
    stage.desc.receiver.size = [1.2, 0.9];
    stage.load()
}

fn trace(tracer: &Tracer, pass: u64, count: usize) -> Photons {
    tracer.trace(pass, count, &Progress::new()).unwrap().0
}

#[test]
fn exactly_as_many_photons_land_as_asked_for() {
    let scene = crowded();
    let tracer = Tracer::new(&scene, 1, &Progress::new()).unwrap();
    let total = |count| trace(&tracer, 0, count).total_flux().element_sum();
    let reference = total(300_000);
    for count in [1, 2, 1000, 20_000, 54_321] {
        let photons = trace(&tracer, 3, count);
        assert_eq!(photons.len(), count);
        assert_eq!([photons.flux.len(), photons.light.len(), photons.mesh.len()], [count; 3]);
        assert!(photons.positions.iter().all(|p| scene.receiver().contains(*p)));
        assert!(photons.light.iter().all(|l| *l < 3) && photons.mesh.iter().all(|m| *m < 2));
        // Whatever the number, they carry the same light. Few come of one batch of 8192 candidates, whose own noise is
        // some percent.
        assert!((total(count) / reference - 1.0).abs() < 0.1, "{count}");
    }
    assert!(tracer.trace(0, 0, &Progress::new()).is_err());
}

#[test]
fn the_first_photons_are_an_even_sample_of_all() {
    let scene = crowded();
    let all = trace(&Tracer::new(&scene, 1, &Progress::new()).unwrap(), 0, 100_000);
    let first = |n: usize| Photons {
        positions: all.positions[..n].to_vec(),
        flux: all.flux[..n].to_vec(),
        light: all.light[..n].to_vec(),
        mesh: all.mesh[..n].to_vec(),
    };
    let (part, whole) = (quarters(&scene, &first(10_000)), quarters(&scene, &all));
    for (part, whole) in part.iter().zip(whole) {
        let error = part.1.sqrt();
        assert!((part.0 - whole.0 * 0.1).abs() < 4.0 * error, "{} of {} +- {error}", part.0, whole.0);
    }
    let share =
        |photons: &Photons| photons.light.iter().filter(|l| **l == 1).count() as f64 / photons.len() as f64;
    assert!((share(&first(10_000)) / share(&all) - 1.0).abs() < 0.1);
}

#[test]
fn one_thread_or_many_give_the_same_bytes() {
    let scene = crowded();
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| trace(&Tracer::new(&scene, 5, &Progress::new()).unwrap(), 2, 50_000))
    };
    let bits = |photons: &Photons| -> Vec<[u32; 5]> {
        let flux = photons.flux.iter().map(|f| f.to_array().map(f32::to_bits));
        photons
            .positions
            .iter()
            .zip(flux)
            .map(|(p, [r, g, b])| [p.x.to_bits(), p.y.to_bits(), r, g, b])
            .collect()
    };
    let (one, three) = (run(1), run(3));
    assert_eq!(bits(&one), bits(&three));
    assert_eq!((&one.light, &one.mesh), (&three.light, &three.mesh));
}

#[test]
fn passes_and_seeds_are_independent() {
    let scene = crowded();
    let tracer = Tracer::new(&scene, 1, &Progress::new()).unwrap();
    let other = Tracer::new(&scene, 2, &Progress::new()).unwrap();
    let (a, b, c) = (trace(&tracer, 0, 1000), trace(&tracer, 1, 1000), trace(&other, 0, 1000));
    let same = |x: &Photons, y: &Photons| x.positions.iter().filter(|p| y.positions.contains(p)).count();
    assert_eq!([same(&a, &b), same(&a, &c)], [0, 0]);
    assert_eq!(a, trace(&tracer, 0, 1000));
}

/// Sum and variance of the flux in each of four quarters of the receiver.
fn quarters(scene: &Scene, photons: &Photons) -> [(f64, f64); 4] {
    let middle = scene.receiver().extent() / 2.0;
    let mut sums = [(0.0, 0.0); 4];
    for (p, flux) in photons.positions.iter().zip(&photons.flux) {
        let quarter = usize::from(p.x > middle.x) + 2 * usize::from(p.y > middle.y);
        let flux = f64::from(flux.element_sum());
        sums[quarter].0 += flux;
        sums[quarter].1 += flux * flux;
    }
    sums
}

#[test]
fn aimed_emission_lands_the_same_light_as_shining_everywhere() {
    let scene = crowded();
    let by = |aim, count| {
        let tracer = Tracer::with_guiding(&scene, aim, 11, &Progress::new()).unwrap();
        (quarters(&scene, &trace(&tracer, 0, count)), tracer.landing_rate())
    };
    let (everywhere, rate) = by(EmissionGuiding::Unguided, 30_000);
    let (bounds, _) = by(EmissionGuiding::Bounds, 100_000);
    let (learned, learned_rate) = by(EmissionGuiding::Learned, 300_000);
    for quarter in 0..4 {
        for aimed in [bounds, learned] {
            let difference = aimed[quarter].0 - everywhere[quarter].0;
            let error = (aimed[quarter].1 + everywhere[quarter].1).sqrt();
            // Eight comparisons within 3.5 standard errors: fails by chance once in 270.
            assert!(difference.abs() < 3.5 * error, "{quarter}: {difference} +- {error}");
        }
    }
    assert!(learned_rate > 5.0 * rate, "{learned_rate} against {rate}");
}

#[test]
fn all_photons_weigh_the_same_and_few_share_a_place() {
    let scene = crowded();
    let photons = trace(&Tracer::new(&scene, 1, &Progress::new()).unwrap(), 0, 100_000);
    let mean = photons.total_flux().element_sum() / 100_000.0;
    // Rounding of three channels.
    assert!(photons.flux.iter().all(|f| (f64::from(f.element_sum()) / mean - 1.0).abs() < 1e-5));
    let mut at: Vec<_> = photons.positions.iter().map(|p| p.to_array().map(f32::to_bits)).collect();
    at.sort_unstable();
    let squares: usize = at.chunk_by(|a, b| a == b).map(|same| same.len().pow(2)).sum();
    // (sum w)^2 / sum w^2 of the light in each place.
    println!("as good as {:.3} of all", 1e5 / squares as f64);
    assert!(1e5 / squares as f64 > 0.75);
}

/// A wine glass in the light of a distant square lamp: much of it is caught in the wall and the stem.
fn trapping() -> Scene {
    let mut stage = Stage::new();
    stage.mesh("wine glass", wine_glass_obj(64, 100), glass(1.5));
    stage.desc.lights.push(square_lamp());
    stage.desc.receiver.centre = [0.1, 0.0, 0.06];
    stage.desc.receiver.size = [0.5, 0.5];
    stage.load()
}

/// Flux in 8 x 8 blocks of the receiver, and of all, by passes: means and their variances.
fn blocks(tracer: &Tracer) -> (Vec<[f64; 2]>, u64) {
    const PASSES: u64 = 16;
    let mut sums = vec![[0.0; 2]; 65];
    let mut rays = 0;
    for pass in 0..PASSES {
        let (photons, report) = tracer.trace(pass, 20_000, &Progress::new()).unwrap();
        rays += report.balance.rays;
        let mut flux = vec![0.0; 65];
        for (p, f) in photons.positions.iter().zip(&photons.flux) {
            let [x, y] = p.to_array().map(|x| ((8.0 * x) as usize).min(7));
            flux[8 * y + x] += f64::from(f.element_sum());
            flux[64] += f64::from(f.element_sum());
        }
        sums.iter_mut().zip(flux).for_each(|(sum, f)| *sum = [sum[0] + f, sum[1] + f * f]);
    }
    let n = PASSES as f64;
    let mean = |[sum, squares]: [f64; 2]| [sum / n, (squares / n - (sum / n).powi(2)) / (n - 1.0)];
    (sums.into_iter().map(mean).collect(), rays)
}

#[test]
fn ending_hopeless_paths_early_leaves_the_light_as_it_is() {
    let scene = trapping();
    let by = |guiding| blocks(&Tracer::with_guiding(&scene, guiding, 5, &Progress::new()).unwrap());
    let (whole, all_rays) = by(EmissionGuiding::Cells);
    let (ended, rays) = by(EmissionGuiding::Learned);
    assert!((rays as f64) < 0.9 * all_rays as f64, "it pays: {rays} rays instead of {all_rays}");
    let z = |k: usize| (ended[k][0] - whole[k][0]) / (ended[k][1] + whole[k][1]).sqrt();
    // Normal to a good approximation: beyond 4 once in 16 000.
    assert!(z(64).abs() < 4.0, "all: {} standard errors", z(64));
    // Blocks with a hundred photons in all passes; Student's t of 30 degrees has a variance of 1.07, and the rms of some
    // fifty is within a third of 1 but once in a thousand.
    let lit: Vec<f64> = (0..64).filter(|k| whole[*k][0] > 3e-4 * whole[64][0]).map(z).collect();
    let rms = (lit.iter().map(|z| z * z).sum::<f64>() / lit.len() as f64).sqrt();
    let most = lit.iter().fold(0.0_f64, |most, z| most.max(z.abs()));
    println!("{} blocks, rms {rms:.2}, most {most:.1}, all {:.2}", lit.len(), z(64));
    assert!(lit.len() > 20 && rms < 1.35 && most < 5.5, "{} blocks: {rms}, {most}", lit.len());
}

#[test]
fn light_that_is_not_trapped_is_followed_to_its_end() {
    let mut stage = Stage::new();
    stage.mesh("ball", sphere_obj(4, Vec3::new(0.0, 0.1, 0.0), 0.05), glass(1.5));
    stage.desc.lights.push(point(1.0, [0.3, 0.8, 0.1]));
    let scene = stage.load();
    let by = |guiding| trace(&Tracer::with_guiding(&scene, guiding, 5, &Progress::new()).unwrap(), 0, 10_000);
    assert!(by(EmissionGuiding::Cells) == by(EmissionGuiding::Learned), "the same photons to the bit");
}

fn lights() -> Vec<LightDesc> {
    let (watts, position) = (8.0, [0.3, 2.0, -0.2]);
    vec![
        point(watts, position),
        LightDesc::Spot(SpotLight { watts, position, angle_deg: 70.0, soft_edge: 0.6, ..Default::default() }),
        LightDesc::Spot(SpotLight {
            watts,
            position,
            angle_deg: 360.0,
            soft_edge: 1.0,
            ..Default::default()
        }),
        LightDesc::Rectangle(RectangleLight { watts, position, size: [1.5, 0.4], ..Default::default() }),
        LightDesc::Sphere(SphereLight { watts, position, radius: 0.4, ..Default::default() }),
    ]
}

/// Mean over the square of what an emission sends along rays that pass `keep` [W], red channel.
fn emitted(light: &LightDesc, target: Option<Sphere>, keep: impl Fn(&Ray) -> bool) -> f64 {
    let emission = light.emission(target, Sphere { centre: Vec3::ZERO, radius: 10.0 });
    let n = 600;
    let mut rng = Stream::new(9, Purpose::Trace, 0, 0);
    let kept = (0..n * n)
        .filter(|k| {
            let u = [(k % n) as f32 + rng.f32(), (k / n) as f32 + rng.f32()].map(|x| x / n as f32);
            emission.sample(u, &mut rng).is_some_and(|ray| keep(&ray))
        })
        .count();
    f64::from(emission.flux.x) * kept as f64 / f64::from(n * n)
}

#[test]
fn every_light_emits_its_watts() {
    for light in lights() {
        let watts = emitted(&light, None, |ray| ray.direction.is_normalized());
        // A share of 360 000 is refused at random: at most 1e-3.
        assert!((watts / 8.0 - 1.0).abs() < 3e-3, "{light:?}: {watts}");
    }
}

#[test]
fn every_light_sends_the_same_to_a_ball_aimed_or_not() {
    let sun = LightDesc::Directional(DirectionalLight { angle_deg: 5.0, ..Default::default() });
    for light in lights().into_iter().chain([sun]) {
        for target in [Sphere { centre: Vec3::ZERO, radius: 0.5 }, Sphere { centre: Vec3::Y, radius: 0.8 }] {
            let all = emitted(&light, None, |ray| target.intersects(ray));
            let aimed = emitted(&light, Some(target), |ray| target.intersects(ray));
            // The unaimed share is a few percent of 360 000 at least, for the sun 0.25 %.
            assert!((aimed / all - 1.0).abs() < 0.06, "{light:?}: {aimed} against {all}");
            let cut = emitted(&light, Some(target), |_| true);
            assert!(cut >= aimed * 0.999, "{light:?}");
        }
    }
}

#[test]
fn photons_and_shadow_rays_agree_on_the_irradiance() {
    let place = Vec3::new(0.1, 0.0, 0.2);
    let small = Sphere { centre: place, radius: 0.01 };
    let sun = LightDesc::Directional(DirectionalLight { angle_deg: 5.0, ..Default::default() });
    for light in lights().into_iter().chain([sun]) {
        let by_photons =
            emitted(&light, Some(small), |ray| small.intersects(ray)) / f64::from(PI * 0.01 * 0.01);
        let mut rng = Stream::new(9, Purpose::Trace, 0, 1);
        let n = 20_000;
        let sum: f64 = (0..n)
            .filter_map(|_| light.illuminate(place, [rng.f32(), rng.f32()]))
            .inspect(|lit| assert!(lit.direction.is_normalized() && lit.distance > 0.0))
            .map(|lit| f64::from(lit.irradiance.x))
            .sum();
        assert!((sum / f64::from(n) / by_photons - 1.0).abs() < 0.01, "{light:?}: {sum} {by_photons}");
        let toward = light.illuminate(place, [0.4, 0.7]).unwrap();
        if let Some((distance, _)) = light.intersect(&Ray::new(place, toward.direction)) {
            assert!((distance / toward.distance - 1.0).abs() < 1e-4);
        }
    }
}

#[test]
fn a_turned_receiver_catches_where_it_stands() {
    // A wall facing +x at x = -1: plane x runs along world -z ... whatever it is, the landing point is where the ray met.
    let mut stage = Stage::new();
    stage.mesh("lens", sphere_obj(4, Vec3::new(0.0, 0.5, 0.0), 0.1), glass(1.5));
    stage.desc.lights.push(point(1.0, [1.0, 0.5, 0.0]));
    stage.desc.receiver.centre = [-0.5, 0.5, 0.0];
    stage.desc.receiver.rotate = [0.0, 0.0, -90.0];
    stage.desc.receiver.size = [1.0, 2.0];
    let scene = stage.load();
    assert!(scene.receiver().normal().distance(Vec3::X) < 1e-6);
    let photons = trace(&Tracer::new(&scene, 1, &Progress::new()).unwrap(), 0, 20_000);
    let mean =
        photons.positions.iter().map(|p| scene.receiver().world_from_plane(*p)).sum::<Vec3>() / 20_000.0;
    assert!(mean.distance(Vec3::new(-0.5, 0.5, 0.0)) < 0.01, "{mean}");
    for p in &photons.positions[..100] {
        let world = scene.receiver().world_from_plane(*p);
        assert!(scene.receiver().plane_from_world(world).distance(*p) < 1e-6);
    }
}

/// What the artist reads when nothing lands.
fn complaint(change: impl FnOnce(&mut Stage)) -> String {
    let mut stage = Stage::new();
    stage.mesh("ball", sphere_obj(3, Vec3::new(0.0, 0.5, 0.0), 0.1), glass(1.5));
    stage.desc.lights.push(LightDesc::Point(PointLight { name: "lamp".into(), ..Default::default() }));
    change(&mut stage);
    match Tracer::new(&stage.load(), 1, &Progress::new()) {
        Err(Error::Value { what, .. }) => what,
        Err(other) => panic!("{other}"),
        Ok(_) => panic!("a caustic was found"),
    }
}

#[test]
fn a_missing_caustic_is_explained() {
    let dark = LightDesc::Point(PointLight { name: "lamp".into(), watts: 0.0, ..Default::default() });
    assert!(complaint(|stage| stage.desc.lights.clear()).contains("there is no light"));
    assert!(complaint(|stage| stage.desc.meshes.clear()).contains("no mesh is of glass"));
    assert!(complaint(|stage| stage.desc.lights = vec![dark]).contains("sends no light"));
    let away = complaint(|stage| stage.desc.receiver.centre = [50.0, 0.0, 0.0]);
    assert!(away.contains("'lamp'") && away.contains("'ball'") && away.contains("1 x 1 m"), "{away}");
    assert!(away.contains("100 % leaves the scene"), "{away}");
    let behind = complaint(|stage| stage.desc.receiver.rotate = [180.0, 0.0, 0.0]);
    assert!(behind.contains("receiver's back"), "{behind}");
    let softbox = PointLight { role: LightRole::Background, ..Default::default() };
    let none_casts = complaint(|stage| stage.desc.lights = vec![LightDesc::Point(softbox)]);
    assert!(none_casts.contains("role \"background\""), "{none_casts}");
    let shaded = complaint(|stage| {
        let lid = box_obj(Vec3::new(-2.0, 1.0, -2.0), Vec3::new(2.0, 1.1, 2.0));
        stage.mesh("lid", lid, Some(Material::Diffuse(Diffuse::default())));
    });
    assert!(shaded.contains("'lid' stands between it and 'ball'"), "{shaded}");
    let black = complaint(|stage| stage.desc.meshes[0].material = mirror(0.0));
    assert!(black.contains("100 % is absorbed"), "{black}");
}

#[test]
fn what_flows_and_what_stays_are_all_the_light_and_fade_into_each_other() {
    let mut stage = Stage::new();
    stage.mesh("wine glass", wine_glass_obj(48, 80), glass(1.5));
    stage.desc.lights.push(point(3.0, [-0.3, 0.5, 0.1]));
    stage.desc.receiver.size = [0.5, 0.4];
    stage.desc.receiver.surround = 0.3;
    stage.desc.receiver.border = 0.2;
    let scene = stage.load();
    let receiver = scene.receiver();
    let by = |part| {
        let seen = Tracer::of_part((&scene, part), EmissionGuiding::Learned, 3, &Progress::new()).unwrap();
        trace(&seen, 0, 200_000)
    };
    let (flowing, shown) = (by(LightPart::Flowing), by(LightPart::Shown));
    let power = |photons: &Photons, share: &dyn Fn(glam::Vec2) -> f32| -> f64 {
        let rows = photons.positions.iter().zip(&photons.flux);
        rows.map(|(at, flux)| f64::from(flux.element_sum() * share(*at))).sum()
    };
    let (all, in_flow) = (power(&shown, &|_| 1.0), power(&flowing, &|_| 1.0));
    let expected = power(&shown, &|at| receiver.flowing_share(at));
    // Some 100 000 photons each: 0.5 % apart.
    assert!((in_flow / expected - 1.0).abs() < 0.01, "{in_flow} {expected}");
    assert!((0.1..0.9).contains(&(in_flow / all)), "the border takes part of the light: {in_flow} of {all}");
    assert!(flowing.positions.iter().all(|at| receiver.contains(*at)));
    assert!(shown.positions.iter().any(|at| !receiver.contains(*at)), "the floor beside it is lit, too");
    // Both shares are smooth: over the edge, over the corner, and out to where light is shown no more.
    let steps = (0..=1000).map(|i| glam::vec2(0.5, 0.4).lerp(glam::vec2(1.6, 1.3), i as f32 / 1000.0));
    let shares: Vec<[f32; 2]> =
        steps.map(|at| [receiver.flowing_share(at), receiver.shown_share(at)]).collect();
    // A smoothstep over 0.2 rises by 1.5 / 0.2 per unit; two of them, over steps of 0.0014.
    let jump = |pair: &[[f32; 2]]| (0..2).any(|i| (pair[1][i] - pair[0][i]).abs() > 0.025);
    assert!(!shares.windows(2).any(jump) && shares[0] == [1.0, 1.0] && shares[1000] == [0.0, 0.0]);
}

#[test]
fn tracing_stops_when_asked() {
    let scene = crowded();
    let tracer = Tracer::new(&scene, 1, &Progress::new()).unwrap();
    let progress = Progress::new();
    progress.cancel();
    assert!(matches!(tracer.trace(0, 100_000_000, &progress), Err(Error::Cancelled)));
    assert!(matches!(Tracer::new(&scene, 1, &progress), Err(Error::Cancelled)));
}

#[test]
fn the_flux_balance_adds_up() {
    let scene = crowded();
    let tracer = Tracer::new(&scene, 1, &Progress::new()).unwrap();
    let (photons, report) = tracer.trace(0, 100_000, &Progress::new()).unwrap();
    let l = report.balance;
    let sum: DVec3 =
        l.landed + l.surround + l.escaped + l.blocked + l.absorbed + l.capped + l.ended + l.direct;
    // f32 weights, up to a dozen events each.
    assert!((sum / l.emitted - 1.0).abs().max_element() < 1e-5, "{l:?}");
    assert!((photons.total_flux() / l.landed - 1.0).abs().max_element() < 0.01, "{l:?}");
    assert!(l.absorbed.z > l.absorbed.x, "amber takes blue");
}
