//! The live preview: what it remembers from edit to edit, and where its photons are.

use std::sync::Arc;

use crate::previews::{bits, draft, example, example_path, flux, stages, two_balls};
use glam::Vec2;
use lightloom_core::engine::{Engine, Preview, Quality};
use lightloom_core::flow::MotionMethod;
use lightloom_core::photon::Tracer;
use lightloom_core::project::{AssetFolder, Ease, Project, Shows};
use lightloom_core::scene::light::{LightRole, PointLight};
use lightloom_core::scene::{LightDesc, Scene};
use lightloom_core::{Error, Progress};
use serde_json::json;

const EXAMPLES: [&str; 7] =
    ["letters_free", "letters", "dark_glass", "bottles", "loop", "rabbit", "rabbit_fine"];

#[test]
fn a_new_gamma_fits_and_pairs_anew_but_does_not_trace() {
    let (mut project, engine) = example("dark_glass");
    let first = draft(&engine, &project);
    assert_eq!(stages(&first), ["load", "trace", "plan", "fit", "match", "watch"]);
    project.flow.gamma = 0.9;
    let second = draft(&engine, &project);
    assert_eq!(stages(&second), ["load", "plan", "fit", "match", "watch"]);
    assert_ne!(bits(&first), bits(&second));
    // What was remembered is what would have been worked out.
    assert_eq!(bits(&second), bits(&draft(&example("dark_glass").1, &project)));
}

#[test]
fn a_key_moved_in_time_leaves_the_fields() {
    let (mut project, engine) = example("loop");
    let count = draft(&engine, &project).frames().count();
    project.keys.last_mut().unwrap().frame += 7;
    let moved = draft(&engine, &project);
    assert_eq!(stages(&moved), ["load", "carry"]);
    assert_eq!(moved.frames().count(), count + 7);
    // Carried along remembered fields, the photons go where they went while these were fitted.
    assert_eq!(bits(&moved), bits(&draft(&example("loop").1, &project)));
}

#[test]
fn colour_and_brightness_change_flux_alone() {
    let (mut project, engine) = example("bottles");
    let before = draft(&engine, &project);
    project.keys[1].caustics.get_mut("green").unwrap().brightness = 0.25;
    let after = draft(&engine, &project);
    assert_eq!(stages(&after), ["load"]);
    assert_eq!(bits(&before), bits(&after));
    let last = *after.frames().end();
    let ([old, new], green) = ([&before, &after].map(|s| flux(s, last)), after.groups()[0].clone());
    assert_eq!(green.0.as_deref(), Some("green"));
    for row in 0..after.photons() {
        let factor = if green.1.contains(&row) { 0.25 } else { 1.0 };
        // Scaling by a power of two is exact, but the share of each photon is rounded before.
        assert!((new[row] - old[row] * factor).abs().max_element() <= 1e-6 * old[row].max_element());
    }
    assert!((after.energy(last).unwrap() - 1.0).abs() < 1e-5);
}

#[test]
fn a_moved_light_traces_anew_and_a_moved_camera_does_not() {
    let (_stage, mut project, engine) = two_balls();
    draft(&engine, &project);
    project.scene.as_mut().unwrap().camera.position = [0.1, 1.0, 1.0];
    assert_eq!(stages(&draft(&engine, &project)), ["load"]);
    let Some(LightDesc::Point(lamp)) = project.scene.as_mut().unwrap().lights.first_mut() else { panic!() };
    lamp.position[0] += 0.02;
    assert_eq!(stages(&draft(&engine, &project)), ["load", "trace", "plan", "fit", "match", "watch"]);
}

