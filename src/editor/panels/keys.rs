//! The key frames: what the light shows, and how the time runs to the next.

use egui::Ui;
use lightloom_core::project::{Ease, KeyFrame};

use super::control::Control;
use super::shows;
use super::widgets::{aside, remove_button};
use crate::editor::action::Action;
use crate::editor::asset::TargetSlot;
use crate::editor::command::Command;
use crate::editor::context::EditorContext;
use crate::editor::document::Edit;

const FRAME: Control = Control::new("Frame", KeyFrame::FRAME);
/// How the time runs to the next key frame, with the names of [`Ease::ALL`].
pub(in crate::editor) const EASE: Control =
    Control::new("Ease", KeyFrame::EASE).labels(&["Smooth", "Linear", "Ease in", "Ease out", "Settle"]);

/// The settings of this panel.
pub(super) const CONTROLS: &[Control] = &[FRAME, EASE];

/// The key frame that the panels show: the selected one, or the last at or before the playhead.
pub(super) fn shown(editor: &EditorContext) -> usize {
    let keys = &editor.document.project().keys;
    let chosen = editor.session.focus.key.filter(|key| *key < keys.len());
    chosen
        .unwrap_or_else(|| keys.partition_point(|key| key.frame <= editor.session.playhead).saturating_sub(1))
}

/// Buttons that select a key frame and move the playhead there.
pub(super) fn choose(ui: &mut Ui, editor: &mut EditorContext) -> usize {
    let now = shown(editor);
    let keys = &editor.document.project().keys;
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing = egui::vec2(4.0, 4.0);
        for (i, key) in keys.iter().enumerate() {
            let button = egui::Button::selectable(i == now, key.frame.to_string()).frame(true);
            let response = ui.add(button).accessible_name(format!("Key frame {}", key.frame));
            if response.on_hover_text("Go to this key frame").clicked() {
                editor.session.focus.key = Some(i);
                editor.ask(Action::Playhead(key.frame));
            }
        }
    });
    now
}

/// The panel of key frames.
pub(super) fn show(ui: &mut Ui, editor: &mut EditorContext) {
    let keys = &editor.document.project().keys;
    let index = choose(ui, editor);
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        if ui.button("Add here").on_hover_text("Adds a key frame at the playhead").clicked() {
            editor.ask(Command::AddKey);
        }
        ui.add_enabled_ui(keys.len() > 1, |ui| {
            if remove_button(ui, "Remove this key frame") {
                let mut fewer = keys.clone();
                fewer.remove(index);
                editor.session.focus.key = None;
                editor.ask(Edit::Keys(fewer));
            }
        });
    });
    let Some(key) = keys.get(index) else { return };
    ui.add_space(4.0);
    let mut changed = key.clone();
    frame(ui, keys, index, &mut changed);
    EASE.choose(ui, &mut changed.ease, &Ease::ALL);
    if let Some(Some(shows)) =
        shows::show(ui, editor, &TargetSlot { key: index, caustic: None }, Some(&key.shows))
    {
        changed.shows = shows;
    }
    if !key.caustics.is_empty() {
        let names: Vec<&str> = key.caustics.keys().map(String::as_str).collect();
        aside(ui, &format!("otherwise: {}", names.join(", ")));
    }
    if changed != *key {
        replace(editor, index, changed);
    }
}

/// Replaces a key frame.
pub(super) fn replace(editor: &mut EditorContext, index: usize, key: KeyFrame) {
    let mut keys = editor.document.project().keys.clone();
    if let Some(old) = keys.get_mut(index) {
        *old = key;
        editor.ask(Edit::Keys(keys));
    }
}

/// The frame number of a key, between its neighbours.
fn frame(ui: &mut Ui, keys: &[KeyFrame], index: usize, key: &mut KeyFrame) {
    let mut control = FRAME;
    if let Some(before) = index.checked_sub(1).and_then(|i| keys.get(i)) {
        control.setting.range[0] = f64::from(before.frame) + 1.0;
    }
    if let Some(after) = keys.get(index + 1) {
        control.setting.range[1] = f64::from(after.frame) - 1.0;
    }
    let mut frame = [key.frame];
    if control.numbers(ui, &mut frame, [""]) {
        key.frame = frame[0];
    }
}
