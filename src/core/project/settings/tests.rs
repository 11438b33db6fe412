//! Checks, defaults, schema and README say of every setting what its constant says.
#![allow(clippy::unwrap_used)]

use std::collections::BTreeSet;
use std::path::Path;

use serde_json::{Value, json};

use super::settings;
use crate::project::Project;
use crate::setting::{ANY, Kind, Setting};

/// A project with every part in it, and nothing said that has a default.
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
        "caustics": [{ "name": "NAME" }],
        "keys": [
            { "frame": 1, "shows": image, "caustics": { "NAME": { "shows": image } } },
        ],
        "constraints": [
            { "type": "directed_line", "points": points, "span": span },
            { "type": "wall", "points": points },
        ],
        "flow": { "fade": { "type": "smooth" }, "turbulence": {} },
        "render": { "plate": { "file": "a.png" } },
    });
    full(given)
}

/// The project with all defaults written out.
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

/// The first of the projects that has this setting, and where.
fn home(setting: &Setting) -> (Value, String) {
    let mut projects = [everything(), otherwise()].into_iter();
    let found = projects.find_map(|project| pointer(&project, setting.place).map(|at| (project, at)));
    found.unwrap_or_else(|| panic!("{} is no place of a project", setting.place))
}

/// Whether a project with this value is accepted.
fn accepts(setting: &Setting, value: Value) -> Result<(), String> {
    let (mut project, at) = home(setting);
    // Its two ends keep each other at a distance; far apart, neither is in the other's way.
    if setting.place.starts_with("flow.fade.") && project["flow"]["fade"]["type"] == "smooth" {
        project["flow"]["fade"]["start"] = json!(0.0);
        project["flow"]["fade"]["end"] = json!(1.0);
    }
    // The finest grid leaves memory for one step.
    if setting.place == "flow.grid" {
        project["flow"]["steps"] = json!(1);
    }
    if setting.place == "constraints[].span.from" || setting.place == "constraints[].span.to" {
        let span = &mut project["constraints"][0]["span"];
        (span["from"], span["to"]) = (json!(-1_000_000), json!(1_000_000));
    }
    *project.pointer_mut(&at).unwrap() = value;
    let project: Project = serde_json::from_value(project).map_err(|error| error.to_string())?;
    project.check().map_err(|error| error.to_string())
}

/// The number of components; that of a picture's centre does not follow from its default.
fn components(setting: &Setting) -> usize {
    if setting.default.is_empty() { 2 } else { setting.default.len() }
}

