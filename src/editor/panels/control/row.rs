//! One line of a panel: the name on the left, the value on the right, both aligned over the whole panel.

use egui::{Align2, PointerButton, Response, Role, Sense, TextStyle, Ui, WidgetInfo, vec2};

use super::Setting;
use crate::editor::{panels::pictures, theme};

/// Width of the names, points.
pub(in crate::editor::panels) const NAMES: f32 = 104.0;
/// Room for the mark of a changed value, points.
const MARK: f32 = 9.0;
/// Width of a tooltip, points.
const TOOLTIP: f32 = 330.0;

/// What was done in a row.
pub(in crate::editor::panels) struct Row<R> {
    /// What its widgets gave.
    pub inner: R,
    /// Whether the default is asked for.
    pub reset: bool,
}

impl Setting {
    /// The name, the mark of a `changed` value, and `widgets` in the room on the right.
    pub(in crate::editor::panels) fn row<R>(
        &self,
        ui: &mut Ui,
        changed: bool,
        widgets: impl FnOnce(&mut Ui) -> R,
    ) -> Row<R> {
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = 4.0;
            self.name(ui, changed);
            let inner = widgets(ui);
            // On the name or on the value: a slider knows no clicks.
            let twice = ui.input(|input| input.pointer.button_double_clicked(PointerButton::Primary));
            Row { inner, reset: twice && ui.rect_contains_pointer(ui.min_rect()) }
        })
        .inner
    }

    /// One of several lines of a value that has more; only the `first` bears the name.
    pub(in crate::editor::panels) fn line<R>(
        &self,
        ui: &mut Ui,
        first: bool,
        widgets: impl FnOnce(&mut Ui) -> R,
    ) -> R {
        if first {
            return self.row(ui, false, widgets).inner;
        }
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = 4.0;
            ui.add_space(NAMES + 4.0);
            widgets(ui)
        })
        .inner
    }

    fn name(&self, ui: &mut Ui, changed: bool) {
        let size = vec2(NAMES, ui.spacing().interact_size.y);
        let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
        let painter = ui.painter_at(rect);
        let colour = if changed { ui.visuals().strong_text_color() } else { ui.visuals().text_color() };
        let at = rect.left_center() + vec2(MARK, 0.0);
        painter.text(at, Align2::LEFT_CENTER, self.name, TextStyle::Body.resolve(ui.style()), colour);
        if changed {
            painter.circle_filled(rect.left_center() + vec2(3.0, 0.0), 2.5, theme::ACCENT);
        }
        response.widget_info(|| WidgetInfo::labeled(Role::Label, ui.is_enabled(), self.name));
        self.explain(response);
    }

    /// What a screen reader says: the name, and whose it is where several parts of a panel have one of that name.
    pub(in crate::editor::panels) fn spoken(&self) -> String {
        let owners = [
            ("scene.meshes", "Mesh"),
            ("scene.lights", "Light"),
            ("scene.camera", "Camera"),
            ("scene.receiver", "Receiver"),
        ];
        let owner = owners.iter().find(|(place, _)| self.place.starts_with(place));
        owner.map_or_else(|| self.name.to_owned(), |(_, owner)| format!("{owner}: {}", self.name))
    }

    /// The tooltip of this setting.
    pub(super) fn explain(&self, response: Response) -> Response {
        response.on_hover_ui(|ui| {
            ui.set_max_width(TOOLTIP);
            ui.strong(self.name);
            if !self.help.is_empty() {
                ui.label(self.help);
            }
            for choice in self.options.iter().filter(|choice| !choice.help.is_empty()) {
                ui.label(format!("{}: {}", choice.name, choice.help));
            }
            if let Some(trio) = self.pictures {
                pictures::show(ui, trio);
            }
            let words = self.in_words();
            if !words.is_empty() {
                ui.weak(format!("{words}. Double click resets."));
            }
        })
    }
}
