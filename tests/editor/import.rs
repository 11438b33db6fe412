//! From an empty project to a caustic: a scene of another program comes in by the dialog, in one step.

use std::fs;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use egui::{HoveredFile, Key, Modifiers};
use egui_kittest::kittest::Queryable as _;
use lightloom::editor::access::Access;
use lightloom::editor::action::Action;
use lightloom::editor::asset::{AssetUse, TargetSlot};
use lightloom::editor::command::Command;
use lightloom::editor::dialogs::PickResult;
use lightloom::editor::document::Edit;
use lightloom::editor::engine::SharedEngine;
use lightloom::editor::export::{ExportSettings, Exports, Status};
use lightloom_core::constraint::{Constraint, Wall};
use lightloom_core::engine::Existing;
use lightloom_core::flow::GridSize;
use lightloom_core::import::empty_project;
use lightloom_core::project::Project;
use lightloom_core::scene::Material;

use crate::window::{examples, project, until, window};

/// A pyramid without a material, its corners in the file itself.
fn pyramid() -> String {
    let corners = [[0.0, 0.1, 0.0], [-0.1, 0.0, 0.1], [0.1, 0.0, 0.1], [0.0, 0.0, -0.1]];
    let faces = [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]];
    let all = faces.as_flattened().iter().flat_map(|corner: &usize| corners[*corner]);
    let bytes: String = all.flat_map(f32::to_le_bytes).map(|byte| format!("%{byte:02x}")).collect();
    serde_json::json!({
        "asset": { "version": "2.0" }, "scenes": [ { "nodes": [0] } ], "nodes": [ { "name": "Prism", "mesh": 0 } ],
        "meshes": [ { "primitives": [ { "attributes": { "POSITION": 0 } } ] } ],
        "accessors": [ { "bufferView": 0, "componentType": 5126, "count": 12, "type": "VEC3" } ],
        "bufferViews": [ { "buffer": 0, "byteLength": 144 } ],
        "buffers": [ { "byteLength": 144, "uri": format!("data:,{bytes}") } ]
    })
    .to_string()
}

#[test]
fn a_scene_comes_into_an_empty_project_and_leaves_by_one_undo() {
    let folder = examples();
    let path = folder.path().join("prism.gltf");
    fs::write(&path, pyramid()).unwrap();
    let mut harness = window(&folder, "letters_free", vec![PickResult::Picked(path)]);
    harness.state_mut().ask(Action::Command(Command::NewEmpty));
    harness.run_steps(3);
    assert_eq!(**harness.state().document().project(), empty_project());
    assert!(!harness.state().document().is_unsaved());
    // It invites; that there is nothing to compute is no fault.
    assert!(harness.query_by_label("Import a glass").is_some());
    for _ in 0..100 {
        harness.run_steps(1);
        std::thread::sleep(Duration::from_millis(5));
        assert_eq!(harness.state().preview().problem(), None);
    }

    harness.key_press_modifiers(Modifiers::COMMAND, Key::I);
    until(&mut harness, "the scene", |app| {
        app.document().project().scene.as_ref().is_some_and(|scene| !scene.meshes.is_empty())
    });
    // What was guessed is told in the status bar, and covers nothing.
    harness.run_steps(2);
    assert!(harness.query_by_label("Import a glass").is_none());
    assert!(harness.query_by_label("'prism.gltf' was imported").is_none());
    harness.get_by_label("Details").click();
    harness.run_steps(3);
    assert!(harness.query_by_label("'prism.gltf' was imported").is_some());
    harness.key_press(Key::Escape);
    harness.run_steps(3);
    let project = harness.state().document().project().clone();
    let scene = project.scene.as_ref().unwrap();
    assert_eq!(scene.meshes[0].node.as_deref(), Some("Prism"));
    assert!(matches!(scene.meshes[0].material, Some(Material::Glass(_))));
    assert_eq!(scene.lights.len(), 1);
    harness.state_mut().ask(Action::Command(Command::Undo));
    harness.run_steps(3);
    assert_eq!(**harness.state().document().project(), empty_project());
}

