//! Light follows the textbooks.

use std::f64::consts::PI;

use crate::scenes::{Stage, box_obj, glass, obj, point, sphere_obj};
use glam::{Vec3, vec2};
use lightloom_core::Progress;
use lightloom_core::math::rng::{Purpose, Stream};
use lightloom_core::photon::{FluxBalance, Photons, TraceReport, Tracer};
use lightloom_core::scene::light::DirectionalLight;
use lightloom_core::scene::material::fresnel::{fresnel, reflect, refract};
use lightloom_core::scene::material::{Beam, Glass, Material, Mirror, VISIBLE_NM, rgb_of_wavelength};
use lightloom_core::scene::{LightDesc, Media, Ray, Scene, SurfaceId};

fn trace(scene: &Scene, count: usize) -> (Photons, TraceReport) {
    let tracer = Tracer::new(scene, 7, &Progress::new()).unwrap();
    tracer.trace(0, count, &Progress::new()).unwrap()
}

#[test]
fn fresnel_agrees_with_published_values() {
    // Hecht, Optics, 4.6: glass of index 1.5 in air.
    let at = |degrees: f32, eta: f32| fresnel(degrees.to_radians().cos(), eta).0;
    assert!((at(0.0, 1.5) - 0.04).abs() < 1e-6);
    assert!((at(0.0, 1.0 / 1.5) - 0.04).abs() < 1e-6);
    // 45 degrees: 0.0920 perpendicular, 0.0085 parallel.
    assert!((at(45.0, 1.5) - 0.0502).abs() < 1e-4);
    assert!((at(89.99, 1.5) - 1.0).abs() < 2e-3);
    // Brewster's angle: nothing parallel is left, so half of ((1 - n^2) / (1 + n^2))^2.
    let brewster = 1.5_f32.atan().to_degrees();
    assert!((at(brewster, 1.5) - 0.5 * (1.25_f32 / 3.25).powi(2)).abs() < 1e-6);
    // Beyond asin(1 / 1.5) = 41.81 degrees nothing leaves the glass.
    assert!(at(41.7, 1.0 / 1.5) < 1.0);
    assert_eq!(at(41.9, 1.0 / 1.5), 1.0);
}

#[test]
fn fresnel_is_the_same_from_both_sides() {
    for degrees in 0..90 {
        let cos_i = (degrees as f32).to_radians().cos();
        let (there, cos_t) = fresnel(cos_i, 1.7);
        let (back, cos_back) = fresnel(cos_t, 1.0 / 1.7);
        // Cosines near 0 come back with the rounding of 1 - cos^2, 1e-7 / 0.017 at 89 degrees.
        assert!((there - back).abs() < 1e-4, "{degrees}: {there} {back}");
        assert!((cos_back - cos_i).abs() < 1e-4);
    }
}

#[test]
fn refraction_follows_snell_and_reflection_keeps_its_angle() {
    for degrees in 1..89 {
        let (sine, cosine) = (degrees as f32).to_radians().sin_cos();
        let direction = Vec3::new(sine, -cosine, 0.0);
        let (_, cos_t) = fresnel(cosine, 1.33);
        let bent = refract(direction, Vec3::Y, cosine, cos_t, 1.33);
        assert!((bent.x * 1.33 - sine).abs() < 1e-6 && bent.y < 0.0 && bent.z == 0.0);
        assert!(reflect(direction, Vec3::Y).distance(Vec3::new(sine, cosine, 0.0)) < 1e-6);
    }
}

/// A sphere of index 1.5, radius .5, its middle .7 above the plane; a point light of 1 W 3 above the plane.
fn glass_sphere() -> Scene {
    let mut stage = Stage::new();
    // 327 680 triangles: the facets take 5e-5 of the silhouette, a sixth of the noise of ten million photons.
    stage.mesh("sphere", sphere_obj(7, Vec3::new(0.0, 0.7, 0.0), 0.5), glass(1.5));
    stage.desc.lights.push(point(1.0, [0.0, 3.0, 0.0]));
    stage.desc.receiver.size = [8.0, 8.0];
    stage.load()
}

