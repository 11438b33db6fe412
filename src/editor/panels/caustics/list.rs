//! The list of caustics: eye, solo, the colour of the light, the name, and what the light and the mesh cast.

use egui::{Button, Color32, RichText, Ui, vec2};
use lightloom_core::project::{CausticDesc, Project};
use lightloom_core::scene::LightDesc;
use lightloom_core::setting::format::number;

use crate::editor::action::Action;
use crate::editor::context::EditorContext;
use crate::editor::panels::icons::{self, Icon, SIDE};

/// The row of a caustic, or of the rest of the light.
pub(super) fn row(ui: &mut Ui, editor: &mut EditorContext, group: usize, name: &str) {
    let project = editor.document.project();
    let caustic = project.caustics.get(group);
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        ui.spacing_mut().button_padding.x = 4.0;
        eye(ui, editor, group, name);
        solo(ui, editor, group, name);
        let (swatch, _) = ui.allocate_exact_size(vec2(12.0, 12.0), egui::Sense::hover());
        ui.painter().rect_filled(swatch, 2.0, colour(project, caustic));
        let shown = editor.session.shows_group(group);
        let text = if shown { RichText::new(name) } else { RichText::new(name).weak() };
        let chosen = editor.session.focus.caustic == Some(group);
        let light = RichText::new(cast(editor, group).unwrap_or_default()).small().weak();
        let size = vec2(ui.available_width(), SIDE);
        let button = Button::selectable(chosen, text).right_text(light).truncate();
        let button = ui.add_enabled_ui(caustic.is_some(), |ui| ui.add_sized(size, button)).inner;
        let help = "Flux and photons of its light and mesh, once they are traced. Click for its values.";
        if button.accessible_name(name).on_hover_text(help).clicked() {
            editor.session.focus.caustic = (!chosen).then_some(group);
        }
    });
}

fn eye(ui: &mut Ui, editor: &mut EditorContext, group: usize, name: &str) {
    let hidden = editor.session.hidden.contains(&group);
    let (icon, what) = if hidden { (Icon::EyeShut, "Show") } else { (Icon::Eye, "Hide") };
    let button = icons::button(ui, icon, &format!("{what}: {name}"), !hidden);
    if button.clicked() && !editor.session.hidden.remove(&group) {
        editor.session.hidden.insert(group);
    }
}

fn solo(ui: &mut Ui, editor: &mut EditorContext, group: usize, name: &str) {
    let on = editor.session.solo.contains(&group);
    let button = ui.add(Button::selectable(on, "S").frame(true).min_size(vec2(SIDE, SIDE)));
    let button = button.accessible_name(format!("Solo: {name}"));
    if button.on_hover_text("Show only this; several can be soloed together").clicked() {
        let mut alone = editor.session.solo.clone();
        if !alone.remove(&group) {
            alone.insert(group);
        }
        editor.ask(Action::Solo(alone));
    }
}

/// The display colour of its light at full brightness; grey where any light may cast it.
fn colour(project: &Project, caustic: Option<&CausticDesc>) -> Color32 {
    let name = caustic.and_then(|caustic| caustic.light.as_deref());
    let mut lights = project.scene.iter().flat_map(|scene| &scene.lights);
    let light = name.and_then(|name| lights.find(|light| light.name() == name));
    let [r, g, b] = light.map_or([0.5; 3], tint);
    let most = r.max(g).max(b).max(1e-6);
    egui::Rgba::from_rgb(r / most, g / most, b / most).into()
}

fn tint(light: &LightDesc) -> [f32; 3] {
    match light {
        LightDesc::Point(light) => light.colour,
        LightDesc::Spot(light) => light.colour,
        LightDesc::Directional(light) => light.colour,
        LightDesc::Rectangle(light) => light.colour,
        LightDesc::Sphere(light) => light.colour,
    }
}

/// Flux and photons of a group, such as "0.12 W, 6 500 photons"; none before its light is traced.
fn cast(editor: &EditorContext, group: usize) -> Option<String> {
    let preview = editor.preview.preview()?;
    let light = preview.caustics().get(group)?;
    let watts = format!("{:.2e}", light.watts).parse().unwrap_or(light.watts);
    let photons = number(light.photons as f64, true);
    Some(format!("{} W, {photons} photons", number(watts, false)))
}
