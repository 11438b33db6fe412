//! The background and the camera's view of the receiver, against what can be calculated.

use std::f32::consts::PI;
use std::fmt::Write;
use std::time::Duration;

use glam::{Vec3, vec2};
use lightloom_core::render::{
    BackgroundSamples, GatherMatrix, Image, ReceiverTexture, RenderSettings, TextureLayout, background,
    background_from, layout_for,
};
use lightloom_core::scene::light::{LightDesc, LightRole, PointLight, RectangleLight};
use lightloom_core::scene::material::{Diffuse, Glass, Material, Mirror};
use lightloom_core::scene::mesh::Transform;
use lightloom_core::scene::{EnvironmentDesc, MeshDesc, Scene, SceneDesc};
use lightloom_core::{Error, Progress};

/// A ball of 64 by 32 faces around the origin, radius 1.
fn ball() -> String {
    let (around, along) = (64, 32);
    let mut obj = String::from("v 0 1 0\nv 0 -1 0\n");
    for i in 1..along {
        for j in 0..around {
            let (a, b) = (PI * i as f32 / along as f32, 2.0 * PI * j as f32 / around as f32);
            writeln!(obj, "v {} {} {}", a.sin() * b.sin(), a.cos(), a.sin() * b.cos()).unwrap();
        }
    }
    let at = |i: usize, j: usize| 3 + (i - 1) * around + j % around;
    for j in 0..around {
        writeln!(obj, "f 1 {} {}", at(1, j), at(1, j + 1)).unwrap();
        writeln!(obj, "f 2 {} {}", at(along - 1, j + 1), at(along - 1, j)).unwrap();
        for i in 1..along - 1 {
            writeln!(obj, "f {} {} {} {}", at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)).unwrap();
        }
    }
    obj
}

/// A box from (-1, 0, -1) to (1, 0.1, 1).
fn slab() -> String {
    let mut obj = String::new();
    for i in 0..8 {
        let (x, y, z) = (2 * (i & 1) - 1, (i >> 1 & 1) as f32 * 0.1, 2 * (i >> 2) - 1);
        writeln!(obj, "v {x} {y} {z}").unwrap();
    }
    for face in ["1 3 4 2", "5 6 8 7", "1 2 6 5", "3 7 8 4", "1 5 7 3", "2 4 8 6"] {
        writeln!(obj, "f {face}").unwrap();
    }
    obj
}

/// A receiver of 4 m, seen from straight above, with at most one object over it.
fn scene(object: Option<(String, Material, Transform)>, lights: Vec<LightDesc>, sky: f32) -> Scene {
    let folder = tempfile::tempdir().unwrap();
    let mut desc = SceneDesc { lights, ..SceneDesc::default() };
    desc.camera.position = [0.0, 5.0, 0.0];
    desc.camera.up = [0.0, 0.0, -1.0];
    desc.receiver.size = [4.0, 4.0];
    desc.receiver.albedo = [0.5, 0.4, 0.3];
    desc.environment = EnvironmentDesc { zenith: [sky; 3], horizon: [sky; 3], ground: [sky; 3] };
    if let Some((obj, material, transform)) = object {
        std::fs::write(folder.path().join("object.obj"), obj).unwrap();
        let file = "object.obj".to_owned();
        let material = Some(material);
        desc.meshes.push(MeshDesc { material, transform, ..MeshDesc::new("object", file) });
    }
    let assets = |name: &str, _: &str| Ok::<_, Error>(folder.path().join(name));
    Scene::load(&desc, &assets).unwrap().0
}

fn at(height: f32, scale: f32) -> Transform {
    Transform { translate: [0.0, height.into(), 0.0], scale, ..Transform::default() }
}

fn settings(samples: u32) -> RenderSettings {
    let (width, height) = (65, 65);
    RenderSettings {
        width,
        height,
        background_samples: samples,
        camera_samples: 16,
        ..RenderSettings::default()
    }
}

fn render(scene: &Scene, samples: u32) -> Image {
    background(scene, &settings(samples), 11, &Progress::new()).unwrap().image
}

/// The place of the receiver that a pixel of [`settings`] sees, in metres from its centre.
fn seen_at(x: usize, y: usize) -> glam::Vec2 {
    let half = 5.0 * 20.0_f32.to_radians().tan();
    (vec2(x as f32 + 0.5, y as f32 + 0.5) / 65.0 * 2.0 - 1.0) * half
}

#[test]
fn in_an_even_sky_a_matt_ball_shows_its_albedo_and_clear_glass_vanishes() {
    // Far above the receiver, which fills no more than a speck of the ball's surroundings.
    let looks = |material| {
        let mut transform = at(0.0, 0.5);
        transform.translate = [0.0, 3.0, 0.0];
        let mut image = render(&scene_in_the_open(material, transform), 16);
        image.pixels = vec![image.at(32, 32), image.at(30, 36), image.at(35, 29)];
        image.pixels
    };
    for value in looks(Material::Diffuse(Diffuse { albedo: [0.6, 0.3, 0.1] })) {
        assert!(value.distance(Vec3::new(0.6, 0.3, 0.1)) < 1e-3, "{value}");
    }
    for value in looks(Material::Mirror(Mirror { reflectance: [0.9, 0.8, 0.7] })) {
        assert!(value.distance(Vec3::new(0.9, 0.8, 0.7)) < 1e-3, "{value}");
    }
    for value in looks(Material::Glass(Glass::default())) {
        assert!(value.distance(Vec3::ONE) < 1e-3, "{value}");
    }
}