/// Flux [W] of that scene within each radius of the axis by quadrature over the angle of emission, all orders of reflection.
/// Shares no code with the tracer.
fn sphere_by_quadrature(radii: &[f64]) -> Vec<f64> {
    let (light, centre, radius, index) = (glam::dvec2(0.0, 3.0), glam::dvec2(0.0, 0.7), 0.5, 1.5);
    let widest = (radius / (light.y - centre.y)).asin();
    let steps = 400_000_u32;
    let mut flux = vec![0.0; radii.len()];
    let mut land = |point: glam::DVec2, direction: glam::DVec2, weight: f64| {
        if direction.y < 0.0 {
            let x = (point.x - direction.x * point.y / direction.y).abs();
            radii.iter().zip(&mut flux).filter(|(r, _)| x <= **r).for_each(|(_, sum)| *sum += weight);
        }
    };
    for step in 0..steps {
        let theta = widest * (f64::from(step) + 0.5) / f64::from(steps);
        let mut weight = 0.5 * theta.sin() * widest / f64::from(steps);
        let direction = glam::dvec2(theta.sin(), -theta.cos());
        let along = (centre - light).dot(direction);
        let off = (centre - light).perp_dot(direction).abs();
        let mut point = light + direction * (along - (radius * radius - off * off).max(0.0).sqrt());
        // In a sphere a ray meets the wall always at the same two angles.
        let outside = (1.0 - (off / radius).powi(2)).max(0.0).sqrt();
        let inside = (1.0 - (off / radius / index).powi(2)).sqrt();
        let s = (outside - index * inside) / (outside + index * inside);
        let p = (index * outside - inside) / (index * outside + inside);
        let mirrored = 0.5 * (s * s + p * p);
        let normal = (point - centre) / radius;
        land(point, direction + 2.0 * outside * normal, weight * mirrored);
        weight *= 1.0 - mirrored;
        let mut way = (direction + outside * normal) / index - inside * normal;
        for _ in 0..20 {
            point -= way * (2.0 * way.dot(point - centre));
            let normal = (point - centre) / radius;
            land(point, (way - inside * normal) * index + outside * normal, weight * (1.0 - mirrored));
            weight *= mirrored;
            way -= 2.0 * inside * normal;
        }
    }
    flux
}

#[test]
fn a_glass_sphere_focuses_as_calculated() {
    let radii = [4.0, 0.75, 0.01];
    let exact = sphere_by_quadrature(&radii);
    // Published elsewhere for this scene: 0.0106987 W, 0.0100270 W, 1.454 W/m^2.
    assert!((exact[0] - 0.010_698_7).abs() < 1e-7 && (exact[1] - 0.010_027_0).abs() < 1e-7, "{exact:?}");
    assert!((exact[2] / (PI * 1e-4) - 1.454).abs() < 1e-3, "{exact:?}");

    // PHOTONS=10000000 asks for more.
    let count = std::env::var("PHOTONS").map_or(1_000_000, |count| count.parse().unwrap());
    let (photons, report) = trace(&glass_sphere(), count);
    let distance = |p: &glam::Vec2| f64::from(p.distance(vec2(0.5, 0.5))) * 8.0;
    for (radius, exact) in radii.iter().zip(exact) {
        let inside = photons.positions.iter().zip(&photons.flux).filter(|(p, _)| distance(p) <= *radius);
        let flux: Vec<f64> = inside.map(|(_, flux)| f64::from(flux.x)).collect();
        let sum: f64 = flux.iter().sum();
        // Poisson: the variance of a sum of photons is the sum of their squares.
        let error = flux.iter().map(|f| f * f).sum::<f64>().sqrt();
        println!(
            "within {radius} m: {sum:.7} W, exact {exact:.7} W, {:+.2} standard errors",
            (sum - exact) / error
        );
        assert!((sum - exact).abs() < 3.0 * error, "within {radius} m: {sum} against {exact}, error {error}");
    }
    println!("{report:?}");
}

/// The light that was not absorbed, wherever it went.
fn unabsorbed(balance: &FluxBalance) -> glam::DVec3 {
    let FluxBalance { landed, surround, escaped, blocked, capped, ended, direct, .. } = *balance;
    landed + surround + escaped + blocked + capped + ended + direct
}

