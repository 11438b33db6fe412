//! What is odd about drawn lines and walls is said, and never stops the program.

use std::path::Path;

use lightloom_core::engine::{CheckReport, Engine, Summary};
use lightloom_core::note::About;
use lightloom_core::project::{AssetFolder, Project};
use lightloom_core::{Error, Progress, Result};
use serde_json::{Value, json};

use crate::scenes::texts;

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let points = |x: f32| {
        let rows =
            (0..300).map(|i| format!("{},{}\n", x + 0.1 * (i as f32 * 0.7).sin(), 0.3 + 0.001 * i as f32));
        "x,y\n".to_owned() + &rows.collect::<String>()
    };
    std::fs::write(folder.path().join("left.csv"), points(0.25)).unwrap();
    std::fs::write(folder.path().join("right.csv"), points(0.75)).unwrap();
    folder
}

fn project(constraints: Value) -> Result<Project> {
    let project = json!({
        "lightloom": 1,
        "keys": [ { "frame": 1, "shows": { "points": { "file": "left.csv" } } },
                  { "frame": 11, "shows": { "points": { "file": "right.csv" } } } ],
        "constraints": constraints,
        "flow": { "grid": 32, "steps": 8 },
        "render": { "width": 16, "height": 16, "photons": 300, "passes": 1 }
    });
    Project::parse(project.to_string().as_bytes(), Path::new("test.json"))
}

fn assets(folder: &Path) -> AssetFolder {
    AssetFolder::new(&folder.join("test.json"), false).unwrap()
}

fn check(constraints: Value) -> CheckReport {
    let folder = folder();
    Engine::new(assets(folder.path())).check(&project(constraints).unwrap()).unwrap()
}

fn fit(constraints: Value) -> Summary {
    let folder = folder();
    let out = tempfile::tempdir().unwrap();
    let project = project(constraints).unwrap();
    Engine::new(assets(folder.path())).fit(&project, out.path(), &Progress::new(), &|_| ()).unwrap()
}

fn notes_of(constraint: Value) -> String {
    // What is odd must not stop the flow either.
    let summary = fit(json!([constraint]));
    assert_eq!(summary.flow.unwrap().flow.endpoint_error, 0.0);
    texts(&check(json!([constraint])).notes).join("\n")
}

/// The notes on a project with these constraints, or why it is refused.
pub(crate) fn notes(constraints: Value) -> Result<Vec<String>, String> {
    let project = project(constraints).map_err(|error| error.to_string())?;
    let folder = folder();
    let report = Engine::new(assets(folder.path())).check(&project);
    report.map(|report| texts(&report.notes)).map_err(|error| error.to_string())
}

pub(crate) fn line(points: Value) -> Value {
    json!({ "type": "directed_line", "points": points })
}

pub(crate) fn wall(points: Value) -> Value {
    json!({ "type": "wall", "points": points })
}

#[test]
fn dots_and_empty_strokes_do_nothing_and_are_named() {
    for points in [json!([]), json!([[0.5, 0.5]]), json!([[0.5, 0.5], [0.5, 0.5], [0.5, 0.5]])] {
        for stroke in [line(points.clone()), wall(points.clone())] {
            assert!(notes_of(stroke).contains(" 1 is no longer than a dot"));
        }
    }
}

#[test]
fn strokes_off_the_receiver_and_beside_the_animation_are_named() {
    assert!(notes_of(line(json!([[2, 2], [3, 2]]))).contains("lies off the receiver"));
    assert!(notes_of(wall(json!([[2, 2], [3, 2]]))).contains("lies off the receiver"));
    let late =
        json!({ "type": "wall", "points": [[0.5, 0.2], [0.5, 0.8]], "span": { "from": 50, "to": 60 } });
    assert!(notes_of(late).contains("never acts"));
}

#[test]
fn walls_thinner_than_a_cell_and_at_the_border_are_named() {
    let thin = json!({ "type": "wall", "points": [[0.5, 0.2], [0.5, 0.8]], "thickness": 0.01 });
    assert!(notes_of(thin).contains("0.32 cells thick"));
    assert!(notes_of(wall(json!([[0, 0.9], [1, 0.9]]))).contains("reaches the border at both ends"));
}

