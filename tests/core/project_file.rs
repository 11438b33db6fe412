//! The project file: what is saved comes back, and what is wrong is named with its place.

use std::path::Path;

use lightloom_core::Error;
use lightloom_core::project::{AssetFolder, Project, ProjectFile};
use proptest::prelude::*;
use serde_json::{Value, json};

/// A project with a value of every kind in it.
fn good() -> Value {
    json!({
        "lightloom": 1,
        "name": "Letters",
        "seed": 7,
        "plane": { "aspect": 2.0, "watts": 3.0 },
        "keys": [
            { "frame": 1, "shows": { "image": { "file": "c.png" } }, "ease": "linear" },
            { "frame": 25, "shows": { "points": { "file": "s.csv" } } }
        ],
        "flow": { "gamma": 0.25, "alpha": 0.001, "grid": [64, 32], "steps": 20, "fade": { "type": "paper", "tau": 0.85 } },
        "render": { "width": 320, "height": 180, "photons": 1000, "passes": 2 },
        "output": { "name": "shot.####", "fps": [24000, 1001], "formats": ["png"] }
    })
}

fn parse(text: &str) -> Result<Project, Error> {
    Project::parse(text.as_bytes(), Path::new("shot.json"))
}

/// The message for `good()` with the value at `pointer` replaced; it must name the file.
fn complaint(pointer: &str, value: Value) -> String {
    let mut project = good();
    *project.pointer_mut(pointer).unwrap_or_else(|| panic!("no {pointer}")) = value.clone();
    let message = match parse(&project.to_string()) {
        Err(error) => error.to_string(),
        Ok(_) => panic!("{pointer} = {value} was accepted"),
    };
    assert!(message.contains("shot.json"), "{message}");
    message
}

#[test]
fn what_is_saved_comes_back() {
    let project = parse(&good().to_string()).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("saved.json");
    project.save(&path).unwrap();
    assert_eq!(Project::load(&path).unwrap(), project);
    project.save(&path).unwrap();
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1, "no temporary file stays behind");
}

#[test]
fn the_smallest_project_is_a_few_lines() {
    let text = r#"{ "lightloom": 1, "keys": [ { "frame": 1, "shows": { "image": { "file": "c.png" } } } ] }"#;
    assert_eq!(parse(text).unwrap().frames().unwrap(), [1]);
}

#[test]
fn an_empty_file_is_an_empty_project() {
    for text in ["", "  \n", "\u{feff}"] {
        assert!(parse(text).unwrap_err().to_string().contains("empty project"), "{text:?}");
    }
}

#[test]
fn a_file_cut_off_anywhere_is_refused_with_line_and_column() {
    let text = serde_json::to_string_pretty(&good()).unwrap();
    for end in 1..text.len() - 1 {
        let message = parse(&text[..end]).unwrap_err().to_string();
        assert!(message.contains("line ") && message.contains("column "), "cut at {end}: {message}");
    }
}

#[test]
fn a_byte_order_mark_is_no_error_and_utf16_is_named() {
    assert!(parse(&format!("\u{feff}{}", good())).is_ok());
    let utf16: Vec<u8> = good().to_string().encode_utf16().flat_map(u16::to_le_bytes).collect();
    let message = Project::parse(&utf16, Path::new("shot.json")).unwrap_err().to_string();
    assert!(message.contains("UTF-16"), "{message}");
}

#[test]
fn nan_and_infinity_are_refused_where_they_stand() {
    for token in ["NaN", "Infinity", "-Infinity"] {
        let text = good().to_string().replace("\"gamma\":0.25", &format!("\"gamma\":{token}"));
        let message = parse(&text).unwrap_err().to_string();
        assert!(message.contains("flow.gamma") && message.contains("line 1"), "{message}");
    }
}

#[test]
fn a_number_too_large_for_its_type_is_out_of_range_and_not_infinite() {
    assert!(complaint("/flow/alpha", json!(1e39)).contains("flow.alpha"));
    assert!(complaint("/plane/watts", json!(1e39)).contains("plane.watts"));
}

