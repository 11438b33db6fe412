//! The head of a group in the list: fold, name, solo, eye and padlock of all its members.

use std::collections::BTreeSet;

use egui::{Align2, Button, CornerRadius, Id, Rect, Role, Sense, TextStyle, Ui, WidgetInfo, vec2};
use lightloom_core::constraint::{CommonFields, Constraint};

use super::row::{BUTTON, HEIGHT};
use crate::editor::action::Action;
use crate::editor::context::EditorContext;
use crate::editor::document::Edit;
use crate::editor::panels::control::text;
use crate::editor::panels::icons::{self, Icon};
use crate::editor::selection::Selection;
use crate::editor::tools::groups;

/// Room for the triangle that folds it, points.
const FOLD: f32 = 20.0;

/// The head of the group called `name`. Whether its members are folded away.
pub(super) fn header(
    ui: &mut Ui,
    editor: &mut EditorContext,
    constraints: &[Constraint],
    name: &str,
    members: &[usize],
) -> bool {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), HEIGHT), Sense::click());
    let all = members.iter().all(|&index| editor.session.selection.contains(index));
    let words = format!("{name} ({})", members.len());
    response.widget_info(|| WidgetInfo::selected(Role::ListBoxOption, ui.is_enabled(), all, &words));
    let visuals = ui.visuals();
    let fill = if all { visuals.selection.bg_fill } else { visuals.widgets.inactive.weak_bg_fill };
    ui.painter().rect_filled(rect, CornerRadius::same(3), fill);
    let folded = fold(ui, rect.with_max_x(rect.left() + FOLD), name);
    let buttons = rect.with_min_x(rect.right() - 3.0 * BUTTON);
    let place = rect.with_min_x(rect.left() + FOLD).with_max_x(buttons.left());
    let renaming = Id::unique("renamed group");
    if ui.data(|data| data.get_temp::<String>(renaming)).as_deref() == Some(name) {
        rename(ui, editor, constraints, (name, members), place);
    } else {
        let font = TextStyle::Button.resolve(ui.style());
        let colour = ui.visuals().strong_text_color();
        ui.painter_at(place).text(place.left_center(), Align2::LEFT_CENTER, &words, font, colour);
    }
    if response.double_clicked() {
        ui.data_mut(|data| data.insert_temp(renaming, name.to_owned()));
        ui.memory_mut(|memory| memory.request_focus(field_id(name)));
    } else if response.clicked() {
        editor.ask(Action::Select(Selection::all(members.iter().copied())));
    }
    response.on_hover_text(
        "A click selects the whole group, a double click renames it. Ctrl+Shift+G takes it apart.",
    );
    switches(ui, editor, constraints, (name, members), buttons);
    folded
}

/// The triangle that folds the members away; a matter of the window, not of the project.
fn fold(ui: &mut Ui, rect: Rect, name: &str) -> bool {
    let id = Id::unique(("folded group", name));
    let mut folded = ui.data(|data| data.get_temp::<bool>(id)).unwrap_or(false);
    let response = ui.interact(rect, id, Sense::click());
    if response.clicked() {
        folded = !folded;
        ui.data_mut(|data| data.insert_temp(id, folded));
    }
    let what = if folded { "Unfold" } else { "Fold" };
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, format!("{what}: {name}")));
    let (at, side) = (rect.center(), 4.0);
    let corners = match folded {
        true => [vec2(-side * 0.6, -side), vec2(side * 0.8, 0.0), vec2(-side * 0.6, side)],
        false => [vec2(-side, -side * 0.6), vec2(side, -side * 0.6), vec2(0.0, side * 0.8)],
    };
    let corners = corners.map(|corner| at + corner).to_vec();
    let colour = ui.visuals().text_color();
    ui.painter().add(egui::Shape::convex_polygon(corners, colour, egui::Stroke::NONE));
    folded
}

fn field_id(name: &str) -> Id {
    Id::unique(("name of group", name))
}

fn rename(
    ui: &mut Ui,
    editor: &mut EditorContext,
    constraints: &[Constraint],
    (name, members): (&str, &[usize]),
    place: Rect,
) {
    let mut inside = ui.new_child(egui::UiBuilder::new().max_rect(place));
    let (response, new) = text::field(&mut inside, field_id(name), name, place.width());
    // Without a name it would be none; of the name of another it becomes a part of that.
    if let Some(new) = new.filter(|new| !new.trim().is_empty()) {
        editor.ask(groups::renamed(constraints, members, new.trim()));
    }
    if response.lost_focus() || !response.has_focus() {
        ui.data_mut(|data| data.remove::<String>(Id::unique("renamed group")));
    }
    response.accessible_name("Name of the group");
}

fn switches(
    ui: &mut Ui,
    editor: &mut EditorContext,
    constraints: &[Constraint],
    (name, members): (&str, &[usize]),
    place: Rect,
) {
    let (solo, rest) = place.split_left_right_at_x(place.left() + BUTTON);
    let (eye, padlock) = rest.split_left_right_at_x(rest.center().x);
    let alone = groups::is_solo(constraints, &members.iter().copied().collect::<BTreeSet<_>>());
    let button = ui.put(solo.shrink(1.0), Button::selectable(alone, "S").frame(true));
    let button = button.accessible_name(format!("Solo: {name}"));
    if button.on_hover_text("Lets this group alone act; once more, and everything acts.").clicked() {
        editor.ask(groups::solo(constraints, members));
    }
    let all = |change: &dyn Fn(CommonFields)| {
        Edit::Change(members.iter().map(|&index| (index, constraints[index].with(change))).collect())
    };
    let on = members.iter().any(|&index| constraints[index].is_enabled());
    let (icon, what) = if on { (Icon::Eye, "Switch off") } else { (Icon::EyeShut, "Switch on") };
    if icons::button_at(ui, eye, icon, &format!("{what} all of {name}"), on).clicked() {
        editor.ask(all(&|common| *common.enabled = !on));
    }
    let locked = members.iter().all(|&index| constraints[index].is_locked());
    let (icon, what) = if locked { (Icon::Lock, "Unlock") } else { (Icon::LockOpen, "Lock") };
    if icons::button_at(ui, padlock, icon, &format!("{what} all of {name}"), locked).clicked() {
        editor.ask(all(&|common| *common.locked = !locked));
    }
}
