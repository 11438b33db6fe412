//! A row of a panel: the label on the left, the value on the right, both aligned over the whole panel.

use egui::{
    Align, Align2, Id, RectAlign, Response, Role, Sense, Stroke, StrokeKind, TextStyle, Tooltip, Ui,
    WidgetInfo, vec2,
};

use super::Control;
use crate::editor::{panels::pictures, theme};

/// Width of the labels, points.
pub(in crate::editor::panels) const LABELS: f32 = 104.0;
/// Room for the mark of a changed value, points.
const MARK: f32 = 9.0;
/// Width of a tooltip, points.
const TOOLTIP: f32 = 330.0;

/// Shows a tooltip at the height of a row, left of its panel: the next rows stay free.
fn beside_panel(response: &Response, content: impl FnOnce(&mut Ui)) {
    let mut tooltip = Tooltip::for_enabled(response);
    let left = response.ctx.data(|data| data.get_temp::<f32>(panel_left()));
    if let Some(left) = left.filter(|left| *left > TOOLTIP) {
        let row = response.rect.with_min_x(left);
        tooltip.popup = tooltip.popup.anchor(row).align(RectAlign::LEFT_START).gap(8.0);
    }
    tooltip.show(content);
}

/// Where the left border of the panel is kept, points.
pub(in crate::editor::panels) fn panel_left() -> Id {
    Id::unique("left border of the panel")
}

/// Where the place of the setting is kept that was asked for by name.
fn sought() -> Id {
    Id::unique("setting that is sought")
}

/// Scrolls to the setting at this place of the project, and marks it until the next click.
pub(in crate::editor::panels) fn seek(ui: &Ui, place: &'static str) {
    ui.data_mut(|data| data.insert_temp(sought(), (place, true)));
}

/// Marks the row of the setting that is sought.
fn mark_sought(ui: &Ui, response: &Response, place: &str) {
    let Some((wanted, is_new)) = ui.data(|data| data.get_temp::<(&'static str, bool)>(sought())) else {
        return;
    };
    if wanted != place {
        return;
    }
    if is_new {
        response.scroll_to_me(Some(Align::Center));
        ui.data_mut(|data| data.insert_temp(sought(), (wanted, false)));
    } else if ui.input(|input| input.pointer.any_pressed()) {
        ui.data_mut(|data| data.remove::<(&'static str, bool)>(sought()));
    }
    let stroke = Stroke::new(1.5, theme::ACCENT);
    ui.painter().rect_stroke(response.rect.expand(1.0), 3.0, stroke, StrokeKind::Outside);
}

/// The result of a row.
pub(in crate::editor::panels) struct Row<R> {
    /// What its widgets returned.
    pub inner: R,
    /// Whether the default is asked for, by a double click on the name: one on a value begins to edit it.
    pub reset: bool,
}

impl Control {
    /// The label, the mark of a `changed` value, and `widgets` in the space on the right.
    pub(in crate::editor::panels) fn row<R>(
        &self,
        ui: &mut Ui,
        changed: bool,
        widgets: impl FnOnce(&mut Ui) -> R,
    ) -> Row<R> {
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = 4.0;
            let reset = self.label(ui, changed);
            Row { inner: widgets(ui), reset }
        })
        .inner
    }

    /// One of several lines of a value; only the `first` has the label.
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
            ui.add_space(LABELS + 4.0);
            widgets(ui)
        })
        .inner
    }

    /// The name; whether it was clicked twice.
    fn label(&self, ui: &mut Ui, changed: bool) -> bool {
        let size = vec2(LABELS, ui.spacing().interact_size.y);
        // The Tab key passes it by.
        let (rect, response) = ui.allocate_exact_size(size, Sense::CLICK);
        let painter = ui.painter_at(rect);
        let colour = if changed { ui.visuals().strong_text_color() } else { ui.visuals().text_color() };
        let at = rect.left_center() + vec2(MARK, 0.0);
        painter.text(at, Align2::LEFT_CENTER, self.label, TextStyle::Body.resolve(ui.style()), colour);
        if changed {
            painter.circle_filled(rect.left_center() + vec2(3.0, 0.0), 2.5, theme::ACCENT);
        }
        response.widget_info(|| WidgetInfo::labeled(Role::Label, ui.is_enabled(), self.label));
        mark_sought(ui, &response, self.setting.place);
        self.with_tooltip(response).double_clicked()
    }

    /// The name for a screen reader: the label, with its owner where several parts of a panel have that label.
    pub(in crate::editor::panels) fn accessible_name(&self) -> String {
        let owners = [
            ("scene.meshes", "Mesh"),
            ("scene.lights", "Light"),
            ("scene.camera", "Camera"),
            ("scene.receiver", "Receiver"),
        ];
        let owner = owners.iter().find(|(place, _)| self.setting.place.starts_with(place));
        owner.map_or_else(|| self.label.to_owned(), |(_, owner)| format!("{owner}: {}", self.label))
    }

    /// The response with the tooltip of this setting.
    pub(super) fn with_tooltip(&self, response: Response) -> Response {
        beside_panel(&response, |ui| {
            ui.set_max_width(TOOLTIP);
            ui.strong(self.label);
            ui.label(self.setting.help);
            for (label, choice) in self.labels.iter().zip(self.setting.choices) {
                ui.label(format!("{label}: {}", choice.help));
            }
            if let Some(trio) = self.pictures {
                pictures::show(ui, trio);
            }
            let words = self.setting.in_words();
            if !words.is_empty() {
                ui.weak(format!("{words} A double click on the name resets it."));
            }
        });
        response
    }
}