#[test]
fn lossless_glass_loses_nothing() {
    let (_, report) = trace(&glass_sphere(), 200_000);
    let balance = report.balance;
    let out = unabsorbed(&balance);
    // f32 photons summed in f64.
    assert!((out / balance.emitted - 1.0).abs().max_element() < 1e-6, "{balance:?}");
    assert_eq!(balance.absorbed, glam::DVec3::ZERO);
    // In a true sphere every ray that comes in goes out again; facets catch a few for longer than paths are followed.
    assert!(balance.capped.x < 1e-4 * balance.emitted.x, "{balance:?}");
}

/// A slab of 10 mm over the receiver in parallel light from above, 1 W/m^2, of which `count` photons land.
fn slab(material: Material) -> (Photons, TraceReport) {
    let mut stage = Stage::new();
    stage.mesh("slab", box_obj(Vec3::new(-1.0, 0.1, -1.0), Vec3::new(1.0, 0.11, 1.0)), Some(material));
    stage
        .desc
        .lights
        .push(LightDesc::Directional(DirectionalLight { irradiance: 1.0, ..Default::default() }));
    stage.desc.receiver.border = 0.0;
    trace(&stage.load(), 200_000)
}

#[test]
fn coloured_glass_absorbs_by_distance() {
    let absorption = [0.0, 30.0, 200.0];
    let (photons, report) = slab(Material::Glass(Glass { absorption, ..Glass::default() }));
    let total = photons.total_flux();
    for channel in 0..3 {
        let left = (-f64::from(absorption[channel]) * 0.01).exp();
        // Two faces that reflect 0.04 each, and all orders between them.
        let want = 0.96 * 0.96 * left / (1.0 - (0.04 * left).powi(2));
        // 200 000 photons over 1 m^2, of unequal colour: 3e-3 is three standard errors of the mean.
        assert!((total[channel] / want - 1.0).abs() < 1e-2, "{channel}: {total} against {want}");
    }
    let balance = report.balance;
    let out = unabsorbed(&balance);
    assert!(((out + balance.absorbed) / balance.emitted - 1.0).abs().max_element() < 1e-6, "{balance:?}");
    let mean = |flux: &Vec3| flux.element_sum() / 3.0;
    let first = mean(&photons.flux[0]);
    assert!(photons.flux.iter().filter(|f| (mean(f) / first - 1.0).abs() < 1e-4).count() > 199_000);
}

#[test]
fn a_mirror_images_the_light() {
    // A mirror at x = -1, facing +x, shows the light at (1, 1, 0) behind it at (-3, 1, 0).
    let corners = [[-1.0, 0.0, -2.0], [-1.0, 0.0, 2.0], [-1.0, 2.0, 2.0], [-1.0, 2.0, -2.0]].map(Vec3::from);
    let mut stage = Stage::new();
    let reflectance = [0.9, 0.5, 0.2];
    let silver = Some(Material::Mirror(Mirror { reflectance }));
    stage.mesh("mirror", obj(&corners, None, &[[0, 3, 2], [0, 2, 1]]), silver);
    stage.desc.lights.push(point(4.0 * std::f32::consts::PI, [1.0, 1.0, 0.0]));
    stage.desc.receiver.size = [0.5, 0.25];
    stage.desc.receiver.border = 0.0;
    let (photons, _) = trace(&stage.load(), 200_000);
    // Irradiance of intensity 1 W/sr from (-3, 1, 0) at (x, 0, z): cosine / distance^2, by the midpoint rule.
    let n = 64;
    let at = |k: usize, width: f64| width * ((k as f64 + 0.5) / n as f64 - 0.5);
    let sum: f64 = (0..n * n)
        .map(|k| {
            let square = (at(k % n, 0.5) + 3.0).powi(2) + at(k / n, 0.25).powi(2) + 1.0;
            1.0 / (square * square.sqrt())
        })
        .sum();
    let exact = sum * 0.5 * 0.25 / (n * n) as f64;
    for channel in 0..3 {
        let want = exact * f64::from(reflectance[channel]);
        let got = photons.total_flux()[channel];
        // All photons are equal: 1 / sqrt(200 000) = 2.2e-3.
        assert!((got / want - 1.0).abs() < 7e-3, "{got} against {want}");
    }
}

