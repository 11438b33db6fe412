//! Several caustics in one project: each goes to its own target with its own light, and is left alone where it shall be.

use std::fs;
use std::ops::Range;
use std::path::Path;

use crate::scenes::{Stage, box_obj, glass, sphere_obj};
use crate::tracks;
use glam::{DVec3, Vec2, Vec3};
use lightloom_core::engine::{CheckReport, Engine, Summary};
use lightloom_core::project::{AssetFolder, Project};
use lightloom_core::scene::LightDesc;
use lightloom_core::scene::light::PointLight;
use lightloom_core::scene::material::{Diffuse, Material};
use lightloom_core::{Progress, Result};
use serde_json::{Value, json};

const PHOTONS: usize = 3000;
const STEPS: usize = 6;

/// Two balls of glass side by side, a lamp over each, and a board that casts no caustic.
fn stage() -> Stage {
    let mut stage = Stage::new();
    for (name, x) in [("left", -0.25), ("right", 0.25)] {
        stage.mesh(&format!("{name} ball"), sphere_obj(3, Vec3::new(x, 0.12, 0.0), 0.08), glass(1.5));
        let lamp = PointLight { name: format!("{name} lamp"), position: [x, 1.0, 0.0], ..Default::default() };
        stage.desc.lights.push(LightDesc::Point(lamp));
    }
    let board = box_obj(Vec3::new(-0.4, 0.0, -0.4), Vec3::new(-0.35, 0.05, -0.3));
    stage.mesh("board", board, Some(Material::Diffuse(Diffuse::default())));
    let white = image::GrayImage::from_pixel(8, 8, image::Luma([255]));
    white.save(stage.folder.path().join("square.png")).unwrap();
    stage
}

/// A white square of width 0.2.
fn square(centre: [f32; 2]) -> Value {
    json!({ "image": { "file": "square.png", "placement": { "centre": centre, "width": 0.2 } } })
}

fn in_square(centre: [f32; 2], p: Vec2) -> bool {
    // Rounding of the placement.
    (p - Vec2::from(centre)).abs().max_element() <= 0.1 + 1e-6
}

const UPPER: [f32; 2] = [0.2, 0.8];
const LOWER: [f32; 2] = [0.8, 0.2];

/// From the physical caustic to `keys[1]`, the left and the right ball told apart.
fn project(stage: &Stage, last: Value) -> Value {
    json!({
        "lightloom": 1,
        "scene": stage.desc,
        "caustics": [ { "name": "left", "mesh": "left ball" }, { "name": "right", "mesh": "right ball" } ],
        "keys": [ { "frame": 1, "shows": "physical_caustic" }, last ],
        "flow": { "grid": 16, "steps": STEPS },
        "render": { "width": 32, "height": 32, "photons": PHOTONS, "passes": 4, "background_samples": 1 }
    })
}

/// The left caustic to the upper square, the right one to the lower.
fn parted() -> Value {
    json!({ "frame": 9, "shows": "physical_caustic", "caustics": {
        "left": { "shows": square(UPPER) }, "right": { "shows": square(LOWER) } } })
}

fn engine(stage: &Stage) -> Engine {
    Engine::new(AssetFolder::new(&stage.folder.path().join("project.json"), false).unwrap())
}

fn parse(project: &Value) -> Result<Project> {
    Project::parse(project.to_string().as_bytes(), Path::new("project.json"))
}

fn check(stage: &Stage, project: &Value) -> Result<CheckReport> {
    engine(stage).check(&parse(project)?)
}

/// What `fit` wrote.
struct Fit {
    summary: Summary,
    /// Step by step, then row by row.
    tracks: Vec<Vec<Vec2>>,
    flux: Vec<Vec<Vec3>>,
}

impl Fit {
    fn new(stage: &Stage, project: &Value) -> Self {
        let out = stage.folder.path().join("out");
        fs::create_dir_all(&out).unwrap();
        let summary =
            engine(stage).fit(&parse(project).unwrap(), &out, &Progress::new(), &|_: &Path| {}).unwrap();
        Self {
            summary,
            tracks: tracks::read(&out.join("tracks.npy")),
            flux: tracks::read(&out.join("flux.npy")),
        }
    }

