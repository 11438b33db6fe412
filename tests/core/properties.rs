//! Random projects, whatever an artist may set and draw: what must hold for all of them.

use std::fs;
use std::path::Path;

use crate::crossing::crosses;
use crate::scenes::{Stage, glass, point, sphere_obj};
use crate::tracks;
use glam::{DVec3, Vec2, Vec3};
use lightloom_core::Progress;
use lightloom_core::engine::{Engine, Summary};
use lightloom_core::project::{AssetFolder, Project};
use proptest::prelude::*;
use serde_json::{Value, json};

const PHOTONS: usize = 300;

/// Where the light comes from and goes to.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Light {
    /// Picture to picture.
    Pictures,
    /// Points to points, paired by transport, and as they stand.
    Points { given: bool },
    /// The caustic of two balls to a picture.
    Caustic,
    /// Each ball's to its own.
    Parted { own_flow: bool },
}

/// A random project and its files.
#[derive(Clone, Debug)]
struct Drawn {
    light: Light,
    pictures: [Vec<u8>; 2],
    points: [Vec<[f32; 2]>; 2],
    aspect: f32,
    flow: Value,
    constraints: Vec<Value>,
    seed: u32,
}

fn polyline() -> impl Strategy<Value = Vec<[f32; 2]>> {
    prop::collection::vec([-0.1f32..1.1, -0.1f32..1.1], 2..5)
}

fn constraint() -> impl Strategy<Value = Value> {
    let wall = (polyline(), 0.001f32..0.06)
        .prop_map(|(points, thickness)| json!({ "type": "wall", "points": points, "thickness": thickness }));
    let line = (polyline(), 0.01f32..0.3, 0.0f32..3.0, 0.0f32..100.0).prop_map(|(points, width, speed, weight)| {
        json!({ "type": "directed_line", "points": points, "width": width, "speed": speed, "weight": weight })
    });
    prop_oneof![wall, line]
}

fn flow() -> impl Strategy<Value = Value> {
    let power = |low: f32, high: f32| (low..high).prop_map(|power| 10f32.powf(power));
    let gamma = prop_oneof![Just(0.0f32), 0.0f32..1.0, Just(1.0)];
    let fade = prop_oneof![
        (0.0f32..0.9, 0.02f32..0.1, 1.0f32..10.0)
            .prop_map(|(start, long, limit)| json!({ "type": "smooth", "start": start, "end": start + long, "limit": limit })),
        (0.0f32..0.99).prop_map(|tau| json!({ "type": "paper", "tau": tau })),
    ];
    let turbulence = prop_oneof![
        Just(Value::Null),
        (0.0f32..200.0, 4u32..40, 0.0f32..5.0).prop_map(
            |(strength, grid, rate)| json!({ "strength": strength, "grids": [grid], "rate": rate })
        ),
    ];
    let plain = (gamma, power(-8.0, 3.0), power(-3.0, 3.0), any::<bool>(), [8u32..24, 8u32..24], 1u32..10);
    (plain, fade, turbulence).prop_map(|((gamma, alpha, beta, joint, grid, steps), fade, turbulence)| {
        let fit = if joint { "joint" } else { "separate" };
        let mut flow =
            json!({ "gamma": gamma, "alpha": alpha, "beta": beta, "fit": fit, "grid": grid, "steps": steps, "fade": fade });
        if !turbulence.is_null() {
            flow["turbulence"] = turbulence;
        }
        flow
    })
}

fn drawn() -> impl Strategy<Value = Drawn> {
    let light = prop_oneof![
        Just(Light::Pictures),
        any::<bool>().prop_map(|given| Light::Points { given }),
        Just(Light::Caustic),
        any::<bool>().prop_map(|own_flow| Light::Parted { own_flow }),
    ];
    // At least one pixel is bright, or the picture would rightly be refused.
    let picture = || {
        prop::collection::vec(prop_oneof![Just(0u8), any::<u8>()], 35).prop_map(|mut pixels| {
            pixels.push(255);
            pixels
        })
    };
    let points = || prop::collection::vec([0.0f32..1.0, 0.0f32..1.0], PHOTONS);
    let files = ([picture(), picture()], [points(), points()]);
    let drawn = prop::collection::vec(constraint(), 0..4);
    (light, files, 0.4f32..2.5, flow(), drawn, any::<u32>()).prop_map(
        |(light, (pictures, points), aspect, flow, constraints, seed)| Drawn {
            light,
            pictures,
            points,
            aspect,
            flow,
            constraints,
            seed,
        },
    )
}

