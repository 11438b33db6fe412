//! The label of a value in a form.

use egui::{Label, RichText, Sense, Ui};

/// A label that is strong where `value` differs from `default`; a double click resets the value.
pub(super) fn reset_label<T: Clone + PartialEq>(
    ui: &mut Ui,
    label: &str,
    tooltip: &str,
    value: &mut T,
    default: &T,
) {
    let text = if value == default { RichText::new(label) } else { RichText::new(label).strong() };
    let response = ui.add(Label::new(text).sense(Sense::click()));
    if response.on_hover_text(format!("{tooltip} Double click resets it.")).double_clicked() {
        value.clone_from(default);
    }
}
