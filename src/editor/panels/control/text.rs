//! Words: they count when they are complete, at Enter or when the field is left; Escape keeps the old ones.

use egui::{Id, Key, TextEdit, Ui};

use super::Setting;

impl Setting {
    /// A field of words. Gives the new ones once they are complete.
    pub fn words(&self, ui: &mut Ui, index: usize, now: &str) -> Option<String> {
        let id = ui.scope_id().with((self.place, index));
        self.row(ui, false, |ui| {
            let width = ui.available_width();
            let (response, words) = field(ui, id, now, width);
            self.explain(response.accessible_name(self.spoken()));
            words
        })
        .inner
    }
}

/// A field of words beside no name; gives the new ones once they are complete.
pub(in crate::editor::panels) fn field(
    ui: &mut Ui,
    id: Id,
    now: &str,
    width: f32,
) -> (egui::Response, Option<String>) {
    let mut words: String = ui.data_mut(|data| data.get_temp(id)).unwrap_or_else(|| now.to_owned());
    let response = ui.add(TextEdit::singleline(&mut words).id(id).desired_width(width));
    if response.has_focus() {
        ui.data_mut(|data| data.insert_temp(id, words));
        return (response, None);
    }
    ui.data_mut(|data| data.remove::<String>(id));
    let complete = response.lost_focus() && !ui.input(|input| input.key_pressed(Key::Escape));
    let new = (complete && words != now).then_some(words);
    (response, new)
}
