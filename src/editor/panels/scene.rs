//! The scene: glass, lights, camera, receiver, sky.

mod lights;
mod materials;
mod meshes;
mod surroundings;

use egui::Ui;
use lightloom_core::project::Project;
use lightloom_core::scene::SceneDesc;

use super::control::Control;
use super::widgets::fold;
use crate::editor::context::EditorContext;
use crate::editor::document::Edit;

/// The settings of this panel.
pub(super) const CONTROLS: &[&[Control]] =
    &[meshes::CONTROLS, materials::CONTROLS, lights::CONTROLS, surroundings::CONTROLS];

/// The scene panel.
pub(super) fn show(ui: &mut Ui, editor: &mut EditorContext) {
    let project = editor.document.project();
    let Some(before) = &project.scene else { return without_scene(ui, editor, project) };
    let mut scene = before.clone();
    let mut caustics = project.caustics.clone();
    fold_open(ui, "Meshes", |ui| meshes::show(ui, editor, &mut scene, &mut caustics));
    fold_open(ui, "Lights", |ui| lights::show(ui, editor, &mut scene, &mut caustics));
    fold(ui, "Camera", |ui| surroundings::camera(ui, editor, &mut scene.camera));
    fold(ui, "Receiver", |ui| surroundings::receiver(ui, &mut scene.receiver));
    fold(ui, "Sky", |ui| surroundings::sky(ui, &mut scene.environment));
    if scene != *before {
        editor.ask(Edit::Scene(Some(Box::new(scene))));
    }
    if caustics != project.caustics {
        editor.ask(Edit::Caustics(caustics));
    }
}

/// The plane of a project without scene, and a button that adds one.
fn without_scene(ui: &mut Ui, editor: &mut EditorContext, project: &Project) {
    ui.label("This project has no scene: the plane is seen straight on.");
    let mut plane = project.plane.clone();
    surroundings::plane(ui, &mut plane);
    if plane != project.plane {
        editor.ask(Edit::Plane(plane));
    }
    ui.add_space(6.0);
    let add = ui.button("Add a scene").on_hover_text("A light, a camera and a receiver; then add glass.");
    if add.clicked() {
        let scene = SceneDesc { lights: vec![lights::first()], ..SceneDesc::default() };
        editor.ask(Edit::Scene(Some(Box::new(scene))));
    }
}

/// A collapsible part that is open at first.
fn fold_open(ui: &mut Ui, name: &str, add: impl FnOnce(&mut Ui)) {
    ui.add_space(4.0);
    egui::CollapsingHeader::new(name).default_open(true).show_unindented(ui, add);
}
