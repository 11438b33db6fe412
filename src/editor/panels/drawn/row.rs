//! One line of the list: kind, name, eye, padlock.

use egui::{Align2, CornerRadius, Id, Rect, Role, Sense, TextStyle, Ui, WidgetInfo, pos2, vec2};
use lightloom_core::constraint::Constraint;

use crate::editor::action::Action;
use crate::editor::context::EditorContext;
use crate::editor::document::Edit;
use crate::editor::panels::control::text;
use crate::editor::panels::icons::{self, Icon};
use crate::editor::selection::Selection;
use crate::editor::theme;

/// Height of a line, points.
pub(super) const HEIGHT: f32 = 24.0;
/// Width of a button at its end, points.
pub(super) const BUTTON: f32 = 24.0;
/// Indent of the members of a group, points.
const INDENT: f32 = 12.0;
/// Room for the sign of the kind, points.
const SIGN: f32 = 26.0;

/// The name of a constraint in the list: its own, or its kind and number.
pub(crate) fn title(constraint: &Constraint, index: usize) -> String {
    let (kind, name) = match constraint {
        Constraint::DirectedLine(line) => ("Line", &line.name),
        Constraint::Wall(wall) => ("Wall", &wall.name),
    };
    if name.is_empty() { format!("{kind} {}", index + 1) } else { name.clone() }
}

/// One constraint in the list.
pub(super) fn show(ui: &mut Ui, editor: &mut EditorContext, constraint: &Constraint, index: usize) {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), HEIGHT), Sense::click());
    let selected = editor.session.selection.contains(index);
    let name = title(constraint, index);
    response.widget_info(|| WidgetInfo::selected(Role::ListBoxOption, ui.is_enabled(), selected, &name));
    let visuals = ui.visuals();
    let fill = match (selected, response.hovered()) {
        (true, _) => visuals.selection.bg_fill,
        (false, true) => visuals.widgets.hovered.weak_bg_fill,
        (false, false) => visuals.faint_bg_color,
    };
    ui.painter().rect_filled(rect, CornerRadius::same(3), fill);
    let indent = if constraint.group().is_empty() { 0.0 } else { INDENT };
    sign(ui, rect.translate(vec2(indent, 0.0)), constraint);
    let buttons = rect.with_min_x(rect.right() - 2.0 * BUTTON);
    let words = rect.with_min_x(rect.left() + SIGN + indent).with_max_x(buttons.left());
    let renaming = Id::unique("renamed constraint");
    if ui.data(|data| data.get_temp::<usize>(renaming)) == Some(index) {
        rename(ui, editor, constraint, index, words);
    } else {
        let colour = if constraint.is_enabled() { visuals.text_color() } else { visuals.weak_text_color() };
        let font = TextStyle::Body.resolve(ui.style());
        ui.painter_at(words).text(words.left_center(), Align2::LEFT_CENTER, &name, font, colour);
    }
    if response.double_clicked() && !constraint.is_locked() {
        ui.data_mut(|data| data.insert_temp(renaming, index));
        ui.memory_mut(|memory| memory.request_focus(field_id(index)));
    } else if response.clicked() {
        editor.ask(Action::Select(select(ui, &editor.session.selection, index)));
    }
    response.on_hover_text("Click selects, Shift or Ctrl adds, double click renames.");
    switches(ui, editor, constraint, index, buttons);
}

/// The selection after a click on a line of the list.
fn select(ui: &Ui, now: &Selection, index: usize) -> Selection {
    if !ui.input(|input| input.modifiers.shift || input.modifiers.command) {
        return Selection::one(index);
    }
    let mut selection = now.clone();
    selection.toggle(index);
    selection
}

/// An arrow for a line, a bar for a wall, in the colours of the plane.
fn sign(ui: &Ui, row: Rect, constraint: &Constraint) {
    let (left, right) = (row.left() + 7.0, row.left() + 20.0);
    let y = row.center().y;
    let fade = if constraint.is_enabled() { 1.0 } else { 0.4 };
    match constraint {
        Constraint::DirectedLine(_) => {
            let stroke = egui::Stroke::new(1.8, theme::LINE.gamma_multiply(fade));
            ui.painter().arrow(pos2(left, y + 3.0), vec2(right - left, -6.0), stroke);
        }
        Constraint::Wall(_) => {
            let stroke = egui::Stroke::new(3.0, theme::WALL.gamma_multiply(fade));
            ui.painter().line_segment([pos2(left, y + 4.0), pos2(right, y - 4.0)], stroke);
        }
    }
}

fn field_id(index: usize) -> Id {
    Id::unique(("name of constraint", index))
}

fn rename(ui: &mut Ui, editor: &mut EditorContext, constraint: &Constraint, index: usize, words: Rect) {
    let now = match constraint {
        Constraint::DirectedLine(line) => &line.name,
        Constraint::Wall(wall) => &wall.name,
    };
    let mut place = ui.new_child(egui::UiBuilder::new().max_rect(words));
    let (response, new) = text::field(&mut place, field_id(index), now, words.width());
    if let Some(new) = new {
        editor.ask(Edit::Change(vec![(index, constraint.with(|common| *common.name = new))]));
    }
    if response.lost_focus() || !response.has_focus() {
        ui.data_mut(|data| data.remove::<usize>(Id::unique("renamed constraint")));
    }
    response.accessible_name("Name");
}

fn switches(ui: &mut Ui, editor: &mut EditorContext, constraint: &Constraint, index: usize, place: Rect) {
    let name = title(constraint, index);
    let (eye, padlock) = place.split_left_right_at_x(place.center().x);
    let on = constraint.is_enabled();
    let (icon, what) = if on { (Icon::Eye, "Switch off") } else { (Icon::EyeShut, "Switch on") };
    if icons::button_at(ui, eye, icon, &format!("{what}: {name}"), on).clicked() {
        editor.ask(Edit::Change(vec![(index, constraint.with(|common| *common.enabled = !on))]));
    }
    let locked = constraint.is_locked();
    let (icon, what) = if locked { (Icon::Lock, "Unlock") } else { (Icon::LockOpen, "Lock") };
    if icons::button_at(ui, padlock, icon, &format!("{what}: {name}"), locked).clicked() {
        editor.ask(Edit::Change(vec![(index, constraint.with(|common| *common.locked = !locked))]));
    }
}
