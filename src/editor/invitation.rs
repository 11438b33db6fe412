//! The invitation of a project without glass: what to do first.

use egui::{Align2, Area, Frame, Id, Order, Rect, RichText, Ui};

use super::command::Command;
use super::context::EditorContext;
use super::theme;

/// Shows the invitation in the middle of the views.
pub(super) fn show(ui: &Ui, views: Rect, editor: &mut EditorContext) {
    let area = Area::new(Id::unique("invitation"))
        .pivot(Align2::CENTER_CENTER)
        .fixed_pos(views.center())
        .order(Order::Middle)
        .constrain_to(views);
    area.show(ui.ctx(), |ui| {
        Frame::popup(ui.style()).inner_margin(20).shadow(egui::Shadow::NONE).show(ui, |ui| {
            ui.vertical_centered(|ui| {
                ui.set_max_width(300.0);
                ui.label(RichText::new("Import a glass").heading());
                ui.add_space(2.0);
                ui.label("Ctrl+I, or drop a .glb, .gltf or .obj here.");
                ui.weak("It is set on the table, the lamp and the camera are aimed at it.");
                ui.add_space(8.0);
                let button = egui::Button::new(RichText::new("Import…").color(egui::Color32::WHITE));
                if ui.add(button.fill(theme::ACCENT.gamma_multiply(0.8))).clicked() {
                    editor.ask(Command::Import);
                }
            });
        });
    });
}