#[test]
fn what_cannot_be_imported_is_told_and_changes_nothing() {
    let folder = examples();
    let path = folder.path().join("prism.gltf");
    fs::write(&path, "{}").unwrap();
    let mut harness = window(&folder, "letters_free", vec![PickResult::Picked(path)]);
    let before = harness.state().document().project().clone();
    harness.state_mut().ask(Action::Command(Command::Import));
    for _ in 0..400 {
        harness.run_steps(1);
        if harness.query_by_label_contains("cannot be imported").is_some() {
            break;
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    assert!(harness.query_by_label_contains("no glTF file").is_some());
    assert_eq!(*harness.state().document().project(), before);
}

/// The frames of a folder by name.
fn frames(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let paths = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let named = paths.map(|path| (path.file_name().unwrap().to_string_lossy().into_owned(), path));
    let frames = named.filter(|(name, _)| name.starts_with("shot."));
    let mut frames: Vec<_> = frames.map(|(name, path)| (name, fs::read(path).unwrap())).collect();
    frames.sort();
    frames
}

#[test]
fn a_glass_a_logo_and_a_plate_from_elsewhere_become_frames_with_the_bytes_of_the_command_line() {
    let (folder, far) = (examples(), tempfile::tempdir().unwrap());
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let [glass, logo, plate] = ["prism.gltf", "logo.png", "plate.png"].map(|name| far.path().join(name));
    fs::write(&glass, pyramid()).unwrap();
    fs::copy(root.join("assets/targets/star.png"), &logo).unwrap();
    fs::copy(root.join("assets/targets/flower.png"), &plate).unwrap();
    let path = project(&folder, "shot");
    let answers = [glass, logo, plate, path.clone()].map(PickResult::Picked).to_vec();
    let mut harness = window(&folder, "letters_free", answers);
    harness.state_mut().ask(Action::Command(Command::NewEmpty));
    harness.run_steps(3);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::I);
    let files =
        |count: usize| move |app: &lightloom::editor::App| app.document().project().files().len() == count;
    until(&mut harness, "the glass", files(1));
    let slot = TargetSlot { key: 1, caustic: None };
    harness.state_mut().ask(Action::PickFile(AssetUse::Picture(slot)));
    until(&mut harness, "the logo", files(2));
    harness.state_mut().ask(Action::PickFile(AssetUse::Plate));
    until(&mut harness, "the plate", files(3));
    let mut small = (**harness.state().document().project()).clone();
    (small.render.width, small.render.height, small.render.photons, small.render.passes) = (48, 27, 2000, 1);
    (small.flow.steps, small.flow.grid) = (4, GridSize::Longer(16));
    let wall = Constraint::Wall(Wall::new(vec![[0.3, 0.6], [0.4, 0.7]]));
    for edit in [Edit::Render(small.render), Edit::Flow(small.flow), Edit::Add(vec![wall])] {
        harness.state_mut().ask(Action::Edit(edit));
    }
    harness.run_steps(2);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::S);
    until(&mut harness, "the save", |app| app.document().path() == Some(&path));
    drop(harness);
    // Nothing of it is needed where it came from.
    drop(far);

    let mut harness = window(&folder, "shot", Vec::new());
    until(&mut harness, "the light", |app| app.preview().is_current());
    assert_eq!(harness.state().preview().problem(), None);
    let saved = Project::load(&path).unwrap();
    assert_eq!(**harness.state().document().project(), saved);
    assert_eq!(saved.constraints.len(), 1);
    let [by_window, by_command] = ["window", "command"].map(|name| folder.path().join(name));
    let mut exports = Exports::new(SharedEngine::default(), || ());
    let mut exported = saved;
    exported.output.frames = Some("50-54".into());
    let job = exports.add(ExportSettings {
        project: Arc::new(exported),
        file: path.clone(),
        access: Access::default(),
        folder: by_window.clone(),
        film: None,
        limit: None,
        shown: 50,
        existing: Existing::Refuse,
    });
    while matches!(job.status(), Status::Waiting | Status::Running) {
        std::thread::sleep(Duration::from_millis(10));
    }
    let program = env!("CARGO_BIN_EXE_lightloom");
    let mut command = std::process::Command::new(program);
    command.arg("render").arg(&path).arg("--out").arg(&by_command).args(["--frames", "50-54"]);
    let output = command.output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let made = frames(&by_window);
    assert_eq!(made.len(), 10, "five frames in two formats: {:?}", job.status());
    assert!(made == frames(&by_command), "the command line writes other bytes");
}

#[test]
fn what_a_dragged_file_would_become_is_said_before_it_is_let_go() {
    let folder = examples();
    let mut harness = window(&folder, "letters_free", Vec::new());
    harness.run_steps(3);
    for (file, said) in [
        ("glass.glb", "Import 'glass.glb' into the scene"),
        ("logo.png", "Show 'logo.png' at the key frame 1"),
        ("shot.json", "Open 'shot.json'"),
        ("scene.usda", "'scene.usda' is USD"),
        ("notes.txt", "'notes.txt' is not a project, mesh, picture or point file"),
    ] {
        let dragged = HoveredFile { path: Some(file.into()), ..HoveredFile::default() };
        harness.input_mut().hovered_files = vec![dragged];
        harness.run_steps(2);
        assert!(harness.query_by_label_contains(said).is_some(), "{said}");
        harness.input_mut().hovered_files.clear();
        harness.run_steps(2);
        assert!(harness.query_by_label_contains(said).is_none(), "{said}");
    }
}