/// The object alone in an even sky of radiance 1: the receiver is 0.1 mm wide and stands behind the camera.
fn scene_in_the_open(material: Material, transform: Transform) -> Scene {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("object.obj"), ball()).unwrap();
    let mut desc = SceneDesc::default();
    desc.camera.position = [0.0, 5.0, 0.0];
    desc.camera.up = [0.0, 0.0, -1.0];
    desc.receiver.size = [1e-4; 2];
    desc.receiver.centre = [0.0, 100.0, 0.0];
    desc.environment = EnvironmentDesc { zenith: [1.0; 3], horizon: [1.0; 3], ground: [1.0; 3] };
    desc.meshes.push(MeshDesc {
        material: Some(material),
        transform,
        ..MeshDesc::new("object", "object.obj")
    });
    Scene::load(&desc, &|name: &str, _: &str| Ok(folder.path().join(name))).unwrap().0
}

#[test]
fn a_point_light_lights_the_receiver_by_the_inverse_square() {
    let light = PointLight { watts: 20.0, position: [0.3, 1.5, 0.0], ..PointLight::default() };
    let image = render(&scene(None, vec![LightDesc::Point(light)], 0.0), 64);
    for (x, y) in [(32, 32), (10, 50), (40, 20)] {
        let offset = seen_at(x, y) - vec2(0.3, 0.0);
        let d2 = offset.length_squared() + 1.5 * 1.5;
        let expected = 20.0 / (4.0 * PI) * 1.5 / d2.powf(1.5) * 0.5 / PI;
        // The pixel averages a spot 11 cm wide over a curved falloff.
        assert!((image.at(x, y).x / expected - 1.0).abs() < 0.01, "{} for {expected}", image.at(x, y).x);
    }
}

#[test]
fn a_panel_lights_the_spot_below_it_as_its_form_factor_says() {
    let (size, height, watts) = (1.0_f32, 1.2, 10.0);
    let position = [0.0, height, 0.0];
    let light = RectangleLight { watts, position, size: [size; 2], ..RectangleLight::default() };
    // The camera looks through the panel's back, which is dark and stands in nobody's way.
    let image = render(&scene(None, vec![LightDesc::Rectangle(light)], 0.0), 256);
    // Four times the form factor of a quarter panel seen from below its corner (Howell, catalogue, B-3).
    let (a, b) = (0.5 * size / height, 0.5 * size / height);
    let leg = |a: f32, b: f32| a / (1.0 + a * a).sqrt() * (b / (1.0 + a * a).sqrt()).atan();
    let form_factor = 4.0 * (leg(a, b) + leg(b, a)) / (2.0 * PI);
    let radiosity = watts / (size * size);
    let expected = radiosity * form_factor * 0.5 / PI;
    let seen = image.at(32, 32).x;
    assert!((seen / expected - 1.0).abs() < 0.01, "{seen} for {expected}");
}

#[test]
fn the_shadow_of_glass_is_dark_and_the_sky_shines_through() {
    let light = LightDesc::Point(PointLight { position: [0.0, 2.0, 0.0], ..PointLight::default() });
    let object = || Some((ball(), Material::Glass(Glass::default()), at(1.0, 0.5)));
    // What lies in the middle under the ball is seen through it; a ring of shadow is seen beside it.
    let lit = render(&scene(None, vec![light.clone()], 0.0), 16);
    let dark = render(&scene(object(), vec![light], 0.0), 16);
    let ring = (0..65).filter(|&x| (0.75..1.0).contains(&seen_at(x, 32).x.abs()));
    for x in ring {
        assert!(lit.at(x, 32).x > 0.0);
        // The ball reflects a few percent of the lit floor into its own shadow.
        assert!(dark.at(x, 32).x < 0.03 * lit.at(x, 32).x, "column {x}");
    }
    let sky = render(&scene(object(), Vec::new(), 1.0), 64);
    // A clear ball takes nothing from an even sky, so the receiver beside it still shows its albedo.
    let seen = sky.at(19, 32);
    assert!((seen.x / 0.5 - 1.0).abs() < 0.05, "{seen}");
}

/// A texture of even irradiance 1, in watts per texel.
fn even(layout: &TextureLayout, metres: f32) -> ReceiverTexture {
    let mut texture = ReceiverTexture::new(*layout);
    texture.texels_mut().fill(Vec3::ONE.extend(0.0) * (layout.texel * metres).powi(2));
    texture
}

