//! What the lists of meshes and lights share.

use egui::Ui;

/// Names of the components of a place.
pub(super) const XYZ: [&str; 3] = ["x", "y", "z"];

/// A list of names of which one can be chosen; a click on the chosen one closes it.
pub(super) fn list<'a>(
    ui: &mut Ui,
    kind: &str,
    names: impl Iterator<Item = (&'a str, &'a str)>,
    chosen: &mut Option<usize>,
) {
    ui.scope(|ui| {
        ui.spacing_mut().item_spacing.y = 2.0;
        for (i, (name, aside)) in names.enumerate() {
            let size = egui::vec2(ui.available_width(), 22.0);
            let button = egui::Button::selectable(*chosen == Some(i), name);
            let button = button.right_text(egui::RichText::new(aside).weak()).truncate();
            if ui.add_sized(size, button).accessible_name(format!("{kind} {name}")).clicked() {
                *chosen = if *chosen == Some(i) { None } else { Some(i) };
            }
        }
    });
}