impl Drawn {
    fn traces(&self) -> bool {
        matches!(self.light, Light::Caustic | Light::Parted { .. })
    }

    /// The project with its files, the first key showing picture or points `first`.
    fn stage(&self, first: usize) -> (Stage, Project) {
        let mut stage = Stage::new();
        for (i, pixels) in self.pictures.iter().enumerate() {
            let picture = image::GrayImage::from_raw(6, 6, pixels.clone()).unwrap();
            picture.save(stage.folder.path().join(format!("{i}.png"))).unwrap();
        }
        for (i, points) in self.points.iter().enumerate() {
            let rows = points.iter().map(|[x, y]| format!("{x},{y}\n")).collect::<String>();
            stage.file(&format!("{i}.csv"), rows);
        }
        let picture = |i: usize| json!({ "image": { "file": format!("{i}.png") } });
        let points = |i: usize| json!({ "points": { "file": format!("{i}.csv") } });
        let [from, to] = match self.light {
            Light::Pictures => [picture(first), picture(1)],
            Light::Points { .. } => [points(first), points(1)],
            Light::Caustic | Light::Parted { .. } => [json!("physical_caustic"), picture(1)],
        };
        let mut project = json!({
            "lightloom": 1,
            "seed": self.seed,
            "plane": { "aspect": self.aspect },
            "matching": if self.light == (Light::Points { given: true }) { "given" } else { "transport" },
            "keys": [ { "frame": 1, "shows": from }, { "frame": 3, "shows": to } ],
            "constraints": self.constraints,
            "flow": self.flow,
            "render": { "width": 24, "height": 24, "photons": PHOTONS, "passes": 2, "background_samples": 1 }
        });
        if self.traces() {
            for (name, x) in [("left", -0.2), ("right", 0.2)] {
                stage.mesh(name, sphere_obj(2, Vec3::new(x, 0.12, 0.0), 0.08), glass(1.5));
                stage.desc.lights.push(point(1.0, [x, 1.0, 0.0]));
            }
            project["scene"] = json!(stage.desc);
        }
        if let Light::Parted { own_flow } = self.light {
            project["caustics"] = json!([{ "name": "left", "mesh": "left", "own_flow": own_flow }]);
            project["keys"][1]["caustics"] = json!({ "left": { "shows": picture(0) } });
        }
        let project = Project::parse(project.to_string().as_bytes(), Path::new("project.json")).unwrap();
        (stage, project)
    }

    /// Segments of the walls.
    fn walls(&self) -> Vec<[Vec2; 2]> {
        let walls = self.constraints.iter().filter(|constraint| constraint["type"] == "wall");
        let points =
            walls.map(|wall| serde_json::from_value::<Vec<[f32; 2]>>(wall["points"].clone()).unwrap());
        points
            .flat_map(|points| {
                points.windows(2).map(|w| [Vec2::from(w[0]), Vec2::from(w[1])]).collect::<Vec<_>>()
            })
            .collect()
    }
}

/// What a run leaves.
struct Run {
    summary: Summary,
    tracks: Vec<Vec<Vec2>>,
    flux: Vec<Vec<Vec3>>,
    rendered: Summary,
    /// Name and bytes of each frame.
    frames: Vec<(String, Vec<u8>)>,
}

impl Run {
    fn new(drawn: &Drawn, threads: usize) -> Self {
        let (stage, project) = drawn.stage(0);
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| Self::of(&stage, &project))
    }

    fn of(stage: &Stage, project: &Project) -> Self {
        let assets = AssetFolder::new(&stage.folder.path().join("project.json"), false).unwrap();
        let engine = Engine::new(assets);
        let [fitted, shown] = ["fitted", "shown"].map(|name| stage.folder.path().join(name));
        fs::create_dir_all(&fitted).unwrap();
        fs::create_dir_all(&shown).unwrap();
        let progress = Progress::new();
        let summary = engine.fit(project, &fitted, &progress, &|_| {}).unwrap();
        let rendered = engine.render(project, &shown, &progress, &|_| {}).unwrap();
        let files = fs::read_dir(&shown).unwrap().map(|entry| entry.unwrap().path());
        let mut frames: Vec<_> = files
            .filter(|path| path.extension().is_some_and(|extension| extension == "exr"))
            .map(|path| (path.file_name().unwrap().to_string_lossy().into_owned(), fs::read(&path).unwrap()))
            .collect();
        frames.sort();
        let (tracks, flux) =
            (tracks::read(&fitted.join("tracks.npy")), tracks::read(&fitted.join("flux.npy")));
        Self { summary, tracks, flux, rendered, frames }
    }
}

