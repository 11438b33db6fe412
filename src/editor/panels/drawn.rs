//! What was drawn: a list of directed lines and walls, and the values of those that are selected.

mod group;
pub(super) mod row;
mod values;

use std::collections::BTreeSet;

use egui::Ui;
use lightloom_core::constraint::Constraint;

use super::control::Control;
use super::icons::Icon;
use super::widgets::{icon_button, remove_button, section};
use crate::editor::action::Action;
use crate::editor::context::EditorContext;
use crate::editor::document::Edit;
use crate::editor::selection::Selection;
use crate::editor::tools::groups;

/// The settings of this panel.
pub(super) const CONTROLS: &[Control] = values::CONTROLS;

/// The panel of what was drawn.
pub(super) fn show(ui: &mut Ui, editor: &mut EditorContext) {
    let constraints = &editor.document.project().constraints;
    if constraints.is_empty() {
        ui.label("Nothing is drawn yet.");
        ui.weak("Take the tool for directed lines or for walls and draw on the plane: light follows the lines and never crosses the walls.");
        return;
    }
    tools(ui, editor, constraints);
    ui.scope(|ui| {
        ui.spacing_mut().item_spacing.y = 1.0;
        for (name, members) in groups::groups(constraints) {
            let folded = !name.is_empty() && group::header(ui, editor, constraints, name, &members);
            for &index in members.iter().filter(|_| !folded) {
                row::show(ui, editor, &constraints[index], index);
            }
        }
    });
    let chosen: Vec<usize> =
        editor.session.selection.constraints().filter(|index| *index < constraints.len()).collect();
    match chosen[..] {
        [] => {
            ui.add_space(8.0);
            ui.weak("Select a line or a wall for its values.");
        }
        [one] => section(ui, &row::title(&constraints[one], one)),
        _ => section(ui, &format!("{} selected", chosen.len())),
    }
    values::show(ui, editor, constraints, &chosen);
}

/// Buttons for what is selected: further up, further down, away.
fn tools(ui: &mut Ui, editor: &mut EditorContext, constraints: &[Constraint]) {
    let chosen: BTreeSet<usize> = editor.session.selection.constraints().collect();
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        ui.add_enabled_ui(!chosen.is_empty(), |ui| {
            for (icon, name, down) in [(Icon::Up, "Move up", false), (Icon::Down, "Move down", true)] {
                if icon_button(ui, icon, name)
                    && let Some((order, selection)) = moved(constraints.len(), &chosen, down)
                {
                    let moved = order.iter().map(|&index| constraints[index].clone()).collect();
                    editor.ask(Edit::Constraints(moved));
                    editor.ask(Action::Select(Selection::all(selection)));
                }
            }
            if remove_button(ui, "Delete what is selected") {
                let free =
                    chosen.iter().copied().filter(|&i| constraints.get(i).is_some_and(|c| !c.is_locked()));
                editor.ask(Edit::Remove(free.collect()));
                editor.ask(Action::Select(Selection::default()));
            }
        });
        let lines = constraints.iter().filter(|c| matches!(c, Constraint::DirectedLine(_))).count();
        let counted =
            |count: usize, what: &str| format!("{count} {what}{}", if count == 1 { "" } else { "s" });
        ui.weak(format!("{}, {}", counted(lines, "line"), counted(constraints.len() - lines, "wall")));
    });
}

/// The order of `count` constraints after the `chosen` moved by one place, and where they are then; none at the end.
fn moved(count: usize, chosen: &BTreeSet<usize>, down: bool) -> Option<(Vec<usize>, Vec<usize>)> {
    let blocked = if down { chosen.contains(&count.checked_sub(1)?) } else { chosen.contains(&0) };
    if blocked || chosen.is_empty() {
        return None;
    }
    let mut order: Vec<usize> = (0..count).collect();
    let swap = |order: &mut Vec<usize>, index: usize| {
        let other = if down { index + 1 } else { index - 1 };
        if index < count && other < count {
            order.swap(index, other);
        }
    };
    if down {
        chosen.iter().rev().for_each(|&index| swap(&mut order, index));
    } else {
        chosen.iter().for_each(|&index| swap(&mut order, index));
    }
    let selection = (0..count).filter(|&place| chosen.contains(&order[place])).collect();
    Some((order, selection))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moving_keeps_every_constraint_and_the_selection_goes_along() {
        let (order, selection) = moved(5, &[1, 2].into(), true).unwrap_or_default();
        assert_eq!((order, selection), (vec![0, 3, 1, 2, 4], vec![2, 3]));
        let (order, selection) = moved(5, &[1, 4].into(), false).unwrap_or_default();
        assert_eq!((order, selection), (vec![1, 0, 2, 4, 3], vec![0, 3]));
        assert_eq!(moved(5, &[0, 3].into(), false), None);
        assert_eq!(moved(5, &[4].into(), true), None);
        assert_eq!(moved(0, &[].into(), true), None);
    }
}