#[test]
fn blue_bends_more_than_red() {
    let flint = Glass { ior: 1.62, dispersion: Some(36.0), ..Glass::default() };
    assert!((flint.index(Some(587.56)) - 1.62).abs() < 1e-6);
    assert_eq!(flint.index(None), 1.62);
    let spread = flint.index(Some(486.13)) - flint.index(Some(656.27));
    assert!((spread - 0.62 / 36.0).abs() < 1e-5, "Abbe's definition: {spread}");

    // A small prism of 30 degrees, flat side down 1 m above the plane, throws a beam from above aside as a rainbow.
    let width = 0.02_f32;
    let outline = [[0.0, 0.0], [width, 0.0], [width, width * 30.0_f32.to_radians().tan()]];
    let corner = |[x, y]: [f32; 2], z| Vec3::new(x - width / 2.0, y + 1.0, z);
    let vertices: Vec<_> = [0.2, -0.2].iter().flat_map(|z| outline.map(|p| corner(p, *z))).collect();
    let faces = [[0, 1, 2], [3, 5, 4], [0, 4, 1], [0, 3, 4], [1, 5, 2], [1, 4, 5], [2, 3, 0], [2, 5, 3]];
    let mut stage = Stage::new();
    stage.mesh("prism", obj(&vertices, None, &faces), Some(Material::Glass(flint.clone())));
    stage
        .desc
        .lights
        .push(LightDesc::Directional(DirectionalLight { irradiance: 1.0, ..Default::default() }));
    stage.desc.receiver.size = [4.0, 4.0];
    let (photons, _) = trace(&stage.load(), 100_000);
    let total = photons.total_flux();
    // In through the slope, out through the flat side, by Snell twice; then 1 m down.
    let throw = |nm: f32| {
        let n = f64::from(flint.index(Some(nm)));
        (n * (PI / 6.0 - (0.5 / n).asin()).sin()).asin().tan()
    };
    let steps = 3000;
    for channel in 0..3 {
        let moments = photons.positions.iter().zip(&photons.flux).map(|(p, f)| (p.x * 4.0 - 2.0, f[channel]));
        // The direct way only: reflections inside go elsewhere.
        let direct = moments.filter(|(x, _)| (0.3..0.45).contains(x));
        let (sum, weight) =
            direct.fold((0.0, 0.0), |(s, w), (x, f)| (s + f64::from(x * f), w + f64::from(f)));
        let exact = (0..steps)
            .map(|k| VISIBLE_NM[0] + (VISIBLE_NM[1] - VISIBLE_NM[0]) * (k as f32 + 0.5) / steps as f32)
            .map(|nm| f64::from(rgb_of_wavelength(nm)[channel]) * throw(nm))
            .sum::<f64>()
            / f64::from(steps);
        // The beam is 0.02 wide and starts within 0.004 of the axis; bands lie 0.005 and 0.010 apart.
        assert!((sum / weight - exact).abs() < 2e-3, "{channel}: {} against {exact}", sum / weight);
    }
    assert!(throw(450.0) > throw(550.0) + 5e-3 && throw(550.0) > throw(650.0) + 3e-3);
    // White: nothing of the sum is coloured; 1e-2 is three errors of 100 000 photons in three bands.
    assert!((total / total.x - 1.0).abs().max_element() < 2e-2, "{total}");
}

#[test]
fn the_rainbow_sums_to_white() {
    let steps = 3000;
    let width = (VISIBLE_NM[1] - VISIBLE_NM[0]) / steps as f32;
    let sum: Vec3 = (0..steps)
        .map(|k| rgb_of_wavelength(VISIBLE_NM[0] + width * (k as f32 + 0.5)))
        .inspect(|rgb| assert!(rgb.min_element() >= 0.0 && (rgb.element_sum() - 3.0).abs() < 1e-5))
        .sum();
    assert!((sum / steps as f32 - 1.0).abs().max_element() < 1e-4, "{sum}");
}