#[test]
fn null_is_no_number() {
    let message = complaint("/flow/gamma", Value::Null);
    assert!(message.contains("flow.gamma") && message.contains("null"), "{message}");
}

#[test]
fn a_value_that_is_not_finite_is_never_written() {
    let mut project = parse(&good().to_string()).unwrap();
    project.flow.gamma = f32::NAN;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("saved.json");
    assert!(project.save(&path).unwrap_err().to_string().contains("flow.gamma"));
    assert!(!path.exists());
}

#[test]
fn counts_that_are_negative_fractional_or_huge_are_refused_with_their_range() {
    for (pointer, name) in [
        ("/render/photons", "render.photons"),
        ("/render/passes", "render.passes"),
        ("/flow/steps", "flow.steps"),
    ] {
        for value in [json!(-1), json!(1.5), json!(5e9), json!(5_000_000_000_u64), json!(0)] {
            let message = complaint(pointer, value.clone());
            assert!(message.contains(name), "{value}: {message}");
            assert!(
                message.contains(" to ") || message.contains(" between "),
                "no range for {value}: {message}"
            );
        }
    }
}

#[test]
fn grids_are_at_least_8_by_8_and_refused_before_memory_is_taken() {
    for grid in [
        json!([0, 0]),
        json!([1, 64]),
        json!([2, 2]),
        json!([100_000, 100_000]),
        json!(536_870_909),
        json!(u32::MAX),
    ] {
        assert!(complaint("/flow/grid", grid).contains("flow.grid"));
    }
    let message = complaint("/flow/grid", json!([100_000, 100_000]));
    assert!(message.contains("GiB"), "{message}");
    let mut stretched = good();
    stretched["flow"]["grid"] = json!([4096, 8]);
    assert!(parse(&stretched.to_string()).is_ok());
}

#[test]
fn photon_counts_have_a_range_and_one_photon_is_in_it() {
    assert!(complaint("/render/photons", json!(1e12)).contains("render.photons"));
    let mut one = good();
    one["render"]["photons"] = json!(1);
    assert!(parse(&one.to_string()).is_ok());
}

#[test]
fn flow_settings_out_of_range_are_named() {
    let mut bad = vec![
        ("/flow/gamma", json!(-0.1), "flow.gamma"),
        ("/flow/gamma", json!(1.1), "flow.gamma"),
        ("/flow/alpha", json!(0), "flow.alpha"),
        ("/flow/alpha", json!(1e-30), "flow.alpha"),
        ("/flow/alpha", json!(1e30), "flow.alpha"),
        ("/flow/fade", json!({ "type": "paper", "tau": -0.5 }), "flow.fade"),
        ("/flow/fade", json!({ "type": "paper", "tau": 1.5 }), "flow.fade"),
    ];
    for rho in [json!(0), json!(-1)] {
        bad.push(("/flow", json!({ "rho": rho }), "flow.rho"));
    }
    for (pointer, value, name) in bad {
        let message = complaint(pointer, value.clone());
        assert!(message.contains(name), "{value}: {message}");
    }
}

#[test]
fn frame_ranges_and_rates_that_mean_nothing_are_refused() {
    for list in ["9-1", "", "1-1000000000"] {
        assert!(complaint("/output", json!({ "frames": list })).contains("output.frames"));
    }
    for fps in [json!([0, 1]), json!([1, 0])] {
        assert!(complaint("/output/fps", fps).contains("output.fps"));
    }
    for frame in [json!(1), json!(i32::MIN), json!(i32::MAX)] {
        assert!(complaint("/keys/1/frame", frame).contains("keys[1].frame"));
    }
    assert!(complaint("/keys", json!([])).contains("keys"));
}