/// A wall is named by its place among all that was drawn, lines too, and programs read kind and place.
#[test]
fn a_note_says_what_it_is_about() {
    let across = wall(json!([[0, 0.9], [1, 0.9]]));
    let report = check(json!([line(json!([[0.3, 0.5], [0.7, 0.5]])), across]));
    let note = report.notes.iter().find(|note| note.text.contains("reaches the border")).unwrap();
    assert_eq!(note.about, About::Constraint(1));
    let told: Value = serde_json::from_str(&report.to_json()).unwrap();
    let [_, note] = &told["notes"].as_array().unwrap()[..] else { panic!("{told}") };
    assert_eq!((&note["kind"], &note["object"]), (&json!("constraint"), &json!("constraints[1]")));
    assert!(note["text"].as_str().unwrap().starts_with("wall 2 reaches the border"));
    // By the artist's name, where there is one: in an error beside its place in the file.
    let named = |thickness: f64| {
        let points = [[0, 0], [1, 1]];
        json!({ "type": "wall", "name": "upper hollow", "points": points, "thickness": thickness })
    };
    assert!(notes_of(named(0.01)).contains("wall \"upper hollow\" is 0.32 cells thick"));
    let error = project(json!([named(0.0)])).unwrap_err().to_string();
    assert!(
        error.contains("constraints[0].thickness: ") && error.ends_with("(wall \"upper hollow\")"),
        "{error}"
    );
}

#[test]
fn opposite_lines_in_one_place_are_a_conflict() {
    let report = check(json!([line(json!([[0.3, 0.5], [0.7, 0.5]])), line(json!([[0.7, 0.5], [0.3, 0.5]]))]));
    assert!(texts(&report.notes).join("\n").contains("contradict each other"));
    // One that crosses itself is no conflict: it goes across, not against.
    let loops = check(json!([line(json!([[0.2, 0.5], [0.8, 0.5], [0.8, 0.8], [0.5, 0.8], [0.5, 0.2]]))]));
    assert!(!texts(&loops.notes).join("\n").contains("contradict"));
}

#[test]
fn light_that_is_shut_off_is_counted_and_said() {
    let summary = fit(json!([wall(json!([[0.5, 0], [0.5, 1]]))]));
    assert_eq!(summary.flow.as_ref().unwrap().flow.unreachable, 300);
    assert!(texts(&summary.notes).join("\n").contains("walls shut 300 photons off"));
    assert!(summary.to_text().contains("walls: 0 crossings, 300 photons shut off"));
}

#[test]
fn walls_that_touch_are_named_and_a_thick_one_over_all_the_light_does_no_harm() {
    let report =
        check(json!([wall(json!([[0.5, 0.2], [0.5, 0.8]])), wall(json!([[0.2, 0.5], [0.49, 0.5]]))]));
    assert!(texts(&report.notes).join("\n").contains("wall 1 and wall 2 touch"));
    let huge = json!({ "type": "wall", "points": [[0.2, 0.2], [0.3, 0.7]], "thickness": 0.5 });
    notes_of(huge);
}

#[test]
fn values_out_of_range_are_refused_by_their_place() {
    let refused = |constraint: Value, place: &str| {
        let error = project(json!([constraint])).unwrap_err();
        assert!(error.to_string().contains(place), "{error}");
    };
    refused(json!({ "type": "wall", "points": [[0, 0], [1, 11]] }), "constraints[0].points[1]");
    refused(
        json!({ "type": "wall", "points": [[0, 0], [1, 1]], "thickness": 0 }),
        "constraints[0].thickness",
    );
    refused(json!({ "type": "directed_line", "points": [], "weight": -1 }), "constraints[0].weight");
    refused(json!({ "type": "directed_line", "points": [], "width": 0 }), "constraints[0].width");
    refused(
        json!({ "type": "directed_line", "points": [], "span": { "from": 9, "to": 3 } }),
        "constraints[0].span",
    );
    refused(json!({ "type": "vortex", "points": [] }), "constraints[0]");
    refused(json!({ "type": "wall", "points": [], "colour": "red" }), "constraints[0]");
    let many = json!({ "type": "wall", "points": vec![[0.5, 0.5]; 10_001] });
    let Error::Limit { .. } = project(json!([many])).unwrap_err() else { panic!("a limit") };
}

#[test]
fn nothing_drawn_and_everything_switched_off_are_left_out() {
    let off = json!([
        { "type": "wall", "points": [[0.5, 0.2], [0.5, 0.8]], "enabled": false },
        { "type": "directed_line", "points": [[0.3, 0.5], [0.7, 0.5]], "enabled": false }
    ]);
    for constraints in [json!([]), off] {
        let left: Vec<_> = check(constraints).plan.left_out.iter().map(|left| left.what).collect();
        assert!(left.contains(&"ways around walls") && left.contains(&"fit to directed lines"), "{left:?}");
    }
}

#[test]
fn a_saved_constraint_comes_back_as_it_was() {
    let drawn = json!([
        { "type": "wall", "name": "left", "points": [[0.5, 0.2], [0.5, 0.8]], "span": { "from": 1, "to": 5, "fade": 2 } },
        line(json!([[0.3, 0.5], [0.7, 0.5]]))
    ]);
    let project = project(drawn).unwrap();
    let text = project.to_json().unwrap();
    assert_eq!(Project::parse(text.as_bytes(), Path::new("test.json")).unwrap(), project);
}