/// Follows the refracted way of a ray through a scene: the direction in each medium, until it leaves all meshes.
fn refracted_way(scene: &Scene, mut ray: Ray) -> Vec<(Vec3, Media)> {
    let mut beam = Beam::new(Vec3::ONE, scene.media_at(ray.origin));
    let mut rng = Stream::new(3, Purpose::Trace, 0, 0);
    let mut way = vec![(ray.direction, beam.media)];
    while let Some(hit) = scene.intersect(&ray).filter(|hit| matches!(hit.surface, SurfaceId::Mesh(_))) {
        let mut next = beam.clone();
        let material = scene.material(hit.surface);
        let direction = material.scatter(scene.geometry(), &hit, ray.direction, &mut next, &mut rng).unwrap();
        let crossed = direction.dot(hit.geometric_normal) * ray.direction.dot(hit.geometric_normal) > 0.0;
        if crossed {
            ray = Ray::leaving(&hit, direction);
            beam = next;
            way.push((direction, beam.media));
        }
    }
    way
}

#[test]
fn overlapping_solids_refract_once() {
    // Wine (1.33) overlaps its glass (1.5) from y = 1.0 to 1.1; the glass has priority.
    let mut stage = Stage::new();
    stage.mesh("glass", box_obj(Vec3::new(-5.0, 1.0, -5.0), Vec3::new(5.0, 1.2, 5.0)), glass(1.5)).priority =
        1;
    stage.mesh("wine", box_obj(Vec3::new(-4.0, 0.5, -4.0), Vec3::new(4.0, 1.1, 4.0)), glass(1.33));
    let scene = stage.load();
    let sine = 0.6_f32;
    let way = refracted_way(&scene, Ray::new(Vec3::new(0.0, 2.0, 0.0), Vec3::new(sine, -0.8, 0.0)));
    let index = |media: &Media| media.glass(scene.meshes()).map_or(1.0, |glass| glass.ior);
    let indices: Vec<f32> = way.iter().map(|(_, media)| index(media)).collect();
    assert_eq!(indices, [1.0, 1.5, 1.5, 1.33, 1.0]);
    for (direction, media) in &way {
        assert!((direction.x * index(media) - sine).abs() < 1e-5, "{direction}");
    }
    assert!(way.last().unwrap().1.is_empty());
}

#[test]
fn a_light_inside_glass_shines_out() {
    let mut stage = Stage::new();
    stage.mesh("bulb", sphere_obj(5, Vec3::new(0.0, 1.0, 0.0), 0.2), glass(1.5));
    stage.desc.lights.push(point(4.0 * std::f32::consts::PI, [0.0, 1.0, 0.0]));
    stage.desc.receiver.size = [0.2, 0.2];
    stage.desc.receiver.border = 0.0;
    let scene = stage.load();
    assert!(scene.media_at(Vec3::Y).glass(scene.meshes()).is_some());
    assert!(scene.media_at(Vec3::Y * 1.3).is_empty());
    let (photons, _) = trace(&scene, 100_000);
    // From the middle all rays meet the sphere head on: straight out, whatever the number of reflections in between. 1 W/sr
    // on 0.04 m^2 at 1 m, with cosine / distance^2 falling by 0.7 % on average.
    let total = photons.total_flux().x;
    assert!((total / 0.04 - 0.9933).abs() < 0.01, "{total}");
}

#[test]
fn oblique_silhouettes_of_coarse_glass_keep_all_energy() {
    // 80 triangles with the normals of a sphere: smooth and true normals differ by 20 degrees.
    let mut stage = Stage::new();
    stage.mesh("coarse", sphere_obj(1, Vec3::new(0.0, 0.7, 0.0), 0.5), glass(1.5));
    stage.desc.lights.push(point(1.0, [1.0, 2.0, 0.5]));
    stage.desc.receiver.size = [20.0, 20.0];
    let (_, report) = trace(&stage.load(), 100_000);
    let balance = report.balance;
    let out = unabsorbed(&balance) - balance.blocked;
    assert!((out.x / balance.emitted.x - 1.0).abs() < 1e-6, "{balance:?}");
    assert!(balance.blocked.x < 1e-5 * balance.emitted.x, "nothing comes from below the floor: {balance:?}");
    assert!(balance.capped.x < 1e-4 * balance.emitted.x, "{balance:?}");
}