/// The same points, in whatever order.
fn sorted(points: &[Vec2]) -> Vec<[u32; 2]> {
    let mut all: Vec<_> = points.iter().map(|p| p.to_array().map(f32::to_bits)).collect();
    all.sort_unstable();
    all
}

fn all_arrive_and_stay_finite(run: &Run) {
    for summary in [&run.summary, &run.rendered] {
        let flow = &summary.flow.as_ref().unwrap().flow;
        assert_eq!(flow.endpoint_error, 0.0, "the end is exact");
        assert!(flow.solver_error.is_finite() && flow.fit_residual.is_finite());
        assert_eq!(summary.bad_values.nonfinite_replaced, 0);
    }
    assert!(run.tracks.iter().flatten().all(|p| p.is_finite()));
    assert!(run.flux.iter().flatten().all(|flux| flux.is_finite()));
    assert_eq!(run.frames.len(), 3);
}

fn light_is_kept(run: &Run) {
    let total = |step: &Vec<Vec3>| -> DVec3 { step.iter().map(|flux| flux.as_dvec3()).sum() };
    let start = total(&run.flux[0]);
    for step in &run.flux {
        // Some hundred numbers in single precision, rounded once each.
        assert!((total(step) / start - 1.0).abs().max_element() < 1e-6);
    }
    // Some hundred roundings of 6e-8 where photons add up in a texel.
    let ratios = [run.rendered.flow.as_ref().map(|flow| flow.flux_ratio), run.rendered.energy.texture_ratio];
    assert!(ratios.into_iter().flatten().all(|ratio| (ratio - 1.0).abs() < 1e-5), "{ratios:?}");
}

fn no_wall_is_crossed(drawn: &Drawn, run: &Run) {
    let flow = &run.summary.flow.as_ref().unwrap().flow;
    assert_eq!(flow.wall_crossings + run.rendered.flow.as_ref().unwrap().flow.wall_crossings, 0);
    let walls = drawn.walls();
    let through = |a: Vec2, b: Vec2| walls.iter().any(|&[p, q]| crosses(a, b, p, q));
    let crossed = (0..run.tracks[0].len())
        .filter(|&i| run.tracks.windows(2).any(|steps| through(steps[0][i], steps[1][i])))
        .count();
    assert!(crossed <= flow.unreachable, "{crossed} photons crossed, {} are shut off", flow.unreachable);
}

/// Each target point has one photon: points of a file are all there, in whatever order, or row by row as given; and those drawn
/// from a picture are the same wherever the light came from.
fn each_target_has_one_photon(drawn: &Drawn, run: &Run) {
    let ends = run.tracks.last().unwrap();
    let asked: Vec<Vec2> = drawn.points[1].iter().map(|p| Vec2::from(*p)).collect();
    match drawn.light {
        Light::Points { given: true } => assert_eq!(*ends, asked),
        Light::Points { given: false } => assert_eq!(sorted(ends), sorted(&asked)),
        Light::Pictures => {
            let (stage, project) = drawn.stage(1);
            let other = Run::of(&stage, &project);
            assert_eq!(sorted(ends), sorted(other.tracks.last().unwrap()));
        }
        Light::Caustic | Light::Parted { .. } => assert_eq!(ends.len(), PHOTONS),
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, max_shrink_iters: 20, ..ProptestConfig::with_cases(32) })]

    #[test]
    fn random_projects_keep_their_light_arrive_and_do_not_depend_on_threads(drawn in drawn()) {
        let (one, two) = (Run::new(&drawn, 1), Run::new(&drawn, 2));
        all_arrive_and_stay_finite(&one);
        light_is_kept(&one);
        no_wall_is_crossed(&drawn, &one);
        each_target_has_one_photon(&drawn, &one);
        prop_assert!(one.tracks == two.tracks && one.flux == two.flux, "tracks of one thread and of two");
        prop_assert!(one.frames == two.frames, "frames of one thread and of two");
    }
}
