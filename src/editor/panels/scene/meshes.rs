//! Meshes: their files, places and materials.

use egui::Ui;
use lightloom_core::project::CausticDesc;
use lightloom_core::scene::gltf::GltfFile;
use lightloom_core::scene::mesh::Transform;
use lightloom_core::scene::{Material, MeshDesc, SceneDesc};

use super::{materials, objects};
use crate::editor::action::Action;
use crate::editor::asset::AssetUse;
use crate::editor::context::EditorContext;
use crate::editor::look::object::SceneObject;
use crate::editor::panels::control::Control;
use crate::editor::panels::shows;
use crate::editor::panels::widgets::{XYZ, remove_button, section};
use crate::editor::unique_name::unique_name;

const NAME: Control = Control::new("Name", MeshDesc::NAME);
const FILE: Control = Control::new("File", MeshDesc::FILE);
const NODE: Control = Control::new("Object", MeshDesc::NODE);
const ENABLED: Control = Control::new("On", MeshDesc::ENABLED);
const MOVE: Control = Control::new("Place", Transform::TRANSLATE);
const TURN: Control = Control::new("Turn", Transform::ROTATE);
const SCALE: Control = Control::new("Scale", Transform::SCALE).log_slider(0.001, 1000.0);
const SMOOTH: Control = Control::new("Smooth", MeshDesc::SMOOTH);
const PRIORITY: Control = Control::new("Priority", MeshDesc::PRIORITY).slider(-10.0, 10.0);

/// The settings of a mesh.
pub(super) const CONTROLS: &[Control] = &[NAME, FILE, NODE, ENABLED, MOVE, TURN, SCALE, SMOOTH, PRIORITY];

/// The list of meshes, and the values of the selected one. Caustics follow a renamed mesh.
pub(super) fn show(
    ui: &mut Ui,
    editor: &mut EditorContext,
    scene: &mut SceneDesc,
    caustics: &mut [CausticDesc],
) {
    let kind = |mesh: &MeshDesc| mesh.material.as_ref().map_or("from file", materials::name);
    let names = scene.meshes.iter().map(|mesh| (mesh.name.clone(), kind(mesh))).collect::<Vec<_>>();
    objects::list(ui, editor, scene, "Mesh", &names, SceneObject::Mesh);
    let is_there = |index: &usize| *index < scene.meshes.len();
    let chosen = editor.session.focus.object.and_then(SceneObject::mesh).filter(is_there);
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        if ui
            .button("Import…")
            .on_hover_text("Choose a glTF or OBJ file, or drop it onto the window")
            .clicked()
        {
            editor.ask(Action::PickFile(AssetUse::Mesh));
        }
        ui.add_enabled_ui(chosen.is_some(), |ui| {
            if remove_button(ui, "Remove this mesh")
                && let Some(index) = chosen
            {
                scene.meshes.remove(index);
                editor.session.focus.object = None;
            }
        });
    });
    let chosen = editor.session.focus.object.and_then(SceneObject::mesh);
    let Some(index) = chosen.filter(|index| *index < scene.meshes.len()) else { return };
    let taken: Vec<String> = scene.meshes.iter().map(|mesh| mesh.name.clone()).collect();
    let mesh = &mut scene.meshes[index];
    section(ui, &mesh.name);
    if let Some(name) = NAME.text(ui, index, &mesh.name).filter(|name| !name.is_empty()) {
        let name = unique_name(&name, |name| taken.iter().any(|other| other == name));
        follow(caustics, &mesh.name, &name);
        mesh.name = name;
    }
    if shows::file(ui, &FILE, &mesh.file) {
        editor.ask(Action::PickFile(AssetUse::MeshFile(index)));
    }
    if (mesh.node.is_some() || GltfFile::is_named(mesh.file.as_ref()))
        && let Some(node) = NODE.text(ui, index, mesh.node.as_deref().unwrap_or_default())
    {
        mesh.node = Some(node).filter(|node| !node.is_empty());
    }
    ENABLED.toggle(ui, &mut mesh.enabled);
    MOVE.numbers(ui, &mut mesh.transform.translate, XYZ);
    TURN.numbers(ui, &mut mesh.transform.rotate, XYZ);
    SCALE.number(ui, &mut mesh.transform.scale);
    SMOOTH.toggle(ui, &mut mesh.smooth);
    PRIORITY.number(ui, &mut mesh.priority);
    if mesh.material.is_none()
        && ui
            .button("Assign glass")
            .on_hover_text("Clear crown glass in place of the file's materials")
            .clicked()
    {
        mesh.material = Some(Material::Glass(materials::crown()));
    }
    materials::show(ui, &mut mesh.material);
}

/// Renames a mesh in the caustics that refer to it or to one of its materials.
fn follow(caustics: &mut [CausticDesc], old: &str, new: &str) {
    for mesh in caustics.iter_mut().filter_map(|caustic| caustic.mesh.as_mut()) {
        let material = mesh.strip_prefix(old).filter(|rest| rest.is_empty() || rest.starts_with('/'));
        if let Some(rest) = material {
            *mesh = format!("{new}{rest}");
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn caustics_follow_the_name_of_their_mesh_and_of_no_other() {
        let of = |mesh: &str| CausticDesc { mesh: Some(mesh.into()), ..CausticDesc::default() };
        let mut caustics = [of("glass"), of("glass/stem"), of("glassy")];
        follow(&mut caustics, "glass", "cup");
        assert_eq!(caustics, [of("cup"), of("cup/stem"), of("glassy")]);
    }
}