/// A scene of two lamps, a wall and a glass, a value on each line.
const LINES: &str = r#"{ "lightloom": 1, "keys": [ { "frame": 1, "shows": "physical_caustic" } ],
  "scene": {
    "lights": [
      { "type": "spot" },
      { "type": "point",
        "watts": 5,
        "position": [0, 1, 0] }
    ],
    "meshes": [ { "name": "a", "file": "a.obj", "material": { "type": "glass",
        "ior": 1.5 } } ]
  },
  "constraints": [
    { "type": "wall",
      "thickness": 0.1,
      "points": [[0, 0], [1, 1]] }
  ] }"#;

#[test]
fn a_value_of_the_wrong_type_is_named_with_its_line_as_the_command_line_does() {
    let opened = |text: &str| ProjectFile::parse(text.as_bytes(), Path::new("shot.json")).map(|_| ());
    opened(LINES).unwrap();
    for (good, bad, place) in [
        ("\"watts\": 5", "\"watts\": \"much\"", "scene.lights[1].watts: invalid type: string \"much\""),
        ("[0, 1, 0]", "[0, \"up\", 0]", "scene.lights[1].position: invalid type"),
        ("\"ior\": 1.5", "\"ior\": true", "scene.meshes[0].material.ior: invalid type"),
        ("\"thickness\": 0.1", "\"thickness\": []", "constraints[0].thickness: invalid type"),
        ("[[0, 0]", "[[0, 0, 0]", "constraints[0].points: invalid length"),
        ("\"spot\" }", "\"spot\" ", "line 5, column"),
        ("\"watts\": 5", "\"watts\": 5, 6", "line 6, column"),
    ] {
        let text = LINES.replacen(good, bad, 1);
        assert_ne!(text, LINES);
        let message = opened(&text).unwrap_err().to_string();
        let strict = Project::parse(text.as_bytes(), Path::new("shot.json")).unwrap_err().to_string();
        assert_eq!(message, strict);
        assert!(message.contains(place) && message.contains("line ") && !message.contains('?'), "{message}");
        // Beside an unknown member lines are those of another text; the field is told all the same.
        let strange = text.replacen("\"lightloom\": 1,", "\"lightloom\": 1, \"strange\": 1,", 1);
        let message = opened(&strange).unwrap_err().to_string();
        let is_json = serde_json::from_str::<Value>(&text).is_ok();
        assert!(message.contains(place) || !is_json, "{message}");
    }
}

#[test]
fn unknown_and_repeated_keys_are_named() {
    let message = complaint("/flow", json!({ "gama": 0.5 }));
    assert!(message.contains("gama") && message.contains("flow"), "{message}");
    let twice = good().to_string().replacen("\"seed\":7", "\"seed\":7,\"seed\":8", 1);
    assert!(parse(&twice).unwrap_err().to_string().contains("seed"));
}

