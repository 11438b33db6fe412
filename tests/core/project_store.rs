//! The project file as the editor keeps it: unchanged it is the same bytes, changed it keeps what the program does not know.

use std::path::{Path, PathBuf};

use lightloom_core::constraint::{Constraint, DirectedLine, Span, Wall};
use lightloom_core::flow::fade::Fade;
use lightloom_core::project::{Ease, Project, ProjectFile, Shows};
use lightloom_core::scene::LightDesc;
use proptest::prelude::*;
use serde_json::Value;

/// A project with every kind of object in it; each object holds a member `x_…` that no version knows.
pub(crate) const STRANGE: &str = r#"{
  "x_root": { "kept": [1.50, 1e-3, "ä\u00e4", { "deep": null }] },
  "lightloom": 1,
  "name": "Strange",
  "scene": {
    "x_scene": 1,
    "meshes": [
      { "name": "glass", "file": "glass.obj", "x_mesh": "glass", "material": { "type": "glass", "x_glass": 2, "ior": 1.50 } },
      { "name": "pool", "file": "pool.obj", "transform": { "x_turn": 3, "scale": 2 }, "x_mesh": "pool" }
    ],
    "lights": [
      { "type": "spot", "name": "key", "x_light": "key", "watts": 12, "colour": [1, 0.50, 0] },
      { "type": "sphere", "name": "fill", "x_light": "fill" }
    ],
    "camera": { "x_camera": true, "position": [0, 1, 2] },
    "receiver": { "x_receiver": [] },
    "environment": { "x_sky": {} }
  },
  "caustics": [{ "name": "red", "light": "key", "x_caustic": "red" }, { "name": "blue", "x_caustic": "blue" }],
  "keys": [
    { "frame": 1, "shows": "physical_caustic", "x_key": 1 },
    {
      "frame": 25, "x_key": 25,
      "shows": { "image": { "file": "c.png", "x_image": 0, "placement": { "x_place": 0, "width": 0.40 } } },
      "caustics": { "red": { "x_red": 1, "brightness": 2, "shows": { "points": { "file": "p.csv", "x_points": 1 } } } }
    },
    { "frame": 50, "shows": "physical_caustic", "ease": "linear", "x_key": 50 }
  ],
  "constraints": [
    { "type": "wall", "name": "left", "x_mark": "left", "points": [[0.10, 0.2], [0.3, 0.40]], "span": { "from": 1, "to": 9, "x_span": 0 } },
    { "type": "directed_line", "name": "right", "points": [[0, 0], [1, 1]], "x_mark": "right", "weight": 2 },
    { "type": "wall", "name": "end", "points": [[0.5, 0.5], [0.6, 0.5]], "x_mark": "end" }
  ],
  "flow": { "x_flow": 0, "gamma": 0.250, "fade": { "type": "smooth", "x_fade": 0 }, "turbulence": { "x_swirl": 0, "grids": [30, 60] } },
  "render": { "view": { "exposure": -1, "x_view": 0 }, "x_render": 0 },
  "output": { "x_output": 0, "fps": [24, 1] }
}
"#;

pub(crate) fn read(text: &str) -> (ProjectFile, Vec<String>) {
    ProjectFile::parse(text.as_bytes(), Path::new("shot.json")).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

/// The text after a change, after checking that it gives the changed project again.
pub(crate) fn after(text: &str, change: impl FnOnce(&mut Project)) -> String {
    let (file, _) = read(text);
    let mut project = file.project().clone();
    change(&mut project);
    let written = file.text_of(&project).unwrap();
    assert_eq!(*read(&written).0.project(), project, "{written}");
    written
}

fn examples() -> Vec<PathBuf> {
    let folder = crate::root().join("projects");
    let paths = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    paths.filter(|path| path.extension().is_some_and(|e| e == "json")).collect()
}

/// The lines of `new` that are not in `old`, in order.
fn new_lines<'a>(old: &str, new: &'a str) -> Vec<&'a str> {
    new.lines().filter(|line| !old.lines().any(|other| other == *line)).map(str::trim).collect()
}

/// All members whose names begin with `x_`, with the text of their values.
fn strangers(value: &Value, found: &mut Vec<String>) {
    match value {
        Value::Object(members) => {
            for (name, value) in members {
                if name.starts_with("x_") {
                    found.push(format!("{name}={value}"));
                }
                strangers(value, found);
            }
        }
        Value::Array(items) => items.iter().for_each(|item| strangers(item, found)),
        _ => {}
    }
}

