//! Numbers: a slider and a field, a field alone, several fields, a number that may be absent.

use egui::emath::Numeric;
use egui::text::{CCursor, CCursorRange};
use egui::text_edit::TextEditState;
use egui::{DragValue, Id, Response, Slider, SliderClamping, Ui};

use lightloom_core::setting::{Kind, format};

use super::Control;

/// Width of a field beside a slider, points.
const FIELD: f32 = 82.0;
/// Width of a digit, points.
const DIGIT: f32 = 7.2;
/// Least width of a slider: below it there is only the field.
const SLIDER: f32 = 48.0;

impl Control {
    /// A slider and a field. Whether the value changed.
    pub fn number<T: Numeric>(&self, ui: &mut Ui, value: &mut T) -> bool {
        self.number_beside(ui, value, 0.0)
    }

    /// As [`Self::number`], with `room` left on the right, points.
    pub fn number_beside<T: Numeric>(&self, ui: &mut Ui, value: &mut T, room: f32) -> bool {
        let before = *value;
        let row = self.row(ui, self.is_changed(&[before.to_f64()]), |ui| {
            let width = ui.available_width() - room;
            self.slider_and_field(ui, value, width);
        });
        if row.reset
            && let [default] = self.setting.default
        {
            *value = T::from_f64(*default);
        }
        before != *value
    }

    /// A number that may be absent, with a check box labelled `absent`; unchecked it begins at `first`. Whether it
    /// changed.
    pub fn optional<T: Numeric>(&self, ui: &mut Ui, value: &mut Option<T>, absent: &str, first: f64) -> bool {
        let before = *value;
        let changed = before.is_some();
        let row = self.row(ui, changed, |ui| {
            let mut none = value.is_none();
            let switch = ui
                .checkbox(&mut none, absent)
                .accessible_name(format!("{}: {absent}", self.accessible_name()));
            self.with_tooltip(switch);
            match (none, &mut *value) {
                (true, value) => *value = None,
                (false, Some(value)) => {
                    let width = ui.available_width();
                    self.slider_and_field(ui, value, width);
                }
                (false, value) => *value = Some(T::from_f64(first)),
            }
        });
        if row.reset {
            *value = None;
        }
        before != *value
    }

    /// A field for each component, by these `names`. Whether the value changed.
    pub fn numbers<const N: usize, T: Numeric>(
        &self,
        ui: &mut Ui,
        value: &mut [T; N],
        names: [&str; N],
    ) -> bool {
        let before = *value;
        let row = self.row(ui, self.is_changed(&before.map(Numeric::to_f64)), |ui| {
            let width = (ui.available_width() - 4.0 * (N as f32 - 1.0)) / N as f32;
            for (component, name) in value.iter_mut().zip(names) {
                self.field(ui, component, width, &format!("{} {name}", self.accessible_name()));
            }
        });
        if row.reset && self.setting.default.len() == N {
            for (component, default) in value.iter_mut().zip(self.setting.default) {
                *component = T::from_f64(*default);
            }
        }
        before != *value
    }

    /// Whether a value differs from the default, as 32 bits tell them apart.
    pub(super) fn is_changed(&self, value: &[f64]) -> bool {
        let differ = |(a, b): (&f64, &f64)| (*a as f32) != (*b as f32);
        self.setting.default.len() != value.len() || value.iter().zip(self.setting.default).any(differ)
    }

    fn slider_and_field<T: Numeric>(&self, ui: &mut Ui, value: &mut T, room: f32) {
        if room < SLIDER + FIELD {
            self.field(ui, value, room, &self.accessible_name());
            return;
        }
        ui.spacing_mut().slider_width = room - FIELD - 4.0;
        let slider = Slider::from_get_set(self.slider[0]..=self.slider[1], |new| {
            if let Some(new) = new {
                *value = T::from_f64(self.clamp(new));
            }
            value.to_f64()
        });
        let mut slider = slider
            .show_value(false)
            .logarithmic(self.logarithmic)
            .smallest_positive(smallest(self))
            // A value beyond the slider's ends stays until the slider is moved.
            .clamping(SliderClamping::Edits);
        if self.setting.kind == Kind::Whole {
            slider = slider.integer();
        }
        let response = ui.add(slider).accessible_name(self.accessible_name());
        self.with_tooltip(response);
        self.field(ui, value, FIELD, &format!("{} value", self.accessible_name()));
    }

