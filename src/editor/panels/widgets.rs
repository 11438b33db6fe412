//! Widgets that several panels share.

use egui::{CollapsingHeader, Ui};

use super::control::row::LABELS;
use super::icons::{self, Icon};

/// A collapsible part that is closed at first.
pub(super) fn fold(ui: &mut Ui, name: &str, add: impl FnOnce(&mut Ui)) {
    ui.add_space(4.0);
    // Not indented: names and values stay aligned with those above.
    CollapsingHeader::new(name).show_unindented(ui, add);
}

/// A heading over a part of a panel.
pub(super) fn section(ui: &mut Ui, name: &str) {
    ui.add_space(8.0);
    ui.strong(name);
}

/// A small note below the value above.
pub(super) fn aside(ui: &mut Ui, words: &str) {
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 0.0;
        ui.add_space(LABELS + 4.0);
        // Never wider than the panel: all that follows would be, too.
        ui.add(egui::Label::new(egui::RichText::new(words).small()).truncate());
    });
}

/// A button with an icon. Whether it was clicked.
pub(super) fn icon_button(ui: &mut Ui, icon: Icon, name: &str) -> bool {
    icons::button(ui, icon, name, true).clicked()
}

/// A button with a plus sign.
pub(super) fn add_button(ui: &mut Ui, name: &str) -> bool {
    icon_button(ui, Icon::Add, name)
}

/// A button with a cross.
pub(super) fn remove_button(ui: &mut Ui, name: &str) -> bool {
    icon_button(ui, Icon::Remove, name)
}

/// A menu button: the index of the item that was picked.
pub(super) fn menu<'a>(
    ui: &mut Ui,
    name: &str,
    items: impl IntoIterator<Item = (&'a str, &'a str)>,
) -> Option<usize> {
    let mut taken = None;
    ui.menu_button(name, |ui| {
        for (i, (item, help)) in items.into_iter().enumerate() {
            let mut button = ui.button(item);
            if !help.is_empty() {
                button = button.on_hover_text(help);
            }
            if button.clicked() {
                taken = Some(i);
                ui.close();
            }
        }
    });
    taken
}

/// Names of the components of a position.
pub(super) const XYZ: [&str; 3] = ["x", "y", "z"];
