//! The caustics: which light through which glass, and what each does at the key frames.

mod list;

use egui::Ui;
use lightloom_core::project::{CausticDesc, CausticKey, Project};
use lightloom_core::scene::LightDesc;

use super::control::Control;
use super::widgets::{add_button, remove_button, section};
use super::{keys, shows};
use crate::editor::asset::TargetSlot;
use crate::editor::context::EditorContext;
use crate::editor::document::Edit;
use crate::editor::unique_name::unique_name;

const NAME: Control = Control::new("Name", CausticDesc::NAME);
const LIGHT: Control = Control::new("Light", CausticDesc::LIGHT);
const MESH: Control = Control::new("Mesh", CausticDesc::MESH);
const OWN: Control = Control::new("Own flow", CausticDesc::OWN_FLOW);
const COLOUR: Control = Control::new("Colour", CausticKey::COLOUR);
const BRIGHTNESS: Control = Control::new("Brightness", CausticKey::BRIGHTNESS).slider(0.0, 10.0);

/// The settings of this panel.
pub(super) const CONTROLS: &[Control] = &[NAME, LIGHT, MESH, OWN, COLOUR, BRIGHTNESS];

/// The panel of caustics.
pub(super) fn show(ui: &mut Ui, editor: &mut EditorContext) {
    let project = editor.document.project();
    if project.scene.is_none() {
        ui.label("This project has no scene.");
        ui.weak("Caustics are cast by the lights of a scene through its glass. Add one in the scene panel.");
        return;
    }
    let names = project.caustics.iter().map(|caustic| caustic.name.as_str());
    let rest = if project.caustics.is_empty() { "All light" } else { "The rest" };
    for (group, name) in names.chain([rest]).enumerate() {
        list::row(ui, editor, group, name);
    }
    let mut caustics = project.caustics.clone();
    let chosen = editor.session.focus.caustic.filter(|index| *index < caustics.len());
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        if add_button(ui, "Add a caustic") {
            let name = unique_name("caustic", |name| caustics.iter().any(|c| c.name == name));
            editor.session.focus.caustic = Some(caustics.len());
            caustics.push(CausticDesc { name, ..CausticDesc::default() });
        }
        ui.add_enabled_ui(chosen.is_some(), |ui| {
            if remove_button(ui, "Remove this caustic")
                && let Some(index) = chosen
            {
                caustics.remove(index);
                editor.session.focus.caustic = None;
            }
        });
    });
    if let Some(index) = chosen.filter(|_| caustics.len() == project.caustics.len()) {
        values(ui, editor, project, index, &mut caustics[index]);
    }
    if caustics != project.caustics {
        editor.ask(Edit::Caustics(caustics));
    }
}

fn values(
    ui: &mut Ui,
    editor: &mut EditorContext,
    project: &Project,
    index: usize,
    caustic: &mut CausticDesc,
) {
    section(ui, &caustic.name);
    if let Some(name) = NAME.text(ui, index, &caustic.name) {
        editor.ask(Edit::RenameCaustic(index, name));
    }
    if let Some(scene) = &project.scene {
        LIGHT.one_of(ui, &mut caustic.light, scene.lights.iter().map(LightDesc::name), "any");
        MESH.one_of(ui, &mut caustic.mesh, scene.meshes.iter().map(|mesh| mesh.name.as_str()), "any");
    }
    OWN.toggle(ui, &mut caustic.own_flow);
    section(ui, "At the key frame");
    let at = keys::choose(ui, editor);
    let Some(key) = project.keys.get(at) else { return };
    let before = key.caustics.get(&caustic.name).cloned().unwrap_or_default();
    let mut own = before.clone();
    let place = TargetSlot { key: at, caustic: Some(caustic.name.clone()) };
    if let Some(shows) = shows::show(ui, editor, &place, before.shows.as_ref()) {
        own.shows = shows;
    }
    COLOUR.colour(ui, &mut own.colour);
    BRIGHTNESS.number(ui, &mut own.brightness);
    if own != before {
        let mut key = key.clone();
        if own == CausticKey::default() {
            key.caustics.remove(&caustic.name);
        } else {
            key.caustics.insert(caustic.name.clone(), own);
        }
        keys::replace(editor, at, key);
    }
}