    /// The rows of a caustic.
    fn rows(&self, name: &str) -> Range<usize> {
        let caustics = &self.summary.caustics;
        let at = caustics.iter().position(|c| c.name.as_deref() == Some(name)).unwrap();
        let start = caustics[..at].iter().map(|c| c.photons).sum();
        start..start + caustics[at].photons
    }

    /// The way of a caustic's photons, step by step.
    fn way(&self, name: &str) -> Vec<&[Vec2]> {
        self.tracks.iter().map(|step| &step[self.rows(name)]).collect()
    }

    /// The flux of a caustic at a step.
    fn light(&self, name: &str, step: usize) -> DVec3 {
        self.flux[step][self.rows(name)].iter().map(|f| f.as_dvec3()).sum()
    }
}

#[test]
fn every_photon_of_a_caustic_ends_in_its_own_picture() {
    let stage = stage();
    let fit = Fit::new(&stage, &project(&stage, parted()));
    for (name, centre) in [("left", UPPER), ("right", LOWER)] {
        assert!(fit.rows(name).len() > PHOTONS / 4, "{:?}", fit.summary.caustics);
        assert!(fit.way(name)[STEPS].iter().all(|p| in_square(centre, *p)), "{name}");
    }
}

#[test]
fn the_light_of_each_caustic_is_kept_over_time() {
    let stage = stage();
    let fit = Fit::new(&stage, &project(&stage, parted()));
    for name in ["left", "right"] {
        let start = fit.light(name, 0);
        for step in 1..=STEPS {
            // Some thousand f32 values that are rounded once each.
            assert!((fit.light(name, step) / start - 1.0).abs().max_element() < 1e-6, "{name}, step {step}");
        }
    }
    let watts: f64 = fit.summary.caustics.iter().map(|c| c.watts).sum();
    let all: f64 = fit.flux[0].iter().map(|f| f.as_dvec3().element_sum() / 3.0).sum();
    assert!((watts / all - 1.0).abs() < 1e-6);
}

#[test]
fn a_caustic_that_is_physical_at_both_keys_does_not_move_and_takes_no_part_in_the_fit() {
    let stage = stage();
    let last = json!({ "frame": 9, "shows": "physical_caustic", "caustics": { "left": { "shows": square(UPPER) } } });
    let fit = Fit::new(&stage, &project(&stage, last));
    let still = fit.way("right");
    assert!(still.iter().all(|step| *step == still[0]));
    assert!(fit.way("left")[STEPS].iter().all(|p| in_square(UPPER, *p)));
    assert_eq!(fit.summary.flow.as_ref().unwrap().flow.guides, fit.rows("left").len());
}

#[test]
fn where_nothing_moves_nothing_is_fitted() {
    let stage = stage();
    let fit = Fit::new(&stage, &project(&stage, json!({ "frame": 9, "shows": "physical_caustic" })));
    assert!(fit.summary.flow.is_none());
    assert!(fit.tracks.iter().all(|step| *step == fit.tracks[0]));
}

#[test]
fn a_caustic_that_came_back_stays_where_it_is() {
    let stage = stage();
    let mut project = project(&stage, json!({ "frame": 9, "shows": "physical_caustic" }));
    project["keys"][0]["shows"] = square(UPPER);
    let rest = json!({ "frame": 12, "shows": "physical_caustic" });
    project["keys"].as_array_mut().unwrap().push(rest);
    let fit = Fit::new(&stage, &project);
    assert!(fit.tracks[0].iter().all(|p| in_square(UPPER, *p)));
    assert_ne!(fit.tracks[0], fit.tracks[STEPS]);
    assert!(fit.tracks[STEPS..].iter().all(|step| *step == fit.tracks[STEPS]));
    // a (1 - t) + a t is a but for two roundings.
    let same = |(a, b): (&Vec3, &Vec3)| (*a - *b).length() <= 1e-6 * b.length();
    assert!(fit.flux[STEPS..].iter().all(|step| step.iter().zip(&fit.flux[STEPS]).all(same)));
}