#[test]
fn a_lamp_for_the_background_alone_leaves_the_light_as_it_is() {
    let (_stage, mut project, engine) = two_balls();
    let lights = |project: &mut Project, role| {
        let lamp = PointLight { role, position: [0.4, 1.5, 0.3], ..Default::default() };
        project.scene.as_mut().unwrap().lights[2] = LightDesc::Point(lamp);
    };
    project.scene.as_mut().unwrap().lights.push(LightDesc::Point(PointLight::default()));
    lights(&mut project, LightRole::Background);
    let before = draft(&engine, &project);
    let LightDesc::Point(lamp) = &mut project.scene.as_mut().unwrap().lights[2] else { panic!() };
    lamp.position = [0.0, 2.0, 0.0];
    let after = draft(&engine, &project);
    assert_eq!(stages(&after), ["load"]);
    assert_eq!(bits(&before), bits(&after));
    lights(&mut project, LightRole::All);
    assert!(stages(&draft(&engine, &project)).contains(&"trace"));
}

#[test]
fn a_picture_that_was_painted_over_is_read_again() {
    let (stage, project, engine) = two_balls();
    let before = draft(&engine, &project);
    let half = image::GrayImage::from_fn(16, 16, |x, _| image::Luma([if x < 4 { 255 } else { 0 }]));
    half.save(stage.folder.path().join("square.png")).unwrap();
    let after = draft(&engine, &project);
    assert_eq!(stages(&after), ["load", "plan", "fit", "match", "watch"]);
    assert_ne!(bits(&before), bits(&after));
}

#[test]
fn a_mesh_is_read_again_when_it_or_a_file_that_it_names_was_changed() {
    let (stage, mut project, engine) = two_balls();
    let file = |name: &str| stage.folder.path().join(name);
    let obj = std::fs::read_to_string(file("left ball.obj")).unwrap();
    let glass = |ior: &str| {
        let text = format!("newmtl glass\nKs 1 1 1\nTf 1 1 1\nNi {ior}\nd 0.2\nillum 7\nabsorption 0 0 0\n");
        std::fs::write(file("glass.mtl"), text).unwrap();
    };
    std::fs::write(file("left ball.obj"), format!("mtllib glass.mtl\nusemtl glass\n{obj}")).unwrap();
    project.scene.as_mut().unwrap().meshes[0].material = None;
    // Of another length each: files of one moment may have the same time.
    glass("1.5");
    let before = draft(&engine, &project);
    let named = before.mesh_files().iter().any(|path| path.ends_with("glass.mtl"));
    assert!(named, "{:?}", before.mesh_files());
    assert!(!stages(&draft(&engine, &project)).contains(&"trace"));
    glass("1.35");
    let after = draft(&engine, &project);
    assert!(stages(&after).contains(&"trace"));
    assert_ne!(bits(&before), bits(&after));
    std::fs::remove_file(file("left ball.obj")).unwrap();
    let gone = engine.preview(&project, Quality::Draft, 1, &Progress::new(), &mut |_| ());
    assert!(matches!(gone, Err(Error::Io { .. }) | Err(Error::Value { .. })), "{:?}", gone.err());
}

#[test]
fn every_example_is_previewed_whole() {
    for name in EXAMPLES {
        let (project, engine) = example(name);
        for quality in [Quality::Draft, Quality::Preview] {
            let preview = engine.preview(&project, quality, 30, &Progress::new(), &mut |_| ()).unwrap();
            let frames = preview.frames();
            let keys = [&project.keys[0], project.keys.last().unwrap()];
            assert_eq!([*frames.start(), *frames.end()], keys.map(|key| key.frame), "{name}");
            assert_eq!(Some(preview.photons()), quality.photons());
            for frame in frames {
                let positions = preview.positions(frame).unwrap();
                assert!(positions.iter().all(|p| p.is_finite()), "{name}, frame {frame}");
                // The flux is a sum of f32, each rounded to 6e-8.
                let energy = preview.energy(frame).unwrap();
                assert!((energy - 1.0).abs() < 1e-5, "{name}, frame {frame}: {energy}");
            }
            let numbers = preview.numbers().unwrap();
            assert_eq!(numbers.flow.wall_crossings, 0, "{name}");
            assert_eq!(numbers.flow.endpoint_error, 0.0, "{name}");
        }
    }
}