pub(crate) fn strangers_of(text: &str) -> Vec<String> {
    let mut found = Vec::new();
    strangers(&serde_json::from_str(text).unwrap(), &mut found);
    found.sort();
    found
}

#[test]
fn opening_and_saving_gives_the_same_bytes() {
    assert!(examples().len() >= 7);
    for path in examples() {
        let before = std::fs::read(&path).unwrap();
        let (file, notes) = ProjectFile::open(&path).unwrap();
        assert_eq!(file.text_of(file.project()).unwrap().as_bytes(), before, "{}", path.display());
        assert!(notes.is_empty(), "{notes:?}");
    }
    let crlf = STRANGE.replace('\n', "\r\n");
    for text in [STRANGE, &format!("\u{feff}{STRANGE}\n\n"), &crlf, STRANGE.trim_end()] {
        let (file, _) = read(text);
        assert_eq!(file.text_of(file.project()).unwrap(), text);
    }
}

#[test]
fn what_is_unknown_is_named_by_its_place_once() {
    let (_, notes) = read(STRANGE);
    let count = strangers_of(STRANGE).len();
    assert_eq!(notes.len(), count, "{notes:#?}");
    for place in [
        "x_root",
        "scene.meshes[0].material.x_glass",
        "constraints[0].span.x_span",
        "keys[1].caustics.red.shows.points.x_points",
        "flow.fade.x_fade",
    ] {
        let note = format!("{place} is unknown to this program; it is kept and not used");
        assert!(notes.contains(&note), "{place}: {notes:#?}");
    }
}

#[test]
fn the_command_line_takes_an_unknown_member_for_a_mistake() {
    let message = Project::parse(STRANGE.as_bytes(), Path::new("shot.json")).unwrap_err().to_string();
    assert!(message.contains("x_root"), "{message}");
}

#[test]
fn a_wrong_value_is_refused_also_beside_unknown_members() {
    for (good, bad, place) in [
        ("\"gamma\": 0.250", "\"gamma\": \"much\"", "flow.gamma"),
        ("\"gamma\": 0.250", "\"gamma\": 7", "flow.gamma"),
        ("\"type\": \"spot\"", "\"type\": \"candle\"", "scene.lights[0]"),
        ("\"weight\": 2", "\"weight\": 2, \"weight\": 3", "constraints[1]"),
    ] {
        let text = STRANGE.replacen(good, bad, 1);
        let message = ProjectFile::parse(text.as_bytes(), Path::new("shot.json")).unwrap_err().to_string();
        assert!(message.contains(place) && message.contains("shot.json"), "{bad}: {message}");
    }
}

#[test]
fn one_changed_value_changes_one_line() {
    for path in examples() {
        let before = std::fs::read_to_string(&path).unwrap();
        let written = after(&before, |project| project.flow.gamma = 0.75);
        let changed = new_lines(&before, &written);
        assert!(matches!(changed[..], [line] if line.contains("\"gamma\": 0.75")), "{changed:#?}");
        assert_eq!(before.lines().count(), written.lines().count(), "{}", path.display());
    }
}

#[test]
fn numbers_are_written_as_people_write_them() {
    let written = after(STRANGE, |project| {
        project.flow.gamma = 0.02;
        project.render.radius = Some(0.1);
    });
    assert!(written.contains("\"gamma\": 0.02,") && written.contains("\"radius\": 0.1,"), "{written}");
}

#[test]
fn a_default_that_nobody_wrote_is_written_only_when_it_changes() {
    let text = "{ \"lightloom\": 1, \"keys\": [{ \"frame\": 1, \"shows\": { \"image\": { \"file\": \"c.png\" } } }] }";
    assert_eq!(
        after(text, |project| project.render.view.exposure = 1.5),
        "{\n  \"lightloom\": 1,\n  \"keys\": [{ \"frame\": 1, \"shows\": { \"image\": { \"file\": \"c.png\" } } }],\n  \
         \"render\": { \"view\": { \"exposure\": 1.5 } }\n}"
    );
    let paper = after(text, |project| project.flow.fade = Fade::Paper { tau: 0.5 });
    assert!(paper.contains("\"flow\": { \"fade\": { \"type\": \"paper\", \"tau\": 0.5 } }"), "{paper}");
    let early = after(text, |project| project.flow.fade = Fade::Smooth { start: 0.1, end: 0.9, limit: 3.0 });
    assert!(early.contains("\"fade\": { \"type\": \"smooth\", \"start\": 0.1 }"), "{early}");
}

