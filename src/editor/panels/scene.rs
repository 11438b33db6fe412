//! The scene: glass, lights, camera, receiver, sky.

mod lights;
mod materials;
mod meshes;
mod objects;
mod surroundings;

use egui::Ui;
use lightloom_core::project::Project;
use lightloom_core::scene::SceneDesc;

use super::control::Control;
use super::widgets::fold;
use crate::editor::context::EditorContext;
use crate::editor::document::Edit;
use crate::editor::look::object::SceneObject;

pub(in crate::editor) use lights::lamp_words;

/// The settings of this panel.
pub(super) const CONTROLS: &[&[Control]] =
    &[meshes::CONTROLS, materials::CONTROLS, lights::CONTROLS, surroundings::CONTROLS];

/// What cannot be keyed, and why.
const STILL: &str =
    "Meshes, lamps and camera stand still throughout the film; its key frames move their light.";

/// The scene panel.
pub(super) fn show(ui: &mut Ui, editor: &mut EditorContext) {
    let project = editor.document.project();
    let Some(before) = &project.scene else { return without_scene(ui, editor, project) };
    let mut scene = before.clone();
    let mut caustics = project.caustics.clone();
    ui.add(egui::Label::new(egui::RichText::new(STILL).small().weak()).wrap());
    fold_open(ui, "Meshes", |ui| meshes::show(ui, editor, &mut scene, &mut caustics));
    fold_open(ui, "Lights", |ui| lights::show(ui, editor, &mut scene, &mut caustics));
    let object = editor.session.focus.object;
    let is_camera = object.is_some_and(SceneObject::is_camera);
    fold_of(ui, "Camera", is_camera, |ui| surroundings::camera(ui, editor, &mut scene.camera));
    let is_receiver = object == Some(SceneObject::Receiver);
    fold_of(ui, "Receiver", is_receiver, |ui| surroundings::receiver(ui, &mut scene.receiver));
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

/// A collapsible part that opens and comes into view when its object is selected.
fn fold_of(ui: &mut Ui, name: &str, selected: bool, add: impl FnOnce(&mut Ui)) {
    ui.add_space(4.0);
    let id = ui.scope_id().with((name, "was selected"));
    let was = ui.data_mut(|data| std::mem::replace(data.get_temp_mut_or_default::<bool>(id), selected));
    let heading = egui::RichText::new(name);
    let heading = if selected { heading.color(ui.visuals().hyperlink_color) } else { heading };
    let open = (selected && !was).then_some(true);
    let shown = egui::CollapsingHeader::new(heading).id_salt(name).open(open).show_unindented(ui, add);
    let coming = ui.scope_id().with((name, "comes into view"));
    if open.is_some() || ui.data(|data| data.get_temp(coming)).unwrap_or(false) {
        // It opens slowly, and grows meanwhile.
        ui.data_mut(|data| data.insert_temp(coming, selected && shown.openness < 1.0));
        let body = shown.body_response.map_or(egui::Rect::NOTHING, |body| body.rect);
        ui.scroll_to_rect(shown.header_response.rect.union(body), None);
    }
}

/// A collapsible part that is open at first.
fn fold_open(ui: &mut Ui, name: &str, add: impl FnOnce(&mut Ui)) {
    ui.add_space(4.0);
    egui::CollapsingHeader::new(name).default_open(true).show_unindented(ui, add);
}