#[test]
fn a_file_of_a_later_version_is_named_as_such_whatever_it_holds() {
    let message = parse(r#"{ "lightloom": 2, "new_thing": 3 }"#).unwrap_err().to_string();
    assert!(message.contains("version 2") && message.contains("newer"), "{message}");
}

#[test]
fn an_output_name_without_frame_number_is_refused() {
    assert!(complaint("/output/name", json!("shot")).contains("output.name"));
    assert!(complaint("/output/name", json!("../shot.####")).contains("output.name"));
}

#[test]
fn a_pattern_of_numbered_files_is_told_to_be_no_file_unless_it_is_one() {
    let root = tempfile::tempdir().unwrap();
    let assets = AssetFolder::new(&root.path().join("shot.json"), false).unwrap();
    for path in ["plate.####.exr", "plate.%04d.exr", "plate.%d.exr", "plate.##.exr"] {
        let message = assets.resolve(path, "render.plate.file").unwrap_err().to_string();
        assert!(message.contains("sequence") && message.starts_with("render.plate.file: "), "{message}");
        std::fs::write(root.path().join(path), b"x").unwrap();
        assert!(assets.resolve(path, "render.plate.file").is_ok(), "{path}");
    }
    for path in ["plate.0001.exr", "100%.exr", "take#2.exr"] {
        let message = assets.resolve(path, "render.plate.file").unwrap_err().to_string();
        assert!(message.contains("is it there"), "{message}");
    }
}

#[test]
fn asset_paths_stay_in_the_projects_folder() {
    let root = tempfile::tempdir().unwrap();
    let folder = root.path().join("deep/project");
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("c.png"), b"x").unwrap();
    std::fs::write(root.path().join("outside.png"), b"x").unwrap();
    let fence = AssetFolder::new(&folder.join("shot.json"), false).unwrap();
    assert!(fence.resolve("c.png", "keys[0]").is_ok());
    let long = "a/".repeat(2500);
    let refused = [
        "",
        "../../../etc/passwd",
        "../../outside.png",
        "/etc/passwd",
        "\\\\server\\c.png",
        "C:\\c.png",
        "c\0.png",
        &long,
    ];
    for path in refused {
        let message = fence.resolve(path, "keys[0].shows.image.file").unwrap_err().to_string();
        assert!(message.starts_with("keys[0].shows.image.file: "), "{path:?}: {message}");
        assert!(message.len() < 400, "{message}");
    }
    let free = AssetFolder::new(&folder.join("shot.json"), true).unwrap();
    assert!(free.resolve("../../outside.png", "keys[0]").is_ok());
}

#[cfg(unix)]
#[test]
fn links_that_lead_out_of_the_folder_or_in_circles_are_refused() {
    let root = tempfile::tempdir().unwrap();
    let folder = root.path().join("project");
    std::fs::create_dir(&folder).unwrap();
    std::fs::write(root.path().join("outside.png"), b"x").unwrap();
    std::os::unix::fs::symlink("../outside.png", folder.join("out.png")).unwrap();
    std::os::unix::fs::symlink("loop.png", folder.join("loop.png")).unwrap();
    let fence = AssetFolder::new(&folder.join("shot.json"), false).unwrap();
    assert!(fence.resolve("out.png", "keys[0]").unwrap_err().to_string().contains("leads out"));
    assert!(fence.resolve("loop.png", "keys[0]").is_err());
}

#[test]
fn projects_beside_an_assets_folder_may_use_it() {
    let root = tempfile::tempdir().unwrap();
    std::fs::create_dir(root.path().join("assets")).unwrap();
    std::fs::create_dir(root.path().join("projects")).unwrap();
    std::fs::write(root.path().join("assets/c.png"), b"x").unwrap();
    let fence = AssetFolder::new(&root.path().join("projects/shot.json"), false).unwrap();
    assert!(fence.resolve("../assets/c.png", "keys[0]").is_ok());
}

#[test]
fn every_field_of_the_schema_says_what_it_is() {
    let schema = Project::json_schema();
    let mut nameless = Vec::new();
    let mut look = |kind: &str, object: &Value| {
        for (name, field) in object["properties"].as_object().into_iter().flatten() {
            let constant = field.get("const").is_some() || field.get("$ref").is_some();
            if field.get("description").is_none() && !constant {
                nameless.push(format!("{kind}.{name}"));
            }
        }
    };
    look("Project", &schema);
    for (kind, object) in schema["$defs"].as_object().unwrap() {
        look(kind, object);
    }
    assert!(nameless.is_empty(), "{nameless:?}");
}

proptest! {
    #[test]
    fn text_of_any_kind_is_read_or_refused_but_never_panics(text in "\\PC*") {
        let _ = parse(&text);
    }

    #[test]
    fn any_numbers_are_read_or_refused_but_never_saved_when_bad(gamma: f32, alpha: f32, watts: f32) {
        let mut project = parse(&good().to_string()).unwrap();
        (project.flow.gamma, project.flow.alpha, project.plane.watts) = (gamma, alpha, watts);
        if let Ok(text) = project.to_json() {
            prop_assert_eq!(parse(&text).unwrap(), project);
        }
    }
}