#[test]
fn what_is_unknown_stays_with_its_constraint() {
    let deleted = after(STRANGE, |project| drop(project.constraints.remove(0)));
    assert!(
        !deleted.contains("\"x_mark\": \"left\"") && deleted.contains("\"x_mark\": \"right\""),
        "{deleted}"
    );
    let moved = after(STRANGE, |project| project.constraints.rotate_left(1));
    let edited = after(STRANGE, |project| {
        project.constraints.remove(0);
        if let Constraint::DirectedLine(line) = &mut project.constraints[0] {
            line.points[1] = [0.9, 0.8];
            line.speed = 3.0;
        }
        project.constraints.insert(1, wall(0.25));
    });
    for text in [&deleted, &moved, &edited] {
        let json: Value = serde_json::from_str(text).unwrap();
        for constraint in json["constraints"].as_array().unwrap() {
            let own = constraint.get("x_mark");
            assert!(own.is_none_or(|mark| *mark == constraint["name"]), "{constraint}");
        }
    }
    assert!(edited.contains("\"x_mark\": \"right\"") && moved.contains("\"x_mark\": \"left\""), "{edited}");
}

#[test]
fn a_light_of_another_kind_gets_the_values_it_had_and_keeps_what_is_unknown() {
    let written = after(STRANGE, |project| {
        let point = serde_json::from_str(r#"{ "type": "point", "name": "key", "watts": 12 }"#);
        project.scene.as_mut().unwrap().lights[0] = point.unwrap();
    });
    assert!(written.contains("\"x_light\": \"key\"") && !written.contains("soft_edge"), "{written}");
}

#[test]
fn what_is_unknown_stays_with_a_caustic_that_is_renamed() {
    let written = after(STRANGE, |project| {
        project.caustics[0].name = "crimson".into();
        let key = project.keys[1].caustics.remove("red").unwrap();
        project.keys[1].caustics.insert("crimson".into(), key);
    });
    assert_eq!(strangers_of(&written), strangers_of(STRANGE), "{written}");
}

#[test]
fn an_unknown_member_that_would_get_a_meaning_gives_way_to_the_project() {
    let text = STRANGE.replacen("\"x_light\": \"key\"", "\"radius\": 1, \"radius\": 2", 1);
    let written = after(&text, |project| {
        let sphere = serde_json::from_str(r#"{ "type": "sphere", "name": "key", "radius": 0.5 }"#);
        project.scene.as_mut().unwrap().lights[0] = sphere.unwrap();
    });
    assert!(Project::parse(written.as_bytes(), Path::new("shot.json")).is_ok(), "{written}");
}

#[test]
fn line_ends_byte_order_mark_and_indent_stay() {
    let tabs = "\u{feff}".to_owned() + &STRANGE.replace("  ", "\t").replace('\n', "\r\n");
    let written = after(&tabs, |project| project.name = "Other".into());
    assert_eq!(written, tabs.replace("Strange", "Other"));
}

#[test]
fn a_long_stroke_fills_its_lines() {
    let written = after(STRANGE, |project| {
        project.constraints[0] = wall(0.5);
        if let Constraint::Wall(wall) = &mut project.constraints[0] {
            wall.points = (0..200).map(|i| [i as f32 / 200.0, 0.125]).collect();
        }
    });
    let lines: Vec<_> = written.lines().filter(|line| line.contains("0.125]")).collect();
    assert!(lines.len() < 50 && lines.iter().all(|line| line.len() <= 110), "{lines:#?}");
}

#[test]
fn a_project_that_would_not_load_is_not_written() {
    let (file, _) = read(STRANGE);
    let mut project = file.project().clone();
    project.flow.gamma = f32::NAN;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("shot.json");
    assert!(file.save(&path, &project).unwrap_err().to_string().contains("flow.gamma"));
    assert!(!path.exists());
    assert!(ProjectFile::new(project).is_err());
}

#[test]
fn a_new_project_is_laid_out_like_the_examples() {
    let example = Project::load(&examples()[0]).unwrap();
    let file = ProjectFile::new(example.clone()).unwrap();
    let text = file.text_of(&example).unwrap();
    assert_eq!(Project::parse(text.as_bytes(), Path::new("new.json")).unwrap(), example);
    assert!(text.ends_with("}\n") && text.contains("\n  \"keys\": [\n    { \"frame\": 1,"), "{text}");
}

#[test]
fn what_is_saved_is_on_the_disk_and_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("shot.json");
    let (file, _) = read(STRANGE);
    let mut project = file.project().clone();
    project.seed = 77;
    let text = file.save(&path, &project).unwrap();
    assert_eq!(std::fs::read_to_string(&path).unwrap(), text);
    assert_eq!(*ProjectFile::open(&path).unwrap().0.project(), project);
    file.save(&path, file.project()).unwrap();
    assert_eq!(std::fs::read_to_string(&path).unwrap(), STRANGE, "undone, also after a save");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[test]
fn a_file_cut_off_anywhere_is_refused() {
    for end in (0..STRANGE.trim_end().len()).filter(|end| STRANGE.is_char_boundary(*end)) {
        let cut = ProjectFile::parse(&STRANGE.as_bytes()[..end], Path::new("shot.json"));
        assert!(cut.is_err(), "cut at {end}");
    }
    for byte in 0..=u8::MAX {
        let mut bytes = STRANGE.as_bytes().to_vec();
        bytes[100] = byte;
        let _ = ProjectFile::parse(&bytes, Path::new("shot.json"));
    }
    let deep = STRANGE.replacen("[1.50, ", &format!("[{}{}, ", "[".repeat(100_000), "]".repeat(100_000)), 1);
    assert!(ProjectFile::parse(deep.as_bytes(), Path::new("shot.json")).is_err());
}

fn wall(x: f32) -> Constraint {
    Constraint::Wall(Wall {
        name: String::new(),
        points: vec![[x, 0.0], [x, 1.0]],
        thickness: 0.02,
        span: None,
        enabled: true,
        locked: false,
        group: String::new(),
    })
}

/// One edit as an artist makes it, of a kind and with a value and a place between 0 and 1; `deletes` says whether it may
/// take something away. What does not fit the project is left.
fn edit(project: &mut Project, kind: usize, value: f32, place: f32, deletes: bool) {
    let pick = |length: usize| ((place * length as f32) as usize).min(length.saturating_sub(1));
    let constraint = pick(project.constraints.len());
    match kind {
        0 => project.flow.gamma = value,
        1 => project.render.view.exposure = value,
        2 => project.constraints.insert(constraint, wall(value)),
        3 if deletes && !project.constraints.is_empty() => drop(project.constraints.remove(constraint)),
        4 => match project.constraints.get_mut(constraint) {
            Some(Constraint::Wall(Wall { points, .. })) => points[0][0] = value,
            Some(Constraint::DirectedLine(DirectedLine { points, .. })) => points.insert(1, [value, place]),
            None => {}
        },
        5 => project.constraints.reverse(),
        6 => project.name = format!("Shot {value} \"é\n"),
        7 => project.flow.turbulence.iter_mut().for_each(|swirls| swirls.strength = value),
        8 => project.keys[0].ease = if value < 0.5 { Ease::In } else { Ease::Out },
        9 => project.keys[2].frame = 51 + (value * 1000.0) as i32,
        10 => match &mut project.keys[1].shows {
            Shows::Image(image) => image.placement.centre = (value < 0.5).then_some([value, place]),
            Shows::PhysicalCaustic | Shows::Points(_) => {}
        },
        11 => match &mut project.scene.as_mut().unwrap().lights[0] {
            LightDesc::Spot(light) => light.position[1] = value,
            _ => unreachable!("the first light is a spot"),
        },
        13 => project.scene.as_mut().unwrap().meshes.reverse(),
        14 => project.output.frames = (value < 0.5).then(|| "1-9".into()),
        15 => match project.constraints.get_mut(constraint) {
            Some(Constraint::Wall(Wall { span: span @ None, .. })) => {
                *span = Some(Span { from: 1, to: 5, fade: 0 });
            }
            Some(Constraint::DirectedLine(line)) => line.enabled = value < 0.5,
            _ => {}
        },
        16 if deletes => project.flow.fade = Fade::Paper { tau: value * 0.9 },
        17 => drop(project.keys[1].caustics.get_mut("red").map(|red| red.colour[1] = value)),
        _ => {}
    }
}

proptest! {
    #[test]
    fn any_edits_come_back_and_what_is_unknown_stays(
        edits in prop::collection::vec((0_usize..18, 0.0_f32..1.0, 0.0_f32..1.0), 1..12)
    ) {
        let (file, _) = read(STRANGE);
        let mut project = file.project().clone();
        for (kind, value, place) in &edits {
            edit(&mut project, *kind, *value, *place, false);
        }
        let text = file.text_of(&project).unwrap();
        prop_assert!(*read(&text).0.project() == project, "{}", text);
        prop_assert_eq!(strangers_of(&text), strangers_of(STRANGE), "{}", text);
        prop_assert_eq!(&file.text_of(&project).unwrap(), &text);
        // From the text it became, all edits undone: nothing unknown is lost on the way back either.
        let back = read(&text).0.text_of(file.project()).unwrap();
        prop_assert_eq!(strangers_of(&back), strangers_of(STRANGE), "{}", back);
        prop_assert_eq!(file.text_of(file.project()).unwrap(), STRANGE);
    }

    #[test]
    fn edits_that_also_delete_come_back(
        edits in prop::collection::vec((0_usize..18, 0.0_f32..1.0, 0.0_f32..1.0), 1..20)
    ) {
        let (file, _) = read(STRANGE);
        let mut project = file.project().clone();
        for (kind, value, place) in &edits {
            edit(&mut project, *kind, *value, *place, true);
        }
        let text = file.text_of(&project).unwrap();
        prop_assert!(*read(&text).0.project() == project, "{}", text);
        let all = strangers_of(STRANGE);
        prop_assert!(strangers_of(&text).iter().all(|own| all.contains(own)), "{}", text);
    }

    #[test]
    fn bytes_of_any_kind_are_read_or_refused_but_never_panic(at in 0..STRANGE.len(), bytes: Vec<u8>) {
        let mut text = STRANGE.as_bytes().to_vec();
        let end = (at + bytes.len()).min(text.len());
        text.splice(at..end, bytes);
        let _ = ProjectFile::parse(&text, Path::new("shot.json"));
    }
}

/// A number beyond all ranges, in place of each number of a project with every kind of object: it is refused, or kept finite.
#[test]
fn no_number_of_a_file_becomes_one_that_is_not_finite() {
    fn numbers(value: &mut Value, at: &mut usize, change: usize) {
        match value {
            Value::Number(_) => {
                if *at == change {
                    *value = serde_json::json!(1e300);
                }
                *at += 1;
            }
            Value::Array(items) => items.iter_mut().for_each(|item| numbers(item, at, change)),
            Value::Object(members) => members.values_mut().for_each(|member| numbers(member, at, change)),
            _ => (),
        }
    }
    let (file, _) = read(STRANGE);
    let full = serde_json::to_value(file.project()).unwrap();
    let mut count = 0;
    numbers(&mut full.clone(), &mut count, usize::MAX);
    assert!(count > 100, "{count}");
    for change in 0..count {
        let mut changed = full.clone();
        numbers(&mut changed, &mut 0, change);
        let text = changed.to_string();
        if let Ok((file, _)) = ProjectFile::parse(text.as_bytes(), Path::new("shot.json")) {
            // What is not finite is null in JSON, and would not come back.
            let written = file.text_of(&Project { seed: 7, ..file.project().clone() }).unwrap();
            let again = read(&written).0.project().clone();
            assert_eq!(Project { seed: 7, ..file.project().clone() }, again, "{text}");
        }
    }
}

/// A writer that fails at any byte leaves the old file, and nothing else.
#[test]
fn a_save_that_fails_at_any_byte_leaves_the_old_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("shot.json");
    let text = std::fs::read_to_string(crate::root().join("projects/letters.json")).unwrap();
    std::fs::write(&path, "the old file").unwrap();
    for most in 0..text.len() {
        let failed = lightloom_core::files::write_atomic(&path, |file| {
            use std::io::Write as _;
            file.write_all(&text.as_bytes()[..most])?;
            file.flush()?;
            Err(std::io::Error::other("disk full"))
        });
        assert!(failed.is_err());
    }
    assert_eq!(std::fs::read_to_string(&path).unwrap(), "the old file");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1, "no temporary file is left");
}