#[test]
fn a_caustic_of_its_own_flow_is_not_moved_by_another() {
    let stage = stage();
    let fit = |own: bool, right: [f32; 2]| {
        let mut last = parted();
        last["caustics"]["right"]["shows"] = square(right);
        let mut project = project(&stage, last);
        for caustic in project["caustics"].as_array_mut().unwrap() {
            caustic["own_flow"] = json!(own);
        }
        Fit::new(&stage, &project)
    };
    let [near, far] = [[0.6, 0.4], LOWER].map(|right| fit(true, right));
    assert_eq!(near.way("left"), far.way("left"));
    assert_ne!(near.way("right"), far.way("right"));
    let [near, far] = [[0.6, 0.4], LOWER].map(|right| fit(false, right));
    assert_ne!(near.way("left"), far.way("left"), "a shared field is shared");
}

#[test]
fn colour_and_brightness_act_on_one_caustic_and_are_accounted_for() {
    let stage = stage();
    let plain = Fit::new(&stage, &project(&stage, parted()));
    let mut last = parted();
    last["caustics"]["right"]["colour"] = json!([1.0, 0.5, 0.0]);
    let mut project = project(&stage, last);
    project["keys"][0]["caustics"] = json!({ "right": { "brightness": 3.0 } });
    let fit = Fit::new(&stage, &project);
    let near = |a: DVec3, b: DVec3| (a - b).length() < 1e-5 * b.length();
    assert!(near(fit.light("right", 0), 3.0 * plain.light("right", 0)));
    let middle = DVec3::new(2.0, 1.75, 1.5) * plain.light("right", 0);
    assert!(near(fit.light("right", STEPS / 2), middle), "blended like the flux");
    assert!(near(fit.light("right", STEPS), DVec3::new(1.0, 0.5, 0.0) * plain.light("right", 0)));
    assert_eq!(fit.light("left", STEPS), plain.light("left", STEPS));
    assert_eq!(fit.tracks, plain.tracks);
    assert!((fit.summary.flow.unwrap().flux_ratio - 1.0).abs() < 1e-5);
}

#[test]
fn photons_keep_their_colours_where_a_key_gives_none() {
    let mut stage = stage();
    for (light, colour) in stage.desc.lights.iter_mut().zip([[1.0, 0.2, 0.0], [0.0, 0.1, 1.0]]) {
        let LightDesc::Point(lamp) = light else { panic!() };
        lamp.colour = colour;
    }
    let white = image::RgbImage::from_pixel(8, 8, image::Rgb([0, 255, 0]));
    white.save(stage.folder.path().join("green.png")).unwrap();
    // All light is one caustic: red and blue mix in the square, and stay what they are, also in a second one. Behind a
    // picture that gives a colour they keep that.
    let mut project = project(&stage, json!({ "frame": 9, "shows": square(UPPER) }));
    project["caustics"] = json!([]);
    let green = json!({ "image": { "file": "green.png", "colour": true, "placement": { "width": 0.3 } } });
    for (frame, shows) in [(12, square(LOWER)), (15, green), (18, square(UPPER))] {
        project["keys"].as_array_mut().unwrap().push(json!({ "frame": frame, "shows": shows }));
    }
    let fit = Fit::new(&stage, &project);
    let colour = |flux: &Vec3| *flux / flux.element_sum();
    let watts = |step: usize| fit.flux[step].iter().map(|f| f.as_dvec3().element_sum()).sum::<f64>();
    let even = watts(0) / fit.flux[0].len() as f64;
    assert!(fit.flux[0].iter().any(|f| colour(f).x > 0.8) && fit.flux[0].iter().any(|f| colour(f).z > 0.8));
    for step in [STEPS, 2 * STEPS] {
        for (now, first) in fit.flux[step].iter().zip(&fit.flux[0]) {
            // Rounding of a ratio of f32.
            assert!((colour(now) - colour(first)).abs().max_element() < 1e-5);
            assert!((f64::from(now.element_sum()) / even - 1.0).abs() < 1e-5, "the picture's light is even");
        }
    }
    for step in [3 * STEPS, 4 * STEPS] {
        assert!(fit.flux[step].iter().all(|f| f.x == 0.0 && f.y > 0.0 && f.z == 0.0), "{step}");
    }
    for step in 0..=4 * STEPS {
        assert!((watts(step) / watts(0) - 1.0).abs() < 1e-5, "{step}");
    }
}