#[test]
fn photons_start_at_the_physical_caustic_and_end_at_their_targets() {
    let (project, engine) = example("dark_glass");
    let preview = draft(&engine, &project);
    let assets = AssetFolder::new(&example_path("dark_glass"), false).unwrap();
    let desc = project.scene.as_ref().unwrap();
    let scene = Scene::load(desc, &|path, place| assets.resolve(path, place)).unwrap().0;
    let tracer = Tracer::new(&scene, project.seed, &Progress::new()).unwrap();
    let photons = tracer.trace(0, preview.photons(), &Progress::new()).unwrap().0;
    let sorted = |positions: &[Vec2]| {
        let mut bits: Vec<_> = positions.iter().map(|p| p.to_array().map(f32::to_bits)).collect();
        bits.sort_unstable();
        bits
    };
    let (first, last) = (*preview.frames().start(), *preview.frames().end());
    assert_eq!(sorted(preview.positions(first).unwrap()), sorted(&photons.positions));
    assert_eq!(preview.positions(last).unwrap(), preview.targets(first));
    // On the picture, a square.
    let Shows::Image(flower) = &project.keys[1].shows else { panic!("the example ends with a picture") };
    let (centre, width) = (Vec2::from(flower.placement.centre.unwrap()), flower.placement.width.unwrap());
    let upright = Vec2::from_angle(-flower.placement.rotate.to_radians());
    let inside = |p: &Vec2| upright.rotate(*p - centre).abs().max_element() <= 0.5 * width + 1e-5;
    assert!(preview.targets(first).iter().all(inside));
    let track = preview.track(17);
    assert_eq!(track.len(), preview.frames().count());
    assert_eq!(track[0].1, preview.positions(first).unwrap()[17]);
    let near = preview.nearest(50, preview.positions(50).unwrap()[17], 3);
    assert_eq!((near.len(), near[0]), (3, 17));
}

#[test]
fn the_frame_under_the_playhead_comes_first_and_stays_the_same() {
    for (name, playhead) in [("loop", None), ("bottles", Some(50))] {
        let (mut project, engine) = example(name);
        let keys: Vec<i32> = project.keys.iter().map(|key| key.frame).collect();
        let playhead = playhead.unwrap_or((keys[keys.len() - 2] + keys[keys.len() - 1]) / 2);
        let (mut first, mut grew, mut same, mut before) = (None::<Arc<Preview>>, true, true, 0);
        let ready = |preview: &Preview| preview.frames().filter(|f| preview.is_ready(*f)).count();
        let mut watch = |preview: &Arc<Preview>| {
            match &first {
                Some(first) => same &= preview.has_light_of(first, playhead),
                None if preview.is_ready(playhead) => first = Some(preview.clone()),
                None => (),
            }
            grew &= ready(preview) >= before;
            before = ready(preview);
        };
        let progress = Progress::new();
        let preview = engine.preview(&project, Quality::Draft, playhead, &progress, &mut watch).unwrap();
        let first = first.unwrap();
        assert_eq!(ready(&first), keys.len() + 1, "{name}: it and the keys");
        assert!(grew && same && preview.has_light_of(&first, playhead), "{name}");
        assert!(!preview.has_light_of(&first, playhead + 1), "{name}: known by now alone");
        assert_eq!(before, preview.frames().count(), "{name}");
        project.flow.gamma = 0.9;
        assert!(!draft(&engine, &project).has_light_of(&preview, playhead), "{name}: of other work");
    }
}

