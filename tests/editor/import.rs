//! From an empty project to a caustic: a scene of another program comes in by the dialog, in one step.

use egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable as _;
use lightloom::editor::action::Action;
use lightloom::editor::command::Command;
use lightloom::editor::dialogs::PickResult;
use lightloom_core::import::empty_project;
use lightloom_core::scene::Material;

use crate::window::{examples, until, window};

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
    std::fs::write(&path, pyramid()).unwrap();
    let mut harness = window(&folder, "letters_free", vec![PickResult::Picked(path)]);
    harness.state_mut().ask(Action::Command(Command::NewEmpty));
    harness.run_steps(3);
    assert_eq!(**harness.state().document().project(), empty_project());
    assert!(!harness.state().document().is_unsaved());
    // It invites; that there is nothing to compute is no fault.
    assert!(harness.query_by_label("Import a glass").is_some());
    for _ in 0..100 {
        harness.run_steps(1);
        std::thread::sleep(std::time::Duration::from_millis(5));
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
    std::fs::write(&path, "{}").unwrap();
    let mut harness = window(&folder, "letters_free", vec![PickResult::Picked(path)]);
    let before = harness.state().document().project().clone();
    harness.state_mut().ask(Action::Command(Command::Import));
    for _ in 0..400 {
        harness.run_steps(1);
        if harness.query_by_label_contains("cannot be imported").is_some() {
            break;
        }
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    assert!(harness.query_by_label_contains("no glTF file").is_some());
    assert_eq!(*harness.state().document().project(), before);
}