/// `number` as it stands in a project.
fn written(setting: &Setting, number: f64) -> Value {
    match setting.kind {
        Kind::Whole if setting.default.len() < 2 => json!(number as i64),
        Kind::Whole => json!([number as i64, number as i64]),
        Kind::Vector | Kind::Colour => {
            let mut value = vec![number; components(setting)];
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
fn both_ends_of_every_range_are_accepted() {
    for setting in numbers() {
        let [low, high] = setting.range;
        let low = if setting.above { f64::from((low as f32).next_up()) } else { low };
        for end in [low, high] {
            assert_eq!(accepts(setting, written(setting, end)), Ok(()), "{} at {end}", setting.place);
        }
    }
}

#[test]
fn what_lies_just_beyond_a_range_is_refused_by_its_place() {
    for setting in numbers() {
        let [low, high] = setting.range.map(|end| end as f32);
        let beyond = match setting.kind {
            Kind::Whole => [setting.range[0] - 1.0, setting.range[1] + 1.0],
            _ if setting.above => [low.into(), high.next_up().into()],
            _ if setting.range == ANY => [-1e39, 1e39],
            _ => [low.next_down().into(), high.next_up().into()],
        };
        for value in beyond {
            let mut written = written(setting, value);
            if let Some(first) = written.as_array_mut().and_then(|all| all.first_mut()) {
                *first = if setting.kind == Kind::Whole { json!(value as i64) } else { json!(value) };
            }
            let refused = accepts(setting, written);
            let name = setting.name().trim_end_matches("[]");
            // What is no number of the type is refused while it is read, which tells no place here.
            let is_named = |error: &String| error.contains(name) || error.contains("invalid value");
            assert!(refused.as_ref().is_err_and(is_named), "{} at {value}: {refused:?}", setting.place);
        }
    }
}

#[test]
fn every_default_is_that_of_a_project_that_says_nothing() {
    // Parts of the project above, values without a default, and those that are only written where they say something.
    let given = ["keys[].frame", "keys[].shows", "scene.lights[]", "scene.meshes[].material", "flow.fade"];
    let given = |place: &str| {
        let is_rare = ["constraints[].locked", "constraints[].group"].contains(&place);
        given.contains(&place) || is_rare || place.starts_with("constraints[].span")
    };
    for setting in settings().filter(|setting| !given(setting.place)) {
        let (project, at) = home_if_written(setting);
        let Some(value) = project.pointer(&at) else { continue };
        let same = match setting.kind {
            Kind::Text | Kind::Part => true,
            Kind::Switch => *value == json!(setting.is_on()),
            Kind::Choice => {
                let first = setting.choices[0].value;
                let written = value.to_string();
                first.is_empty() || value.as_str() == Some(first) || written == first
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
        assert!(same, "{}: the project has {value}, the constant {:?}", setting.place, setting.default);
    }
}

/// As [`home`]; an empty pointer where the value is absent, as its default is.
fn home_if_written(setting: &Setting) -> (Value, String) {
    match setting.place {
        "caustics[].light" | "caustics[].mesh" => (Value::Null, "/".to_owned()),
        _ => home(setting),
    }
}

#[test]
fn every_choice_is_read() {
    for setting in settings().filter(|setting| setting.kind == Kind::Choice) {
        for choice in setting.choices.iter().filter(|choice| !choice.value.is_empty()) {
            let value = match (setting.place, choice.value) {
                ("output.png_bits", bits) => json!(bits.parse::<u32>().unwrap()),
                ("flow.fade" | "scene.lights[]" | "scene.meshes[].material", kind) => json!({ "type": kind }),
                ("keys[].shows", "image" | "points") => json!({ choice.value: { "file": "a" } }),
                (_, name) => json!(name),
            };
            // "given" fits no project with pictures, but it is read.
            let (mut project, at) = home(setting);
            *project.pointer_mut(&at).unwrap() = value;
            let read: Result<Project, _> = serde_json::from_value(project);
            assert!(read.is_ok(), "{}: {}", setting.place, choice.value);
        }
    }
}

/// All parts of the schema that may describe a place, seen from those in `parts`.
fn described<'a>(schema: &'a Value, parts: Vec<&'a Value>, place: &str) -> Vec<&'a Value> {
    let forms = |part: &'a Value| {
        let part = match part.get("$ref").and_then(Value::as_str) {
            Some(name) => schema.pointer(name.trim_start_matches('#')).unwrap(),
            None => part,
        };
        let variants = ["oneOf", "anyOf"].into_iter().filter_map(move |several| part[several].as_array());
        [part].into_iter().chain(variants.flatten())
    };
    // A variant may be a reference in its turn.
    let open = |parts: Vec<&'a Value>| -> Vec<&'a Value> {
        parts.into_iter().flat_map(forms).flat_map(forms).flat_map(forms).collect()
    };
    let (head, rest) = place.split_once('.').map_or((place, None), |(head, rest)| (head, Some(rest)));
    let (name, is_list) = head.split_once('[').map_or((head, false), |(name, _)| (name, true));
    let member = |part: &'a Value| part["properties"].get(name).or(part.get("additionalProperties"));
    let mut found: Vec<&Value> = open(parts).into_iter().filter_map(member).collect();
    if is_list {
        found = open(found).into_iter().filter_map(|part| part.get("items")).collect();
    }
    match rest {
        Some(rest) => described(schema, found, rest),
        None => found,
    }
}

#[test]
fn the_schema_says_range_default_and_help_of_every_setting() {
    let schema = Project::json_schema();
    for setting in settings() {
        let parts = described(&schema, vec![&schema], setting.place);
        assert!(!parts.is_empty(), "{}", setting.place);
        let is_element = setting.place.ends_with(']');
        let says_help =
            |part: &&Value| part["description"].as_str().is_some_and(|text| text.starts_with(setting.help));
        assert!(is_element || parts.iter().any(says_help), "{}: {parts:?}", setting.place);
        // The grid has a type of its own: a number or two.
        if numbers().all(|number| number != setting) || setting.place == "flow.grid" || setting.range == ANY {
            continue;
        }
        let says_range = |part: &&Value| {
            let number = part.get("items").unwrap_or(part);
            let low = &number[if setting.above { "exclusiveMinimum" } else { "minimum" }];
            [low.as_f64(), number["maximum"].as_f64()] == setting.range.map(Some)
        };
        let says_default = |part: &&Value| match (&part["default"], setting.default) {
            (_, []) => true,
            (Value::Array(values), several) => {
                values.iter().map(Value::as_f64).eq(several.iter().copied().map(Some))
            }
            (value, [one]) => value.as_f64() == Some(*one),
            _ => false,
        };
        let says = |part: &&Value| says_range(part) && (is_element || says_default(part));
        assert!(parts.iter().any(says), "{}: {parts:?}", setting.place);
    }
}

/// The places of all values of a part of the schema.
fn places(schema: &Value, part: &Value, place: &str, found: &mut BTreeSet<String>) {
    let part = match part.get("$ref").and_then(Value::as_str) {
        Some(name) => schema.pointer(name.trim_start_matches('#')).unwrap(),
        None => part,
    };
    for (name, inner) in
        part["properties"].as_object().into_iter().flatten().filter(|(name, _)| *name != "type")
    {
        let place = format!("{place}.{name}");
        places(schema, inner, &place, found);
        found.insert(place);
    }
    for several in ["oneOf", "anyOf"] {
        part[several].as_array().into_iter().flatten().for_each(|inner| places(schema, inner, place, found));
    }
}

#[test]
fn every_value_of_flow_picture_files_and_surroundings_is_a_setting() {
    let schema = Project::json_schema();
    let mut wanted = BTreeSet::new();
    for part in ["flow", "render", "output", "plane"] {
        places(&schema, &schema["properties"][part], part, &mut wanted);
    }
    for part in ["camera", "receiver", "environment"] {
        let scene = &schema["$defs"]["SceneDesc"]["properties"];
        places(&schema, &scene[part], &format!("scene.{part}"), &mut wanted);
    }
    let all: BTreeSet<&str> = settings().map(|setting| setting.place).collect();
    // The part has no value of its own, only what is in it.
    let missing: Vec<_> =
        wanted.iter().filter(|place| !all.contains(place.as_str()) && *place != "render.view").collect();
    assert!(wanted.len() > 40 && missing.is_empty(), "{missing:?} of {wanted:?}");
}

#[test]
fn every_setting_and_every_choice_says_what_it_does() {
    for setting in settings() {
        assert!(setting.help.len() > 10, "{}", setting.place);
        assert!(setting.choices.iter().all(|choice| choice.help.len() > 5), "{}", setting.place);
    }
}

/// The README's table.
fn table() -> String {
    let mut table = "| setting | meaning | range | default | unit |\n|---|---|---|---|---|\n".to_owned();
    for setting in settings() {
        let named = setting.choices.iter().filter(|choice| !choice.value.is_empty());
        let choices: Vec<_> = named.map(|choice| format!("`{}`: {}", choice.value, choice.help)).collect();
        let choices = if choices.is_empty() { String::new() } else { format!(" {}.", choices.join("; ")) };
        table += &format!(
            "| `{}` | {}{choices} | {} | {} | {} |\n",
            setting.place,
            setting.help,
            setting.range_in_words(),
            setting.default_in_words(),
            setting.unit
        );
    }
    table
}

/// With `UPDATE_README=1` the table is written anew.
#[test]
fn the_readme_has_the_table_of_settings() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../README.md");
    let readme = std::fs::read_to_string(&path).unwrap();
    let (before, rest) = readme.split_once("<!-- settings -->\n").unwrap();
    let (now, after) = rest.split_once("<!-- end of settings -->\n").unwrap();
    if std::env::var_os("UPDATE_README").is_some() {
        let new = format!("{before}<!-- settings -->\n{}<!-- end of settings -->\n{after}", table());
        std::fs::write(&path, new).unwrap();
    } else {
        let help = "UPDATE_README=1 cargo test --release -p lightloom_core readme";
        assert_eq!(now, table(), "to write it anew: {help}");
    }
}
