//! Choices and switches.

use egui::{Button, Color32, ComboBox, TextStyle, Ui};

use super::Control;
use crate::editor::panels::icons::{self, Icon};

/// Most choices that stand side by side.
const SIDE_BY_SIDE: usize = 3;
/// Room between them, and beside their labels, points.
const GAP: f32 = 2.0;
const PADDING: f32 = 2.0;

impl Control {
    /// One of `values`, in the order of the choices. Whether it changed.
    pub fn choose<T: PartialEq + Clone>(&self, ui: &mut Ui, value: &mut T, values: &[T]) -> bool {
        let now = values.iter().position(|other| other == value).unwrap_or(0);
        match self.pick(ui, now).and_then(|index| values.get(index)) {
            Some(new) if new != value => {
                *value = new.clone();
                true
            }
            _ => false,
        }
    }

    /// The index of another choice than `now` that was picked.
    pub fn pick(&self, ui: &mut Ui, now: usize) -> Option<usize> {
        let row = self.row(ui, now != 0, |ui| {
            match self.widths(ui).filter(|_| self.labels.len() <= SIDE_BY_SIDE) {
                Some(widths) => self.side_by_side(ui, now, &widths),
                None => self.list(ui, now),
            }
        });
        if row.reset { Some(0).filter(|_| now != 0) } else { row.inner.filter(|index| *index != now) }
    }

    /// As [`Self::pick`], where no choice is the default; always a list.
    pub fn pick_another(&self, ui: &mut Ui, now: usize) -> Option<usize> {
        self.row(ui, false, |ui| self.list(ui, now)).inner.filter(|index| *index != now)
    }

    /// One of some names, or none, labelled `none`. A name that exists no more stays until another is chosen. Whether
    /// it changed.
    pub fn one_of<'a>(
        &self,
        ui: &mut Ui,
        value: &mut Option<String>,
        names: impl Iterator<Item = &'a str>,
        none: &str,
    ) -> bool {
        let before = value.clone();
        let row = self.row(ui, before.is_some(), |ui| {
            let shown = before.as_deref().unwrap_or(none);
            let list = ComboBox::from_id_salt(self.setting.place)
                .selected_text(shown)
                .width(ui.available_width())
                .truncate()
                .show_ui(ui, |ui| {
                    ui.selectable_value(value, None, none);
                    for name in names {
                        ui.selectable_value(value, Some(name.to_owned()), name);
                    }
                });
            self.with_tooltip(list.response.accessible_name(self.accessible_name()));
        });
        if row.reset {
            *value = None;
        }
        before != *value
    }

    /// The widths of buttons side by side that show their labels in full; none where there is no room. Short labels leave
    /// theirs to long ones.
    fn widths(&self, ui: &Ui) -> Option<Vec<f32>> {
        let font = TextStyle::Button.resolve(ui.style());
        let wide = |label: &&str| {
            let galley = ui.painter().layout_no_wrap((*label).to_owned(), font.clone(), Color32::WHITE);
            galley.size().x.ceil() + 2.0 * PADDING + 2.0
        };
        let needed: Vec<f32> = self.labels.iter().map(wide).collect();
        let count = needed.len().max(1) as f32;
        let room = ui.available_width() - GAP * (count - 1.0);
        let even = room / count;
        if needed.iter().all(|width| *width <= even) {
            return Some(vec![even; needed.len()]);
        }
        let spare = (room - needed.iter().sum::<f32>()) / count;
        (spare >= 0.0).then(|| needed.iter().map(|width| width + spare).collect())
    }

    fn side_by_side(&self, ui: &mut Ui, now: usize, widths: &[f32]) -> Option<usize> {
        ui.spacing_mut().item_spacing.x = GAP;
        let height = ui.spacing().interact_size.y;
        ui.spacing_mut().button_padding.x = PADDING;
        let mut picked = None;
        for (i, (label, width)) in self.labels.iter().zip(widths).enumerate() {
            let size = egui::vec2(*width, height);
            let button = Button::selectable(i == now, *label).frame_when_inactive(true).truncate();
            let response = ui.add_sized(size, button);
            let response = response.accessible_name(format!("{}: {label}", self.accessible_name()));
            if self.with_tooltip(response).clicked() {
                picked = Some(i);
            }
        }
        picked
    }

    fn list(&self, ui: &mut Ui, now: usize) -> Option<usize> {
        let mut picked = None;
        let shown = self.labels.get(now).copied().unwrap_or_default();
        let list = ComboBox::from_id_salt(self.setting.place)
            .selected_text(shown)
            .width(ui.available_width())
            .truncate()
            .show_ui(ui, |ui| {
                for (i, (label, choice)) in self.labels.iter().zip(self.setting.choices).enumerate() {
                    if ui.selectable_label(i == now, *label).on_hover_text(choice.help).clicked() {
                        picked = Some(i);
                    }
                }
            });
        self.with_tooltip(list.response.accessible_name(self.accessible_name()));
        picked
    }

    /// On or off. Whether it changed.
    pub fn toggle(&self, ui: &mut Ui, value: &mut bool) -> bool {
        let before = *value;
        let default = self.setting.is_on();
        let row = self.row(ui, before != default, |ui| {
            let response = ui.checkbox(value, "").accessible_name(self.accessible_name());
            self.with_tooltip(response);
        });
        if row.reset {
            *value = default;
        }
        before != *value
    }
}

/// A menu of ready values behind a button called `name`: the index of the one that was picked.
pub(in crate::editor::panels) fn preset_menu<'a>(
    ui: &mut Ui,
    name: &str,
    items: impl Iterator<Item = &'a str>,
) -> Option<usize> {
    let mut taken = None;
    let button = icons::button(ui, Icon::List, name, true);
    egui::Popup::menu(&button).show(|ui| {
        for (i, item) in items.enumerate() {
            if ui.button(item).clicked() {
                taken = Some(i);
                ui.close();
            }
        }
    });
    taken
}