    /// A field to drag or to type in.
    pub(in crate::editor::panels) fn field<T: Numeric>(
        &self,
        ui: &mut Ui,
        value: &mut T,
        width: f32,
        name: &str,
    ) -> Response {
        let whole = self.setting.kind == Kind::Whole || T::INTEGRAL;
        let suffix = if self.suffix && !self.setting.unit.is_empty() {
            format!(" {}", self.setting.unit)
        } else {
            String::new()
        };
        let before = value.to_f64();
        // No wider than its place: the panel would grow.
        let room = if suffix.is_empty() { ((width - 6.0) / DIGIT) as usize } else { usize::MAX };
        let shown = move |value: f64| format::number_within(value, whole, room);
        let field = DragValue::from_get_set(|new| {
            if let Some(new) = new {
                let new = self.clamp(if whole { new.round() } else { new });
                // Who leaves a field as it was has typed nothing: digits that are not shown stay.
                if format::parse(&shown(before), "") != Some(new) {
                    *value = T::from_f64(new);
                }
            }
            value.to_f64()
        })
        .range(self.clamp(self.setting.range[0])..=self.setting.range[1])
        .clamp_existing_to_range(false)
        .speed(speed(self, before, whole))
        .suffix(suffix)
        // What is typed counts when it is complete.
        .update_while_editing(false)
        .custom_formatter(move |value, _| shown(value))
        .custom_parser(|text| format::parse(text, self.setting.unit));
        // Long numbers need the room.
        ui.spacing_mut().button_padding.x = 2.0;
        let size = egui::vec2(width, ui.spacing().interact_size.y);
        let response = ui.add_sized(size, field).accessible_name(name);
        if response.double_clicked() {
            select_all(ui, response.id);
        }
        self.with_tooltip(response)
    }
}

/// Selects all of a number that is typed into: egui would select what stands before or behind the point.
fn select_all(ui: &Ui, field: Id) {
    let Some(mut state) = TextEditState::load(ui.ctx(), field) else { return };
    // The cursor is kept within the text.
    let end = CCursor::new(usize::from(u16::MAX));
    state.cursor.set_char_range(Some(CCursorRange::two(CCursor::default(), end)));
    state.store(ui.ctx(), field);
}

/// The meaning of the two ends of the slider above.
pub(in crate::editor::panels) fn end_labels(ui: &mut Ui, low: &str, high: &str) {
    ui.horizontal(|ui| {
        let left = super::row::LABELS + 4.0;
        let width = ui.available_width() - left - FIELD - 4.0;
        let (rect, _) = ui.allocate_exact_size(egui::vec2(left + width, 12.0), egui::Sense::hover());
        let font = egui::TextStyle::Small.resolve(ui.style());
        let colour = ui.visuals().weak_text_color();
        let slider = rect.with_min_x(rect.left() + left);
        ui.painter().text(slider.left_top(), egui::Align2::LEFT_TOP, low, font.clone(), colour);
        ui.painter().text(slider.right_top(), egui::Align2::RIGHT_TOP, high, font, colour);
    });
}

/// Where a logarithmic slider begins that reaches down to 0.
fn smallest(control: &Control) -> f64 {
    if control.slider[0] > 0.0 { control.slider[0] } else { control.slider[1] * 1e-4 }
}

/// Change of the value per point of dragging.
fn speed(control: &Control, value: f64, whole: bool) -> f64 {
    let [low, high] = control.slider;
    let speed = if control.logarithmic {
        0.01 * value.abs().max(smallest(control))
    } else if high - low > 1000.0 {
        // Places in a scene reach far and stand near.
        0.01 * value.abs().max(0.5)
    } else {
        (high - low) / 300.0
    };
    if whole { speed.max(0.1) } else { speed }
}
