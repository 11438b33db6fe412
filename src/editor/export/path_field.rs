//! The field of a path: it shows the path's end while nobody types.

use std::path::{Path, PathBuf};

use egui::text::{CCursor, CCursorRange};
use egui::{Color32, Response, TextEdit, TextStyle, Ui};

/// Shows the field of the given width, points, under its accessible name.
pub(super) fn path_field(ui: &mut Ui, path: &mut PathBuf, width: f32, name: &str) -> Response {
    let id = ui.make_persistent_id(name);
    let is_edited = ui.memory(|memory| memory.has_focus(id));
    let whole = path.to_string_lossy().into_owned();
    let mut text = if is_edited { whole.clone() } else { end_of(ui, path, width) };
    let mut shown = TextEdit::singleline(&mut text).id(id).desired_width(width).show(ui);
    if shown.response.gained_focus() {
        // The end is what changes, and what was seen.
        let end = CCursor::new(whole.chars().count());
        shown.state.cursor.set_char_range(Some(CCursorRange::one(end)));
        shown.state.store(ui.ctx(), id);
    }
    let response = shown.response.response;
    if is_edited && response.changed() {
        *path = text.into();
    }
    response.accessible_name(name).on_hover_text(whole)
}

/// As many of the last parts of a path as fit, at least one.
fn end_of(ui: &Ui, path: &Path, width: f32) -> String {
    let font = TextStyle::Body.resolve(ui.style());
    let room = width - ui.spacing().button_padding.x * 2.0;
    let fits = |text: &str| {
        let galley = ui.painter().layout_no_wrap(text.to_owned(), font.clone(), Color32::WHITE);
        galley.size().x <= room
    };
    let whole = path.to_string_lossy();
    let mut shown = whole.clone().into_owned();
    for (at, _) in whole.char_indices().filter(|(at, c)| *at > 0 && std::path::is_separator(*c)) {
        if fits(&shown) {
            break;
        }
        shown = format!("…{}", &whole[at..]);
    }
    shown
}