#[test]
fn the_camera_sees_the_texture_directly_through_a_pane_and_in_a_mirror() {
    let look = |scene: &Scene| {
        let layout = layout_for(Some(scene), scene.receiver().extent(), &settings(1), (0.02, 0.01));
        let visible =
            GatherMatrix::through_camera(scene, &layout, &settings(1), 5, &Progress::new()).unwrap();
        visible.gather(&even(&layout, 4.0))
    };
    let albedo = Vec3::new(0.5, 0.4, 0.3);
    let direct = look(&scene(None, Vec::new(), 0.0)).at(30, 34) * PI;
    assert!(direct.distance(albedo) < 1e-4, "{direct}");
    // Both faces of a pane, all reflections between them: (1 - R) / (1 + R).
    let pane = look(&scene(Some((slab(), Material::Glass(Glass::default()), at(1.0, 1.0))), Vec::new(), 0.0));
    let middle: Vec3 = (28..37).flat_map(|y| (28..37).map(move |x| (x, y))).map(|(x, y)| pane.at(x, y)).sum();
    let reflectance = (0.5_f32 / 2.5).powi(2);
    let expected = albedo * ((1.0 - reflectance) / (1.0 + reflectance));
    // 81 pixels of 128 paths, 8 % of which are reflected: a standard error of 0.003.
    assert!((middle / 81.0 * PI - expected).abs().max_element() < 0.01, "{} {expected}", middle / 81.0 * PI);
    // A mirror that shows the receiver its own back side shows no light.
    let mirror = scene(Some((slab(), Material::Mirror(Mirror::default()), at(-1.0, 1.0))), Vec::new(), 0.0);
    assert!(look(&mirror).at(32, 32).distance(albedo / PI) < 1e-4);
}

#[test]
fn a_lamp_of_caustics_alone_leaves_the_background_dark() {
    let lamp = |role| {
        let point = PointLight { role, position: [0.0, 2.0, 0.5], ..PointLight::default() };
        let panel = RectangleLight { role, position: [0.5, 2.0, 0.0], ..RectangleLight::default() };
        let ball = (ball(), Material::Glass(Glass::default()), at(1.0, 0.5));
        render(&scene(Some(ball), vec![LightDesc::Point(point), LightDesc::Rectangle(panel)], 0.0), 4)
    };
    assert!(lamp(LightRole::Caustics).pixels.iter().all(|pixel| *pixel == Vec3::ZERO));
    let lit = lamp(LightRole::All);
    assert!(lit.at(5, 5).x > 0.0 && lit.pixels == lamp(LightRole::Background).pixels);
}

#[test]
fn background_and_view_are_the_same_bytes_for_one_and_two_threads() {
    let glass = Glass { dispersion: Some(30.0), ..Glass::default() };
    let light = LightDesc::Rectangle(RectangleLight::default());
    let scene = scene(Some((ball(), Material::Glass(glass), at(1.0, 0.5))), vec![light], 0.2);
    let layout = layout_for(Some(&scene), scene.receiver().extent(), &settings(4), (0.02, 0.01));
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let seen =
                GatherMatrix::through_camera(&scene, &layout, &settings(4), 5, &Progress::new()).unwrap();
            (render(&scene, 4), seen)
        })
    };
    assert!(run(1) == run(2));
}

#[test]
fn a_cancelled_render_stops() {
    let progress = Progress::new();
    progress.cancel();
    let scene = scene(None, Vec::new(), 1.0);
    assert!(matches!(background(&scene, &settings(4), 1, &progress), Err(Error::Cancelled)));
}

#[test]
fn samples_that_were_kept_are_taken_up_with_the_same_picture() {
    let lamp = LightDesc::Rectangle(RectangleLight {
        position: [0.0, 3.0, 0.0],
        target: [0.0; 3],
        ..RectangleLight::default()
    });
    let scene = scene(Some((ball(), Material::Glass(Glass::default()), at(1.0, 0.5))), vec![lamp], 0.1);
    // More rows than are traced at once.
    let settings = RenderSettings { width: 12, height: 150, background_samples: 4, ..settings(4) };
    let kept = std::sync::Mutex::new(Vec::new());
    let keep = |samples: &BackgroundSamples| {
        kept.lock().unwrap().push(serde_json::to_string(samples).unwrap());
        Ok(())
    };
    let render = |from| {
        let keeps = (&keep as &dyn Fn(&BackgroundSamples) -> Result<(), Error>, Duration::ZERO);
        background_from(from, &scene, &settings, 3, keeps, &Progress::new()).unwrap().image
    };
    let whole = background(&scene, &settings, 3, &Progress::new()).unwrap().image;
    assert!(render(None) == whole);
    let kept = std::mem::take(&mut *kept.lock().unwrap());
    assert!(kept.len() > 2 && kept.iter().any(|samples| !samples.contains("\"rows\":0")));
    for samples in [&kept[0], &kept[kept.len() / 2], &kept[kept.len() - 1]] {
        assert!(render(Some(serde_json::from_str(samples).unwrap())) == whole);
    }
}
