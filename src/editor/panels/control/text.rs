//! Text: complete at Enter or when the field is left; Escape keeps the old text.

use egui::{Id, Key, TextEdit, Ui};

use super::Control;

impl Control {
    /// A field of text: the new text once it is complete.
    pub fn text(&self, ui: &mut Ui, index: usize, now: &str) -> Option<String> {
        let id = ui.scope_id().with((self.setting.place, index));
        self.row(ui, false, |ui| {
            let width = ui.available_width();
            let (response, text) = field(ui, id, now, width);
            self.with_tooltip(response.accessible_name(self.accessible_name()));
            text
        })
        .inner
    }
}

/// A field of text without label: the new text once it is complete.
pub(in crate::editor::panels) fn field(
    ui: &mut Ui,
    id: Id,
    now: &str,
    width: f32,
) -> (egui::Response, Option<String>) {
    let mut text: String = ui.data_mut(|data| data.get_temp(id)).unwrap_or_else(|| now.to_owned());
    let response = ui.add(TextEdit::singleline(&mut text).id(id).desired_width(width));
    if response.has_focus() {
        ui.data_mut(|data| data.insert_temp(id, text));
        return (response, None);
    }
    ui.data_mut(|data| data.remove::<String>(id));
    let complete = response.lost_focus() && !ui.input(|input| input.key_pressed(Key::Escape));
    let new = (complete && text != now).then_some(text);
    (response, new)
}