#[test]
fn caustics_keep_their_rows_and_flow_by_themselves() {
    let (_stage, mut project, engine) = two_balls();
    // Of guided photons one knows what a field leaves undone.
    project.method = MotionMethod::Guided;
    let preview = draft(&engine, &project);
    let names: Vec<_> = preview.groups().iter().map(|(name, _)| name.as_deref()).collect();
    assert_eq!(names, [Some("left"), Some("right"), None]);
    let rows = |group: usize| preview.groups()[group].1.clone();
    assert_eq!(rows(2).end, preview.photons());
    for (group, centre) in [(0, Vec2::new(0.2, 0.8)), (1, Vec2::new(0.8, 0.2))] {
        let at = &preview.positions(9).unwrap()[rows(group)];
        assert!(at.iter().all(|p| (*p - centre).abs().max_element() <= 0.1 + 1e-6));
    }
    // In between both caustics are on their way, each by its own field.
    let fields = preview.fields(4);
    let moved: Vec<Vec<_>> = fields.iter().map(|field| field.rows().to_vec()).collect();
    assert_eq!(moved, [vec![rows(1)], vec![rows(0)]]);
    assert_eq!(fields[0].grid().cells, [16, 16]);
    let residuals = preview.residuals(4, &Progress::new()).unwrap().unwrap();
    for field in &fields {
        for row in field.rows()[0].clone().step_by(100) {
            let (at, b) = (preview.positions(4).unwrap()[row], preview.targets(4)[row]);
            // Frame 4 is 3/8 of the way by the smooth ease.
            let t = Ease::Smooth.apply(3.0 / 8.0) as f32;
            let wanted = (b - at) / (1.0 - t) - field.velocity(at);
            assert!(residuals[row].distance(wanted) < 1e-5, "{} {wanted}", residuals[row]);
        }
    }
    // At gamma 1 alone does u have no curl, at 0 alone no divergence.
    assert!(fields.iter().any(|f| f.curl(Vec2::new(0.4, 0.6)) != 0.0));
    assert!(fields.iter().any(|f| f.divergence(Vec2::new(0.4, 0.6)) != 0.0));
    assert!(preview.fields(21).is_empty(), "photons that have arrived are moved by no field");
}

#[test]
fn all_methods_and_a_single_key_are_previewed() {
    let (mut project, engine) = example("letters_free");
    for method in MotionMethod::ALL {
        project.method = method;
        let preview = draft(&engine, &project);
        assert!(preview.frames().all(|frame| preview.is_ready(frame)), "{method:?}");
        assert_eq!(preview.positions(60).unwrap(), preview.targets(1), "{method:?}");
        assert_eq!(preview.fields(20).is_empty(), !method.fits());
    }
    project.keys.truncate(1);
    let still = draft(&engine, &project);
    assert_eq!(still.frames(), 1..=1);
    assert!(
        still.positions(1).is_some()
            && still.numbers().is_none()
            && still.residuals(1, &Progress::new()).is_ok()
    );
}

#[test]
fn rows_paired_as_given_stay_paired() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("project.json");
    let row = |i: usize| [(i % 100) as f32 / 100.0, (i / 100) as f32 / 100.0];
    let text = |turn: bool| -> String {
        (0..9_000)
            .map(|i| {
                if turn {
                    format!("{} {}\n", row(i)[1], row(i)[0])
                } else {
                    format!("{} {}\n", row(i)[0], row(i)[1])
                }
            })
            .collect()
    };
    std::fs::write(folder.path().join("a.csv"), text(false)).unwrap();
    std::fs::write(folder.path().join("b.csv"), text(true)).unwrap();
    let key = |frame: i32, file: &str| json!({ "frame": frame, "shows": { "points": { "file": file } } });
    let project = json!({ "lightloom": 1, "matching": "given", "keys": [key(1, "a.csv"), key(5, "b.csv")] });
    let project = Project::parse(project.to_string().as_bytes(), &path).unwrap();
    let engine = Engine::new(AssetFolder::new(&path, false).unwrap());
    for (quality, count) in [(Quality::Draft, 4_000), (Quality::Preview, 9_000)] {
        let preview = engine.preview(&project, quality, 1, &Progress::new(), &mut |_| ()).unwrap();
        assert_eq!(preview.photons(), count);
        let (a, b) = (preview.positions(1).unwrap(), preview.positions(5).unwrap());
        assert!(a.iter().zip(b).all(|(a, b)| a.to_array() == [b.y, b.x]));
        assert!((preview.energy(5).unwrap() - 1.0).abs() < 1e-5);
    }
}

