//! Colours, linear Rec.709 as the core has them; the picker shows what a screen shows of them.

use egui::Ui;

use super::Control;

impl Control {
    /// A picker and three fields. Whether the colour changed.
    pub fn colour(&self, ui: &mut Ui, value: &mut [f32; 3]) -> bool {
        let before = *value;
        let changed = self.is_changed(&before.map(f64::from));
        let row = self.row(ui, changed, |ui| {
            // The picker knows no more than 1 of anything: brighter light keeps its scale.
            let scale = value.iter().copied().fold(1.0, f32::max);
            let mut shown = value.map(|channel| (channel / scale).clamp(0.0, 1.0));
            ui.spacing_mut().interact_size.x = 28.0;
            let picker = ui.color_edit_button_rgb(&mut shown).accessible_name(self.accessible_name());
            let picker = self.with_tooltip(picker);
            if picker.changed() {
                *value = shown.map(|channel| self.clamp(f64::from(channel * scale)) as f32);
            }
            let width = (ui.available_width() - 8.0) / 3.0;
            for (channel, name) in value.iter_mut().zip(["red", "green", "blue"]) {
                self.field(ui, channel, width, &format!("{} {name}", self.accessible_name()));
            }
        });
        if row.reset {
            *value = self.setting.value();
        }
        before != *value
    }
}
