//! One of a few, and yes or no.

use egui::{Button, ComboBox, Ui};

use super::Setting;
use crate::editor::panels::icons::{self, Icon};

/// Something that can be chosen.
#[derive(Clone, Copy, Debug)]
pub struct Choice {
    /// Its name in project files; empty where it has none of its own.
    pub value: &'static str,
    /// What the window calls it.
    pub name: &'static str,
    /// What it does to the picture.
    pub help: &'static str,
}

impl Choice {
    /// A choice.
    pub const fn new(value: &'static str, name: &'static str, help: &'static str) -> Self {
        Self { value, name, help }
    }
}

/// Up to so many stand side by side.
const SIDE_BY_SIDE: usize = 3;

impl Setting {
    /// One of `values`, in the order of the options. Answers whether it is another now.
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

    /// One of the options, `now` being chosen. Gives the number of another one that was chosen.
    pub fn pick(&self, ui: &mut Ui, now: usize) -> Option<usize> {
        let row = self.row(ui, now != 0, |ui| {
            if self.options.len() <= SIDE_BY_SIDE { self.side_by_side(ui, now) } else { self.list(ui, now) }
        });
        if row.reset && now != 0 { Some(0) } else { row.inner.filter(|index| *index != now) }
    }

    /// As [`Self::pick`], where no option is the default; always a list.
    pub fn pick_another(&self, ui: &mut Ui, now: usize) -> Option<usize> {
        self.row(ui, false, |ui| self.list(ui, now)).inner.filter(|index| *index != now)
    }

    /// One of some names, or none, which is called `none`. A name that stands nowhere any more stays until another is chosen.
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
            let list = ComboBox::from_id_salt(self.place)
                .selected_text(shown)
                .width(ui.available_width())
                .truncate()
                .show_ui(ui, |ui| {
                    ui.selectable_value(value, None, none);
                    for name in names {
                        ui.selectable_value(value, Some(name.to_owned()), name);
                    }
                });
            self.explain(list.response.accessible_name(self.spoken()));
        });
        if row.reset {
            *value = None;
        }
        before != *value
    }

    fn side_by_side(&self, ui: &mut Ui, now: usize) -> Option<usize> {
        ui.spacing_mut().item_spacing.x = 2.0;
        let count = self.options.len().max(1) as f32;
        let width = (ui.available_width() - 2.0 * (count - 1.0)) / count;
        let size = egui::vec2(width, ui.spacing().interact_size.y);
        ui.spacing_mut().button_padding.x = 2.0;
        let mut picked = None;
        for (i, choice) in self.options.iter().enumerate() {
            let button = Button::selectable(i == now, choice.name).frame_when_inactive(true).truncate();
            let response = ui.add_sized(size, button);
            let response = response.accessible_name(format!("{}: {}", self.spoken(), choice.name));
            if self.explain(response).clicked() {
                picked = Some(i);
            }
        }
        picked
    }

    fn list(&self, ui: &mut Ui, now: usize) -> Option<usize> {
        let mut picked = None;
        let shown = self.options.get(now).map_or("", |choice| choice.name);
        let list = ComboBox::from_id_salt(self.place)
            .selected_text(shown)
            .width(ui.available_width())
            .truncate()
            .show_ui(ui, |ui| {
                for (i, choice) in self.options.iter().enumerate() {
                    let mut item = ui.selectable_label(i == now, choice.name);
                    if !choice.help.is_empty() {
                        item = item.on_hover_text(choice.help);
                    }
                    if item.clicked() {
                        picked = Some(i);
                    }
                }
            });
        self.explain(list.response.accessible_name(self.spoken()));
        picked
    }

    /// Yes or no. Answers whether it is another now.
    pub fn toggle(&self, ui: &mut Ui, value: &mut bool) -> bool {
        let before = *value;
        let default = self.default == [1.0];
        let row = self.row(ui, before != default, |ui| {
            let response = ui.checkbox(value, "").accessible_name(self.spoken());
            self.explain(response);
        });
        if row.reset && before == *value {
            *value = default;
        }
        before != *value
    }
}

/// A list of ready values, called `name`; gives the number of the one that was taken.
pub(in crate::editor::panels) fn presets<'a>(
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