#[test]
fn threads_change_nothing() {
    let stage = stage();
    let fit = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| Fit::new(&stage, &project(&stage, parted())))
    };
    let (one, two) = (fit(1), fit(2));
    assert_eq!(one.tracks, two.tracks);
    assert_eq!(one.flux, two.flux);
}

#[test]
fn naming_a_caustic_without_light_changes_nothing_and_is_noted() {
    let stage = stage();
    let mut project = project(&stage, json!({ "frame": 9, "shows": square(UPPER) }));
    project["caustics"] = json!([]);
    let plain = Fit::new(&stage, &project);
    project["caustics"] = json!([{ "name": "none", "mesh": "board" }]);
    project["keys"][1]["caustics"] = json!({ "none": { "shows": square(LOWER) } });
    let named = Fit::new(&stage, &project);
    assert_eq!(named.tracks, plain.tracks);
    assert_eq!(named.flux, plain.flux);
    for notes in [&named.summary.notes, &check(&stage, &project).unwrap().notes] {
        assert!(notes.iter().any(|note| note.text.contains("'none' has no photons")), "{notes:?}");
    }
}

#[test]
fn a_sequence_that_returns_to_the_physical_caustic_ends_as_it_began() {
    let stage = stage();
    let mut project = project(&stage, parted());
    let back = json!({ "frame": 20, "shows": "physical_caustic" });
    project["keys"].as_array_mut().unwrap().push(back);
    let fit = Fit::new(&stage, &project);
    for name in ["left", "right"] {
        // Each photon has become another one of the same, so the picture is the same; at the start, b - (b - a) is a but for
        // rounding.
        let at = |step: usize| fit.way(name)[step];
        let covers = |all: &[Vec2], p: &Vec2| all.iter().any(|q| p.distance(*q) < 1e-6);
        assert!(at(2 * STEPS).iter().all(|p| covers(at(0), p)), "{name}");
        assert!(at(0).iter().all(|p| covers(at(2 * STEPS), p)), "{name}");
    }
}

#[test]
fn a_caustic_of_which_a_pass_has_no_photon_is_rendered() {
    let mut stage = stage();
    let LightDesc::Point(lamp) = &mut stage.desc.lights[1] else { panic!("a point light") };
    // One photon in every second pass, on average.
    lamp.watts *= 1.0 / PHOTONS as f32;
    let mut project = project(&stage, parted());
    project["caustics"][1] = json!({ "name": "right", "light": "right lamp" });
    let missing = (1..40).find(|seed| {
        project["seed"] = json!(seed);
        Fit::new(&stage, &project).summary.caustics[1].photons == 0
    });
    assert!(missing.is_some(), "no seed without a photon");
    for own_flow in [false, true] {
        project["caustics"][1]["own_flow"] = json!(own_flow);
        let out = stage.folder.path().join("frames");
        fs::create_dir_all(&out).unwrap();
        let project = parse(&project).unwrap();
        let summary = engine(&stage).render(&project, &out, &Progress::new(), &|_: &Path| {}).unwrap();
        assert_eq!(summary.passes, 4);
        assert!((summary.flow.unwrap().flux_ratio - 1.0).abs() < 1e-5);
    }
}

