//! Meshes: their files, places and materials.

use egui::Ui;
use lightloom_core::project::CausticDesc;
use lightloom_core::scene::{Material, MeshDesc, SceneDesc};

use super::list::{XYZ, list};
use super::materials;
use crate::editor::action::Action;
use crate::editor::asset::AssetUse;
use crate::editor::context::EditorContext;
use crate::editor::panels::setting::Setting;
use crate::editor::panels::{remove_button, section, shows};
use crate::editor::unique_name::unique_name;

const NAME: Setting =
    Setting::text("Name", "scene.meshes[].name").help("Shown in the list of caustics; each name once.");
const FILE: Setting =
    Setting::part("File", "scene.meshes[].file").help("An OBJ file, relative to the project.");
const MOVE: Setting = Setting::vector("Place", "scene.meshes[].transform.translate", [-1e6, 1e6], &[0.0; 3])
    .help("Where the file's origin stands, x y z in metres; y is up.");
const TURN: Setting =
    Setting::vector("Turn", "scene.meshes[].transform.rotate", [-36_000.0, 36_000.0], &[0.0; 3])
        .help("Turn about the x, then y, then z axis in degrees.");
const SCALE: Setting = Setting::real("Scale", "scene.meshes[].transform.scale", [1e-12, 1e12], &[1.0])
    .slider(0.001, 1000.0)
    .logarithmic()
    .help("Factor on the file's units: 0.001 for a file in millimetres.");
const SMOOTH: Setting = Setting::switch("Smooth", "scene.meshes[].smooth", true)
    .help("Smooth shading over edges of less than 50 degrees; off for facets, as of a gem.");
const PRIORITY: Setting = Setting::whole("Priority", "scene.meshes[].priority", [-1000.0, 1000.0], &[0.0])
    .slider(-10.0, 10.0)
    .help("Where solids of glass overlap, as wine and its glass do, the higher priority fills the place.");

/// The settings of a mesh.
pub(super) const SETTINGS: &[Setting] = &[NAME, FILE, MOVE, TURN, SCALE, SMOOTH, PRIORITY];

/// The list, and the values of the mesh that is chosen. Caustics follow a name.
pub(super) fn show(
    ui: &mut Ui,
    editor: &mut EditorContext,
    scene: &mut SceneDesc,
    caustics: &mut [CausticDesc],
) {
    let kind = |mesh: &MeshDesc| mesh.material.as_ref().map_or("as file", materials::name);
    let names = scene.meshes.iter().map(|mesh| (mesh.name.as_str(), kind(mesh)));
    list(ui, "Mesh", names, &mut editor.session.focus.mesh);
    let chosen = editor.session.focus.mesh.filter(|index| *index < scene.meshes.len());
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        if ui.button("Add OBJ…").on_hover_text("Choose a mesh file, or drop it onto the window").clicked() {
            editor.ask(Action::PickFile(AssetUse::Mesh));
        }
        ui.add_enabled_ui(chosen.is_some(), |ui| {
            if remove_button(ui, "Remove this mesh")
                && let Some(index) = chosen
            {
                scene.meshes.remove(index);
                editor.session.focus.mesh = None;
            }
        });
    });
    let Some(index) = editor.session.focus.mesh.filter(|index| *index < scene.meshes.len()) else { return };
    let taken: Vec<String> = scene.meshes.iter().map(|mesh| mesh.name.clone()).collect();
    let mesh = &mut scene.meshes[index];
    section(ui, &mesh.name);
    if let Some(name) = NAME.words(ui, index, &mesh.name).filter(|name| !name.is_empty()) {
        let name = unique_name(&name, |name| taken.iter().any(|other| other == name));
        follow(caustics, &mesh.name, &name);
        mesh.name = name;
    }
    if shows::file(ui, &FILE, &mesh.file) {
        editor.ask(Action::PickFile(AssetUse::MeshFile(index)));
    }
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

/// Caustics of a mesh, or of one of its materials, go with its name.
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
