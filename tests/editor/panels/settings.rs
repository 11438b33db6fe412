//! Every setting says what the core says: its place, its range, its default.

use std::collections::BTreeSet;

use lightloom::editor::panels::setting::{Kind, Setting};
use lightloom::editor::panels::settings;
use lightloom_core::project::Project;
use serde_json::{Value, json};

/// A project with everything in it, nothing said that need not be said.
fn everything() -> Value {
    let image = json!({ "image": { "file": "a.png" } });
    let materials = ["diffuse", "mirror", "glass"];
    let meshes = materials.map(|kind| json!({ "name": kind, "file": "a.obj", "material": { "type": kind } }));
    let lights = ["point", "spot", "directional", "rectangle", "sphere"].map(|kind| json!({ "type": kind }));
    let points = json!([[0.2, 0.2], [0.8, 0.8]]);
    let span = json!({ "from": 1, "to": 20 });
    let given = json!({
        "lightloom": 1,
        "scene": { "meshes": meshes, "lights": lights },
        "caustics": [{ "name": "c" }],
        "keys": [
            { "frame": 1, "shows": image, "caustics": { "c": { "shows": image } } },
        ],
        "constraints": [
            { "type": "directed_line", "points": points, "span": span },
            { "type": "wall", "points": points },
        ],
        "flow": { "fade": { "type": "smooth" }, "turbulence": {} },
    });
    full(given)
}

/// With all that has a default written out.
fn full(given: Value) -> Value {
    let project: Project = serde_json::from_value(given).unwrap();
    project.check().unwrap();
    serde_json::to_value(project).unwrap()
}

/// The same with the other kind of fade and of target.
fn otherwise() -> Value {
    let mut project = everything();
    project["flow"]["fade"] = json!({ "type": "paper" });
    project["flow"]["turbulence"] = json!({ "grids": [30, 60], "weights": [1.0, 1.0] });
    project["keys"][0]["shows"] = json!({ "points": { "file": "a.csv" } });
    full(project)
}

/// The JSON pointer of a place; none where this project has none.
fn pointer(value: &Value, place: &str) -> Option<String> {
    let (head, rest) = place.split_once('.').map_or((place, None), |(head, rest)| (head, Some(rest)));
    let (name, element) = head.split_once('[').map_or((head, None), |(name, element)| (name, Some(element)));
    let inner = value.get(name)?;
    let on = |value: &Value, so_far: String| match rest {
        None => Some(so_far),
        Some(rest) => pointer(value, rest).map(|more| so_far + &more),
    };
    let Some(element) = element else { return on(inner, format!("/{name}")) };
    let kind = element.trim_end_matches(']');
    let mut elements = inner.as_array()?.iter().enumerate();
    elements.find_map(|(i, element)| {
        let fits = kind.is_empty() || element["type"] == kind;
        fits.then(|| on(element, format!("/{name}/{i}"))).flatten()
    })
}

/// The first of the projects that has this place, and where.
fn home(setting: &Setting) -> (Value, String) {
    let mut projects = [everything(), otherwise()].into_iter();
    let found = projects.find_map(|project| pointer(&project, setting.place).map(|at| (project, at)));
    found.unwrap_or_else(|| panic!("{} is no place of a project", setting.place))
}

/// Whether the core takes the project with this value.
fn takes(setting: &Setting, value: Value) -> Result<(), String> {
    let (mut project, at) = home(setting);
    // Its two ends keep each other at a distance; far apart, neither is in the other's way.
    if setting.place.starts_with("flow.fade.") && project["flow"]["fade"]["type"] == "smooth" {
        project["flow"]["fade"]["start"] = json!(0.0);
        project["flow"]["fade"]["end"] = json!(1.0);
    }
    if setting.place == "constraints[].span.from" || setting.place == "constraints[].span.to" {
        let span = &mut project["constraints"][0]["span"];
        (span["from"], span["to"]) = (json!(-1_000_000), json!(1_000_000));
    }
    *project.pointer_mut(&at).unwrap() = value;
    let project: Project = serde_json::from_value(project).map_err(|error| error.to_string())?;
    project.check().map_err(|error| error.to_string())
}

/// `number` as this setting would have it in a project.
fn written(setting: &Setting, number: f64) -> Value {
    match setting.kind {
        Kind::Whole if setting.default.len() < 2 => json!(number as i64),
        Kind::Whole => json!([number as i64, number as i64]),
        Kind::Vector | Kind::Colour => {
            // Two numbers where the default is none: the middle of a picture.
            let mut value = vec![number; if setting.default.is_empty() { 2 } else { setting.default.len() }];
            // A camera that looks from itself or along its own upright sees nothing.
            for (i, component) in value.iter_mut().enumerate() {
                if i > 0 && setting.range[1] > 1000.0 && setting.range[0] < 0.0 {
                    *component = number / (1.0 + i as f64);
                }
            }
            json!(value)
        }
        _ => json!(number),
    }
}

fn numbers() -> impl Iterator<Item = &'static Setting> {
    settings().filter(|s| matches!(s.kind, Kind::Real | Kind::Whole | Kind::Vector | Kind::Colour))
}

