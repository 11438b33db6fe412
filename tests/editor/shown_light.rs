//! Pictures of another project are never on screen while the status bar says ready.

use std::fs;
use std::path::Path;
use std::time::Duration;

use lightloom::editor::access::Access;
use lightloom::editor::action::Action;
use lightloom::editor::command::Command;
use lightloom::editor::document::{Document, Edit};
use lightloom::editor::engine::SharedEngine;
use lightloom::editor::preview::{Plane, Subject, Wanted};
use lightloom::editor::state::EditorState;
use lightloom_core::project::{Project, Shows};
use proptest::prelude::*;
use serde_json::json;

/// Places of light, x in plane coordinates, one for each file of points.
const PLACES: [f32; 4] = [0.15, 0.4, 0.65, 0.9];

/// What an artist may do next.
#[derive(Clone, Copy, Debug)]
enum Step {
    Open(usize),
    New(usize),
    /// Another light at all key frames.
    Edit(usize),
    Undo,
    /// Deletes the last key frame.
    Delete,
    /// A file that is not there.
    Fail,
    Recover(usize),
    Wait(u64),
}

fn step() -> impl Strategy<Value = Step> {
    let place = || 0..PLACES.len();
    prop_oneof![
        place().prop_map(Step::Open),
        place().prop_map(Step::New),
        place().prop_map(Step::Edit),
        Just(Step::Undo),
        Just(Step::Delete),
        Just(Step::Fail),
        place().prop_map(Step::Recover),
        (0u64..60).prop_map(Step::Wait),
    ]
}

fn points(place: &str) -> serde_json::Value {
    json!({ "points": { "file": format!("{place}.csv") } })
}

fn project(folder: &Path, place: usize) -> Project {
    let shows = points(&place.to_string());
    let text = json!({
        "lightloom": 1,
        "keys": [ { "frame": 1, "shows": shows }, { "frame": 3, "shows": shows } ],
        "flow": { "grid": 8, "steps": 2, "guides": 100 },
        "render": { "photons": 200 }
    });
    Project::parse(text.to_string().as_bytes(), &folder.join("project.json")).unwrap()
}

/// The place of the light that a project shows; none where its file is missing.
fn place_of(project: &Project) -> Option<f32> {
    let Shows::Points(points) = &project.keys[0].shows else { return None };
    PLACES.get(points.file.strip_suffix(".csv")?.parse::<usize>().ok()?).copied()
}

fn shown_by(project: &Project, place: &str) -> Edit {
    let mut keys = project.keys.clone();
    keys.iter_mut().for_each(|key| key.shows = serde_json::from_value(points(place)).unwrap());
    Edit::Keys(keys)
}

fn take(editor: &mut EditorState, folder: &Path, step: Step) {
    let current = editor.document.project().clone();
    match step {
        Step::Open(place) => {
            let path = folder.join(format!("{place}.json"));
            editor.open(Document::new(project(folder, place), Some(path)));
        }
        Step::New(place) => editor.open(Document::new(project(folder, place), None)),
        Step::Recover(place) => {
            let mut document = Document::new(project(folder, place), None);
            document.mark_unsaved();
            editor.open(document);
        }
        Step::Edit(place) => editor.edit(shown_by(&current, &place.to_string())),
        Step::Fail => editor.edit(shown_by(&current, "missing")),
        Step::Delete => {
            let keys = current.keys[..1].to_vec();
            editor.edit(Edit::Keys(keys));
        }
        Step::Undo => {
            let _ = editor.apply(Action::Command(Command::Undo));
        }
        Step::Wait(_) => (),
    }
    editor.document.settle();
}

/// What the views hold is of the open project, or they do not say that it is.
fn check(editor: &mut EditorState, folder: &Path) {
    let subject = Subject {
        project: editor.document.project().clone(),
        base: folder.join("project.json"),
        access: Access::default(),
    };
    let wanted = Wanted { plane: Plane::Picture(64), ..Wanted::default() };
    editor.preview.follow(&subject, &editor.session, &wanted);
    if !editor.preview.is_shown() {
        return;
    }
    let asked = place_of(&subject.project).expect("a project without its file is never shown");
    let painted = editor.preview.painted();
    let picture = painted.plane[0].as_ref().expect("a picture is shown");
    let [width, _] = picture.size;
    let (mut sum, mut weight) = (0.0, 0.0);
    for (i, pixel) in picture.pixels.iter().enumerate() {
        let light = f32::from(pixel.r());
        sum += light * ((i % width) as f32 + 0.5) / width as f32;
        weight += light;
    }
    // The places are .25 apart; the light is .02 wide, and spread over some pixels of 1/64.
    let at = sum / weight;
    assert!((at - asked).abs() < 0.06, "light at {at} is shown as that at {asked}");
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(24) })]

    #[test]
    fn no_picture_of_another_project_is_said_to_be_ready(steps in prop::collection::vec(step(), 1..8)) {
        let folder = tempfile::tempdir().unwrap();
        for (i, x) in PLACES.iter().enumerate() {
            let rows: String = (0..200).map(|n| format!("{},{}\n", x + 0.02 * ((n % 10) as f32 / 10.0 - 0.5), 0.3 + n as f32 * 0.002)).collect();
            fs::write(folder.path().join(format!("{i}.csv")), rows).unwrap();
        }
        let document = Document::new(project(folder.path(), 0), None);
        let mut editor = EditorState::new(document, SharedEngine::default(), || {});
        for step in steps {
            take(&mut editor, folder.path(), step);
            let wait = if let Step::Wait(wait) = step { wait } else { 8 };
            for _ in 0..1 + wait / 4 {
                check(&mut editor, folder.path());
                std::thread::sleep(Duration::from_millis(4));
            }
        }
        // In the end the light of the project comes, or a reason why not; the reason of an earlier one stays until then.
        let mut waited = 0;
        let fails = place_of(editor.document.project()).is_none();
        while editor.preview.problem().is_some() != fails || !(fails || editor.preview.is_shown()) {
            check(&mut editor, folder.path());
            std::thread::sleep(Duration::from_millis(5));
            waited += 1;
            prop_assert!(waited < 6000, "neither light nor a reason within 30 s");
        }
    }
}
