//! The panels: they read the document and return actions. One panel, one file, one line in [`PANELS`].

mod caustics;
pub mod control;
mod drawn;
mod fade;
mod flow;
mod icons;
mod keys;
mod pictures;
mod presets;
pub(super) mod readouts;
mod render;
mod scene;
mod shows;
mod turbulence;
mod widgets;

use egui::{Button, ScrollArea, Ui};

pub use control::Control;
pub(crate) use drawn::row::title;
pub(in crate::editor) use keys::EASE;
pub use pictures::Trio;
pub use presets::{PRESETS, Preset};
pub(in crate::editor) use render::layer_boxes;
pub(in crate::editor) use scene::lamp_words;

use super::context::EditorContext;
use super::session::Panel;

/// A panel on the right of the window.
#[derive(Clone, Copy)]
pub struct PanelInfo {
    /// Its identifier.
    pub panel: Panel,
    /// Its label.
    pub name: &'static str,
    /// Its tooltip.
    pub help: &'static str,
    show: fn(&mut Ui, &mut EditorContext),
    controls: &'static [&'static [Control]],
}

/// All panels, in the order of their tabs.
#[rustfmt::skip]
pub const PANELS: &[PanelInfo] = &[
    PanelInfo { panel: Panel::Flow, name: "Flow", help: "How the light flows: gamma, smoothness, turbulence", show: flow::show, controls: &[flow::CONTROLS, turbulence::CONTROLS, fade::CONTROLS] },
    PanelInfo { panel: Panel::Drawn, name: "Drawn", help: "Directed lines and walls", show: drawn::show, controls: &[drawn::CONTROLS] },
    PanelInfo { panel: Panel::Caustics, name: "Caustics", help: "Which light through which glass", show: caustics::show, controls: &[caustics::CONTROLS] },
    PanelInfo { panel: Panel::Keys, name: "Keys", help: "What the light shows at the key frames", show: keys::show, controls: &[keys::CONTROLS, shows::CONTROLS] },
    PanelInfo { panel: Panel::Scene, name: "Scene", help: "Glass, lights, camera, receiver", show: scene::show, controls: scene::CONTROLS },
    PanelInfo { panel: Panel::Render, name: "Render", help: "Size, photons, files", show: render::show, controls: &[render::CONTROLS] },
    PanelInfo { panel: Panel::Numbers, name: "Numbers", help: "Energy, walls, solver, time", show: readouts::show, controls: &[] },
];

/// The panel that has the notes on the project.
pub(in crate::editor) const NOTES: Panel = Panel::Numbers;

/// The controls of all panels.
pub fn controls() -> impl Iterator<Item = &'static Control> {
    PANELS.iter().flat_map(|entry| entry.controls).copied().flatten()
}

/// The controls of all panels with their panel.
pub fn controls_by_panel() -> impl Iterator<Item = (&'static PanelInfo, &'static Control)> {
    PANELS
        .iter()
        .flat_map(|entry| entry.controls.iter().copied().flatten().map(move |control| (entry, control)))
}

/// The tabs, and the selected panel.
pub fn show(ui: &mut Ui, editor: &mut EditorContext) {
    ui.data_mut(|data| data.insert_temp(control::row::panel_left(), ui.max_rect().left()));
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing = egui::vec2(2.0, 2.0);
        for entry in PANELS {
            let tab = Button::selectable(editor.session.panel == entry.panel, entry.name);
            if ui.add(tab).on_hover_text(entry.help).clicked() {
                editor.session.panel = entry.panel;
            }
        }
    });
    ui.separator();
    let Some(entry) = PANELS.iter().find(|entry| entry.panel == editor.session.panel) else { return };
    // The place of one panel is not that of the next.
    ScrollArea::vertical().id_salt(entry.name).auto_shrink(false).show(ui, |ui| {
        // Room for the bar, so that nothing jumps when it appears.
        ui.set_max_width(ui.available_width() - 4.0);
        (entry.show)(ui, editor);
    });
}