#[test]
fn the_core_takes_both_ends_of_every_range() {
    for setting in numbers() {
        let [low, high] = setting.range;
        let low = if setting.above { f64::from((low as f32).next_up()) } else { low };
        for end in [low, high] {
            assert_eq!(takes(setting, written(setting, end)), Ok(()), "{} at {end}", setting.place);
        }
    }
}

#[test]
fn the_core_refuses_what_lies_just_beyond_a_range() {
    for setting in numbers() {
        let [low, high] = setting.range.map(|end| end as f32);
        let beyond = match setting.kind {
            Kind::Whole => [setting.range[0] - 1.0, setting.range[1] + 1.0],
            _ if setting.above => [low.into(), high.next_up().into()],
            _ => [low.next_down().into(), high.next_up().into()],
        };
        for value in beyond {
            // A direction may have any length.
            if setting.place.ends_with("direction") || setting.place.ends_with("camera.up") {
                continue;
            }
            let mut written = written(setting, value);
            if let Some(first) = written.as_array_mut().and_then(|all| all.first_mut()) {
                *first = if setting.kind == Kind::Whole { json!(value as i64) } else { json!(value) };
            }
            assert!(takes(setting, written).is_err(), "{} at {value}", setting.place);
        }
    }
}

#[test]
fn every_default_is_the_core_s_own() {
    for setting in settings() {
        // What the artist must say has no default, and a part none of its own.
        let must = ["keys[].frame", "keys[].shows", "scene.lights[]", "scene.meshes[].material", "flow.fade"];
        // Only written where it is true.
        let quiet = setting.place == "constraints[].locked";
        let spans = setting.place.contains(".span");
        let part = matches!(setting.kind, Kind::Text | Kind::Part);
        if must.contains(&setting.place) || part || quiet || (spans && setting.default.is_empty()) {
            continue;
        }
        let (project, at) = home(setting);
        let value = project.pointer(&at).unwrap();
        let same = match setting.kind {
            Kind::Switch => value.as_bool() == Some(setting.default == [1.0]),
            Kind::Choice if setting.options[0].value.is_empty() => true,
            Kind::Choice => {
                let first = setting.options[0].value;
                *value == json!(first) || value.as_u64().map(|n| n.to_string()).as_deref() == Some(first)
            }
            _ => {
                let numbers: Vec<f32> = match value {
                    Value::Array(values) => values.iter().map(|v| v.as_f64().unwrap() as f32).collect(),
                    Value::Null => Vec::new(),
                    value => vec![value.as_f64().unwrap() as f32],
                };
                numbers == setting.default.iter().map(|v| *v as f32).collect::<Vec<_>>()
            }
        };
        assert!(same, "{}: the core has {value}, the window {:?}", setting.place, setting.default);
    }
}

#[test]
fn every_choice_is_one_of_the_core_s() {
    for setting in settings().filter(|setting| setting.kind == Kind::Choice) {
        for choice in setting.options.iter().filter(|choice| !choice.value.is_empty()) {
            let value = match setting.place {
                "keys[].shows" | "method" | "matching" => json!(choice.value),
                "output.png_bits" => json!(choice.value.parse::<u32>().unwrap()),
                "flow.fade" | "scene.lights[]" | "scene.meshes[].material" => json!({ "type": choice.value }),
                _ => json!(choice.value),
            };
            // "given" fits no project with pictures, but it is read.
            let (mut project, at) = home(setting);
            *project.pointer_mut(&at).unwrap() = value;
            let read: Result<Project, _> = serde_json::from_value(project);
            assert!(read.is_ok(), "{}: {}", setting.place, choice.value);
        }
    }
}

/// The places of all values of a part of the schema.
fn places(schema: &Value, part: &Value, place: &str, found: &mut BTreeSet<String>) {
    let part = match part.get("$ref").and_then(Value::as_str) {
        Some(name) => schema.pointer(name.trim_start_matches('#')).unwrap(),
        None => part,
    };
    for (name, inner) in part["properties"].as_object().into_iter().flatten() {
        if name != "type" {
            let place = format!("{place}.{name}");
            places(schema, inner, &place, found);
            found.insert(place);
        }
    }
    for several in ["oneOf", "anyOf", "allOf"] {
        part[several].as_array().into_iter().flatten().for_each(|inner| places(schema, inner, place, found));
    }
}

#[test]
fn every_value_of_flow_turbulence_picture_and_files_stands_in_a_panel() {
    let schema = Project::json_schema();
    let mut wanted = BTreeSet::new();
    for part in ["flow", "render", "output", "plane"] {
        places(&schema, &schema["properties"][part], part, &mut wanted);
    }
    let shown: BTreeSet<&str> = settings().map(|setting| setting.place).collect();
    // The part has no widget of its own, only what is in it.
    let missing: Vec<_> =
        wanted.iter().filter(|place| !shown.contains(place.as_str()) && *place != "render.view").collect();
    assert!(wanted.len() > 30 && missing.is_empty(), "{missing:?} of {wanted:?}");
}

#[test]
fn every_setting_says_what_it_does() {
    for setting in settings() {
        assert!(!setting.name.is_empty(), "{}", setting.place);
        let plain = setting.place == "keys[].caustics.c.shows";
        assert!(plain || setting.help.len() > 10, "{}: no word on what it does", setting.place);
    }
}