#[test]
fn check_lists_the_caustics_that_the_scene_casts() {
    let stage = stage();
    let mut project = project(&stage, parted());
    project["caustics"][0]["light"] = json!("left lamp");
    let report = check(&stage, &project).unwrap();
    let shares: f64 = report.caustics.iter().map(|c| c.share).sum();
    assert!((shares - 1.0).abs() < 1e-6, "{shares}");
    let names: Vec<_> =
        report.caustics.iter().map(|c| (c.light.as_str(), c.mesh.as_str(), c.name.as_deref())).collect();
    let all = [
        ("left lamp", "left ball", Some("left")),
        ("right lamp", "left ball", None),
        ("left lamp", "right ball", Some("right")),
        ("right lamp", "right ball", Some("right")),
    ];
    assert!(names.len() == 4 && all.iter().all(|caustic| names.contains(caustic)), "{names:?}");
    // Each lamp shines straight down on its own ball.
    assert!(names[..2].contains(&all[0]) && names[..2].contains(&all[3]), "{names:?}");
    assert!(report.to_text().contains("named 'left'"));
    let grouping = |report: &CheckReport| report.plan.left_out.iter().any(|l| l.what.contains("grouping"));
    assert!(!grouping(&report));
    project["caustics"] = json!([]);
    project["keys"][1] = json!({ "frame": 9, "shows": square(UPPER) });
    assert!(grouping(&check(&stage, &project).unwrap()));
}

#[test]
fn names_that_nothing_bears_are_refused_with_those_there_are() {
    let stage = stage();
    let refused = |pointer: &str, value: Value, words: &[&str]| {
        let mut project = project(&stage, parted());
        *project.pointer_mut(pointer).unwrap() = value;
        let message = match check(&stage, &project) {
            Err(error) => error.to_string(),
            Ok(_) => panic!("{pointer} was accepted"),
        };
        assert!(words.iter().all(|word| message.contains(word)), "{message}");
    };
    let named = |light: Value, mesh: Value| json!({ "name": "left", "light": light, "mesh": mesh });
    let lamps = ["caustics[0].light", "'sun'", "'left lamp'", "'right lamp'"];
    refused("/caustics/0", named(json!("sun"), Value::Null), &lamps);
    let balls = ["caustics[0].mesh", "'left'", "'left ball'", "'right ball'"];
    refused("/caustics/0", named(Value::Null, json!("left")), &balls);
    refused("/caustics/0/name", json!("green"), &["keys[1].caustics.left", "'green'", "'right'"]);
    refused("/caustics/0/name", json!("right"), &["caustics[1].name", "twice"]);
    refused("/caustics/0/name", json!(""), &["caustics[0].name", "empty"]);
    refused(
        "/keys/1/caustics/left",
        json!({ "brightness": -1 }),
        &["keys[1].caustics.left.brightness", "1000"],
    );
    refused(
        "/keys/1/caustics/left",
        json!({ "colour": [0, 1e9, 0] }),
        &["keys[1].caustics.left.colour", "1000"],
    );
    refused("/keys/1/caustics/left", json!({ "bright": 1 }), &["keys[1].caustics.left", "bright"]);
    refused("/keys/1/caustics/left", json!({ "shows": { "image": { "file": "none.png" } } }), &["none.png"]);
    refused("/scene", Value::Null, &["scene"]);
}

#[test]
fn lamps_of_one_name_count_as_one_and_are_noted() {
    let mut stage = stage();
    for light in &mut stage.desc.lights {
        let LightDesc::Point(lamp) = light else { panic!("a point light") };
        lamp.name = "lamp".into();
    }
    let mut project = project(&stage, parted());
    project["caustics"][0] = json!({ "name": "left", "light": "lamp" });
    let report = check(&stage, &project).unwrap();
    assert!(
        report.notes.iter().any(|note| note.text.contains("2 lights are called 'lamp'")),
        "{:?}",
        report.notes
    );
    assert!(report.caustics.iter().all(|caustic| caustic.name.as_deref() == Some("left")));
}
