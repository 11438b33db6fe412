//! Lights and meshes that are switched off: as if they were not there. And where the light of one lamp goes.

use crate::scenes::{Stage, glass, mirror, point, sphere_obj};
use glam::Vec3;
use lightloom_core::Progress;
use lightloom_core::engine::Engine;
use lightloom_core::photon::{LampLight, Photons, Tracer};
use lightloom_core::project::{AssetFolder, Project};
use lightloom_core::scene::light::{RectangleLight, SpotLight};
use lightloom_core::scene::{LightDesc, Ray, Scene};
use serde_json::json;

/// Two balls of glass, a lamp over each, the second one an area light.
fn stage() -> Stage {
    let mut stage = Stage::new();
    stage.mesh("left", sphere_obj(3, Vec3::new(-0.25, 0.12, 0.0), 0.08), glass(1.5));
    stage.mesh("right", sphere_obj(3, Vec3::new(0.25, 0.12, 0.0), 0.08), glass(1.5));
    stage.desc.lights.push(point(4.0, [-0.25, 1.0, 0.0]));
    stage.desc.lights.push(panel(true));
    stage
}

fn panel(enabled: bool) -> LightDesc {
    let panel = RectangleLight { position: [0.3, 1.0, 0.1], size: [0.1, 0.1], enabled, ..Default::default() };
    LightDesc::Rectangle(panel)
}

fn photons(scene: &Scene) -> Photons {
    let tracer = Tracer::new(scene, 3, &Progress::new()).unwrap();
    tracer.trace(0, 3000, &Progress::new()).unwrap().0
}

#[test]
fn what_is_off_is_not_there() {
    let mut without = stage();
    without.desc.lights.pop();
    without.desc.meshes.pop();
    let mut off = stage();
    off.desc.lights[1] = panel(false);
    off.desc.meshes[1].enabled = false;
    // Its file is not read.
    off.desc.meshes[1].file = "nowhere.obj".into();
    let scene = off.load();
    assert_eq!(photons(&scene), photons(&without.load()));
    assert_eq!(scene.meshes().len(), 1);
    // A ray from below meets the panel that is on, and no other; it lights nothing.
    let up = Ray::new(Vec3::new(0.3, 0.5, 0.1), Vec3::Y);
    let towards = RectangleLight { target: [0.3, 0.0, 0.1], ..RectangleLight::default() };
    let on = LightDesc::Rectangle(RectangleLight { position: [0.3, 1.0, 0.1], ..towards.clone() });
    let dark = LightDesc::Rectangle(RectangleLight { position: [0.3, 1.0, 0.1], enabled: false, ..towards });
    assert!(on.intersect(&up).is_some() && dark.intersect(&up).is_none());
    assert!(on.illuminate(Vec3::ZERO, [0.5; 2]).is_some() && dark.illuminate(Vec3::ZERO, [0.5; 2]).is_none());
}

#[test]
fn a_narrow_lamp_among_several_balls_gives_its_light_once() {
    let mut stage = Stage::new();
    for x in [-0.4, 0.0, 0.4] {
        let name = format!("ball {x}");
        stage.mesh(&name, sphere_obj(3, Vec3::new(x, 0.12, 0.0), 0.08), glass(1.5));
    }
    let spot = SpotLight { watts: 2.0, position: [0.0, 1.0, 0.0], angle_deg: 3.0, ..Default::default() };
    stage.desc.lights.push(LightDesc::Spot(spot));
    let scene = stage.load();
    let landed = photons(&scene).total_flux().element_sum() / 3.0;
    // Nearly all of it goes through the ball in the middle; a few per cent are reflected.
    assert!(landed < 2.0 && landed > 1.6, "{landed} W of 2 W");
    let told = LampLight::trace(&scene, 0, 5, &Progress::new()).unwrap().unwrap();
    // Three standard deviations of the rejection at the soft edge are one per cent.
    assert!((told.met / 2.0 - 1.0).abs() < 0.03, "{told:?}");
}

#[test]
fn all_lights_off_are_named_as_the_reason() {
    let mut stage = stage();
    stage.desc.lights = vec![panel(false)];
    let refused = Tracer::new(&stage.load(), 1, &Progress::new()).err().unwrap().to_string();
    assert!(refused.contains("off"), "{refused}");
}

#[test]
fn a_caustic_of_a_mesh_that_is_off_is_no_mistake() {
    let stage = stage();
    let mut value = json!({
        "lightloom": 1, "scene": stage.desc, "caustics": [ { "name": "r", "mesh": "right" } ],
        "keys": [ { "frame": 1, "shows": "physical_caustic" } ],
        "render": { "width": 32, "height": 32, "photons": 3000, "passes": 1 }
    });
    value["scene"]["meshes"][1]["enabled"] = json!(false);
    let file = stage.folder.path().join("project.json");
    let project = Project::parse(value.to_string().as_bytes(), &file).unwrap();
    let check = |project: &Project| Engine::new(AssetFolder::new(&file, false).unwrap()).check(project);
    let report = check(&project).unwrap();
    assert!(report.caustics.iter().all(|caustic| caustic.mesh == "left"));
    let mut unknown = project;
    unknown.caustics[0].mesh = Some("rigth".into());
    assert!(check(&unknown).is_err());
}

#[test]
fn the_light_of_a_lamp_is_what_the_tracer_lands() {
    let mut stage = stage();
    stage.mesh("mirror", sphere_obj(2, Vec3::new(0.0, 0.2, 0.3), 0.05), mirror(0.8));
    let scene = stage.load();
    let progress = Progress::new();
    let tracer = Tracer::new(&scene, 3, &progress).unwrap();
    let (all, _) = tracer.trace(0, 20_000, &progress).unwrap();
    for light in 0..2 {
        let of_light = all.light.iter().zip(&all.flux).filter(|(own, _)| usize::from(**own) == light);
        let landed: f64 = of_light.map(|(_, flux)| f64::from(flux.element_sum()) / 3.0).sum();
        let told = LampLight::trace(&scene, light, 5, &progress).unwrap().unwrap();
        // At least 2000 photons of each lamp, and as many plain paths that land: four standard deviations.
        assert!((told.landed / landed - 1.0).abs() < 0.15, "{light}: {told:?}, {landed}");
        assert!(told.landed <= told.met && told.met < told.power.unwrap());
        assert_eq!(told, LampLight::trace(&scene, light, 5, &progress).unwrap().unwrap());
    }
    // The share of all directions that a ball takes is half of one minus the cosine of its half angle.
    let lamp = Vec3::new(-0.25, 1.0, 0.0);
    let balls = [([-0.25, 0.12, 0.0], 0.08), ([0.25, 0.12, 0.0], 0.08), ([0.0, 0.2, 0.3], 0.05)];
    let ball = |(centre, radius): ([f32; 3], f32)| {
        let sine = radius / lamp.distance(centre.into());
        f64::from((1.0 - (1.0 - sine * sine).sqrt()) / 2.0)
    };
    let wanted: f64 = balls.into_iter().map(ball).sum();
    let told = LampLight::trace(&scene, 0, 5, &progress).unwrap().unwrap();
    let share = told.met / told.power.unwrap();
    // The facets of the balls lie inside of them.
    assert!((share / wanted - 1.0).abs() < 0.03, "{share} met, {wanted} wanted");
    assert!(LampLight::trace(&scene, 2, 5, &progress).unwrap().is_none());
}
