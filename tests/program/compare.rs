//! `lightloom compare` and the methods in projects, as a script meets them.

use std::fs;
use std::path::Path;

use glam::{Vec2, vec2};
use lightloom_core::files::npy;
use lightloom_core::render::PlaneView;
use lightloom_core::scene::SurfaceId;
use serde_json::{Value, json};

use crate::small::{letters, lightloom};

/// Runs the program, which must succeed, and returns the JSON that it printed.
fn run(args: &[&str]) -> Value {
    let output = lightloom(&[args, &["--json"]].concat());
    assert!(output.status.success(), "{args:?}: {}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

fn names_in(dir: &Path) -> Vec<String> {
    let name = |entry: std::io::Result<fs::DirEntry>| entry.unwrap().file_name().into_string().unwrap();
    let mut names: Vec<_> = fs::read_dir(dir).unwrap().map(name).collect();
    names.sort();
    names
}

#[test]
fn compare_writes_one_sheet_and_the_numbers_of_every_method() {
    let (folder, project) = letters("flow");
    let out = folder.path().join("out");
    let printed = run(&["compare", text(&project), "--out", text(&out), "--format", "png"]);
    assert_eq!(names_in(&out), ["compare.json", "compare.png", "flow", "guided", "linear", "stylized"]);
    let frames: Vec<String> = [1, 3, 4, 6, 7, 9].map(|n| format!("frame.000{n}.png")).to_vec();
    for method in ["flow", "guided", "stylized", "linear"] {
        let names = names_in(&out.join(method));
        assert!(frames.iter().all(|frame| names.contains(frame)), "{method}: {names:?}");
        assert_eq!(names.len(), frames.len() + 1, "the frames and their contact sheet: {names:?}");
    }
    // Six pictures of 400 pixels beside the words, four rows.
    let sheet = image::open(out.join("compare.png")).unwrap();
    assert!(sheet.width() > 6 * 400 && sheet.height() > 4 * 400);

    let methods = printed["methods"].as_array().unwrap();
    let named: Vec<_> = methods.iter().map(|method| method["method"].as_str().unwrap()).collect();
    assert_eq!(named, ["flow", "guided", "stylized", "linear"]);
    for method in methods {
        assert!(method["transport_cost_ratio"].as_f64().unwrap() >= 1.0 - 1e-9, "{method}");
        assert_eq!(method["crossing_index"].as_array().unwrap().len(), 3);
        assert_eq!(method["summary"]["passes"], 2);
        assert!(method["summary"]["endpoint_error"].as_f64().unwrap() < 1e-6);
    }
    let cost = |i: usize| methods[i]["transport_cost_ratio"].as_f64().unwrap();
    assert!(
        cost(1) == cost(3) && cost(2) > cost(1),
        "the same pairs for field and lines, longer ways before"
    );
}

#[test]
fn a_comparison_shows_what_render_shows_on_any_number_of_threads() {
    let (folder, project) = letters("stylized");
    let render = |command: &str, name: &str, threads: &str| {
        let out = folder.path().join(name);
        let args = [command, text(&project), "--out", text(&out), "--frames", "1-9x4", "--threads", threads];
        run(&args);
        let frames = if command == "compare" { out.join("stylized") } else { out };
        ["0001.exr", "0005.exr", "0005.png", "0009.png"]
            .map(|frame| fs::read(frames.join(format!("frame.{frame}"))).unwrap())
    };
    let compared = render("compare", "two", "2");
    assert!(compared == render("compare", "one", "1"), "threads change the bytes");
    assert!(compared == render("render", "alone", "2"), "render shows something else");
}

#[test]
fn every_method_ends_at_the_same_light_and_leaves_out_what_it_does_not_need() {
    let fit = |method: &str| {
        let (folder, project) = letters(method);
        let out = folder.path().join("fit");
        let summary = run(&["fit", text(&project), "--out", text(&out)]);
        assert!(summary["endpoint_error"].as_f64().unwrap() < 1e-6);
        assert!(summary["transport_cost"].as_f64().unwrap() > 0.0);
        let (header, tracks) = npy::parse(&fs::read(out.join("tracks.npy")).unwrap()).unwrap();
        assert_eq!(header.shape, [9, 4000, 2]);
        let mut last: Vec<[u32; 2]> =
            tracks[8 * 8000..].chunks(2).map(|p| [p[0].to_bits(), p[1].to_bits()]).collect();
        last.sort_unstable();
        let left: Vec<String> = summary["left_out"]
            .as_array()
            .unwrap()
            .iter()
            .map(|left| left["what"].as_str().unwrap().to_owned())
            .collect();
        (last, left, out.join("fields.npz").exists(), folder)
    };
    let (flow, left_by_flow, flow_fields, _) = fit("flow");
    let (linear, left_by_linear, linear_fields, _) = fit("linear");
    let (stylized, left_by_stylized, stylized_fields, _) = fit("stylized");
    assert!(flow == linear && flow == stylized, "each target is reached once");
    assert_eq!([flow_fields, linear_fields, stylized_fields], [true, false, false]);
    let leaves = |left: &[String], what: &str| left.iter().any(|name| name == what);
    assert!(!leaves(&left_by_flow, "fit and advection"));
    assert!(leaves(&left_by_linear, "fit and advection") && !leaves(&left_by_linear, "transport map"));
    assert!(leaves(&left_by_stylized, "fit and advection") && leaves(&left_by_stylized, "transport map"));
}

#[test]
fn given_pairs_go_by_field_and_by_lines_only() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.csv"), "x,y\n0.2,0.2\n0.8,0.2\n0.5,0.8\n").unwrap();
    let key = |frame: i32| json!({ "frame": frame, "shows": { "points": { "file": "a.csv" } } });
    let project = |method: &str| {
        let path = folder.path().join(format!("{method}.json"));
        let flow = json!({ "grid": 16, "steps": 4 });
        let render = json!({ "width": 32, "height": 32 });
        let project = json!({ "lightloom": 1, "keys": [key(1), key(5)], "matching": "given", "method": method,
            "flow": flow, "render": render });
        fs::write(&path, project.to_string()).unwrap();
        path
    };
    let out = folder.path().join("out");
    let refused = lightloom(&["check", text(&project("stylized"))]);
    assert_eq!(refused.status.code(), Some(3));
    let message = String::from_utf8(refused.stderr).unwrap();
    assert!(message.contains("method") && message.contains("given"), "{message}");
    let compared = run(&["compare", text(&project("flow")), "--out", text(&out)]);
    assert_eq!(compared["methods"].as_array().unwrap().len(), 2);
}

#[test]
fn an_unknown_method_is_refused_with_the_ones_there_are() {
    let (_folder, project) = letters("magic");
    let refused = lightloom(&["check", text(&project)]);
    assert_eq!(refused.status.code(), Some(3));
    let message = String::from_utf8(refused.stderr).unwrap();
    assert!(["magic", "flow", "stylized", "linear"].iter().all(|word| message.contains(word)), "{message}");
}

#[test]
fn a_comparison_never_overwrites_what_it_is_made_from() {
    let (folder, project) = letters("flow");
    let inside = folder.path().join("out/flow");
    fs::create_dir_all(&inside).unwrap();
    for name in ["letters.json", "letter_s.png"] {
        fs::copy(folder.path().join(name), inside.join(name)).unwrap();
    }
    fs::copy(folder.path().join("letter_c.png"), inside.join("frame.0001.png")).unwrap();
    let moved = fs::read_to_string(&project).unwrap().replace("letter_c.png", "frame.0001.png");
    fs::write(inside.join("letters.json"), moved).unwrap();
    let out = folder.path().join("out");
    let refused = lightloom(&["compare", text(&inside.join("letters.json")), "--out", text(&out)]);
    assert_eq!(refused.status.code(), Some(2), "{}", String::from_utf8_lossy(&refused.stderr));
}

#[test]
fn a_plane_point_is_seen_where_the_ray_through_its_pixel_meets_the_plane() {
    let scene = crate::scenes::Stage::new().load();
    let view = PlaneView::new(Some(&scene), scene.receiver().extent());
    let (width, height) = (320, 200);
    let mut met = 0;
    for pixel in (0..20).flat_map(|y| (0..32).map(move |x| vec2(x as f32, y as f32) * 10.0 + 5.0)) {
        let place = pixel / vec2(width as f32, height as f32) * 2.0 - 1.0;
        let ray = scene.camera().ray(place.x, -place.y, width as f32 / height as f32);
        let Some(hit) = scene.intersect(&ray).filter(|hit| hit.surface == SurfaceId::Receiver) else {
            continue;
        };
        let seen =
            view.pixel_from_plane(scene.receiver().plane_from_world(hit.point), [width, height]).unwrap();
        // A ray some metres long in f32, 300 pixels wide.
        assert!(seen.distance(pixel) < 1e-2, "{seen} {pixel}");
        met += 1;
    }
    assert!(met > 50, "the camera looks at the receiver: {met}");
    let behind: Vec2 =
        scene.receiver().plane_from_world(scene.camera().position - scene.camera().forward * 9.0);
    let world = scene.receiver().world_from_plane(behind) - scene.camera().position;
    assert_eq!(
        view.pixel_from_plane(behind, [width, height]).is_none(),
        world.dot(scene.camera().forward) <= 0.0
    );
}