#[test]
fn a_sketch_that_is_cancelled_stops_and_harms_none_after_it() {
    let (mut project, engine) = example("letters");
    let progress = Progress::new();
    let stop = |preview: &Arc<Preview>| {
        if preview.is_ready(20) {
            progress.cancel();
        }
    };
    let cancelled = engine.preview(&project, Quality::Draft, 20, &progress, &mut { stop });
    assert!(matches!(cancelled, Err(Error::Cancelled)));
    assert!(matches!(engine.shot(&project, [64, 36], 1, &progress), Err(Error::Cancelled)));
    project.flow.gamma = 0.6;
    let after = draft(&engine, &project);
    assert_eq!(bits(&after), bits(&draft(&example("letters").1, &project)));
    let (project, engine) = example("dark_glass");
    let none = engine.preview(&project, Quality::Draft, 1, &progress, &mut |_| ());
    assert!(matches!(none, Err(Error::Cancelled)), "a scene is not even loaded");
}

#[test]
fn what_a_render_refuses_a_sketch_refuses_with_the_same_words() {
    let (good, engine) = example("letters_free");
    let assets = AssetFolder::new(&example_path("letters_free"), false).unwrap();
    let broken: [fn(&mut Project); 3] = [
        |project| project.flow.gamma = 2.0,
        |project| project.keys[1].frame = 1,
        |project| {
            project.scene = Some(
                serde_json::from_str(r#"{ "meshes": [ { "name": "a", "file": "none.obj" } ] }"#).unwrap(),
            );
        },
    ];
    for spoil in broken {
        let mut project = good.clone();
        spoil(&mut project);
        let previewed = engine.preview(&project, Quality::Draft, 1, &Progress::new(), &mut |_| ());
        let checked = Engine::new(assets.clone()).check(&project);
        assert_eq!(previewed.err().unwrap().to_string(), checked.err().unwrap().to_string());
    }
}

#[test]
fn any_number_of_threads_gives_the_same_photons() {
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let (project, engine) = example("bottles");
            bits(&draft(&engine, &project))
        })
    };
    assert_eq!(on(1), on(3));
}

#[test]
fn long_animations_keep_fewer_photons_and_say_so() {
    let (mut project, engine) = example("letters_free");
    project.keys[1].frame = 10_000;
    let preview = draft(&engine, &project);
    assert_eq!(preview.photons(), 2_000);
    assert!(
        preview.notes().iter().any(|note| note.text.contains("fit into 160 MB")),
        "{:?}",
        preview.notes()
    );
    assert!(preview.is_ready(5_000));
    // Twice the memory holds twice the photons: eight bytes for each in each frame.
    let roomy = draft(&engine.with_preview_memory(320_000_000), &project);
    assert_eq!(roomy.photons(), 4_000);
}

#[test]
fn finer_photons_go_along_the_fields_of_the_preview() {
    let (mut project, engine) = example("letters_free");
    let run = |engine: &Engine, project: &Project, quality| {
        engine.preview(project, quality, 30, &Progress::new(), &mut |_| ()).unwrap()
    };
    let preview = run(&engine, &project, Quality::Preview);
    let fine = run(&engine, &project, Quality::Fine);
    assert_eq!(fine.photons(), Quality::Fine.photons().unwrap());
    assert_eq!(stages(&fine), ["load", "match", "carry"]);
    let at = Vec2::new(0.4, 0.5);
    assert_eq!(fine.fields(20)[0].velocity(at), preview.fields(20)[0].velocity(at));
    project.flow.gamma = 0.5;
    assert_eq!(
        stages(&run(&engine, &project, Quality::Fine)),
        ["load", "plan", "fit", "match", "watch", "carry"]
    );
}
