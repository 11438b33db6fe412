//! The preferences window.

use egui::{Context, DragValue, Grid, ThemePreference, Ui};

use super::reset_label::reset_label;
use super::store::preferences::{PREVIEW_MEGABYTES, PhotonRenderer, Preferences, Theme, UI_SCALES};

/// The themes and their names.
const THEMES: [(Theme, &str); 3] =
    [(Theme::Dark, "Dark"), (Theme::Light, "Light"), (Theme::System, "System")];

/// The photon renderers with name and tooltip.
const RENDERERS: [(PhotonRenderer, &str, &str); 3] = [
    (PhotonRenderer::Auto, "Automatic", "The graphics card if a suitable one is present."),
    (PhotonRenderer::Gpu, "Graphics card", "Fast with many photons. Falls back to the processor."),
    (PhotonRenderer::Cpu, "Processor", "The same picture without a graphics card."),
];

/// The names of the preferences.
pub const NAMES: [&str; 5] = [THEME, SCALE, RENDERER, MEMORY, DRAWING];
const THEME: &str = "Theme";
const SCALE: &str = "Interface scale";
const RENDERER: &str = "Photon renderer";
const MEMORY: &str = "Preview memory";
const DRAWING: &str = "Drawing";

/// Step of the interface scale.
const STEP: f32 = 0.1;

/// Shows the window if it is open. Changes apply at once. Returns whether the files that are trusted, so many, shall be forgotten.
pub fn show(ctx: &Context, open: &mut bool, preferences: &mut Preferences, trusted: usize) -> bool {
    let mut forgets = false;
    let window = egui::Window::new("Preferences")
        .id(egui::Id::unique("Preferences"))
        .open(open)
        .collapsible(false)
        .resizable(false);
    window.default_pos(ctx.content_rect().center() - egui::vec2(210.0, 160.0)).show(ctx, |ui| {
        ui.set_width(400.0);
        Grid::new("preferences").num_columns(2).spacing([18.0, 10.0]).show(ui, |ui| {
            let default = Preferences::default();
            reset_label(
                ui,
                THEME,
                "Caustics are judged best in dark surroundings; the pictures always have them.",
                &mut preferences.theme,
                &default.theme,
            );
            ui.horizontal(|ui| {
                for (theme, name) in THEMES {
                    ui.selectable_value(&mut preferences.theme, theme, name);
                }
            });
            ui.end_row();
            reset_label(
                ui,
                SCALE,
                "Texts and controls, 50 to 300 %. The pictures keep their pixels.",
                &mut preferences.ui_scale,
                &default.ui_scale,
            );
            scale(ui, &mut preferences.ui_scale);
            ui.end_row();
            reset_label(
                ui,
                RENDERER,
                "Renderer of the preview. Exports do not depend on it.",
                &mut preferences.photon_renderer,
                &default.photon_renderer,
            );
            ui.horizontal(|ui| {
                for (renderer, name, tip) in RENDERERS {
                    ui.selectable_value(&mut preferences.photon_renderer, renderer, name).on_hover_text(tip);
                }
            });
            ui.end_row();
            reset_label(
                ui,
                MEMORY,
                "What the photons of all frames of a preview may take. Where it is short the preview has fewer photons; what is rendered keeps its own.",
                &mut preferences.preview_megabytes,
                &default.preview_megabytes,
            );
            memory(ui, &mut preferences.preview_megabytes);
            ui.end_row();
            reset_label(
                ui,
                DRAWING,
                "Hold Ctrl while drawing to disable it.",
                &mut preferences.snapping,
                &default.snapping,
            );
            ui.checkbox(&mut preferences.snapping, "Snap to points, lines and the grid");
            ui.end_row();
        });
        ui.add_space(12.0);
        ui.horizontal(|ui| {
            let tip = "Resets all of these. Recent files are kept.";
            if ui.button("Reset all").on_hover_text(tip).clicked() {
                reset(preferences);
            }
            if ui.button("Clear recent files").clicked() {
                preferences.recent.clear();
            }
            let tip = "Files outside of their projects' folders that you trusted for good.";
            let words = match trusted {
                0 => "Forget trusted files".to_owned(),
                1 => "Forget 1 trusted file".to_owned(),
                _ => format!("Forget {trusted} trusted files"),
            };
            let forget = egui::Button::new(words);
            forgets = ui.add_enabled(trusted > 0, forget).on_hover_text(tip).clicked();
        });
    });
    forgets
}

/// Applies theme and interface scale to a context.
pub fn apply(ctx: &Context, preferences: &Preferences) {
    ctx.set_theme(match preferences.theme {
        Theme::Dark => ThemePreference::Dark,
        Theme::Light => ThemePreference::Light,
        Theme::System => ThemePreference::System,
    });
    // Setting it draws everything anew.
    if ctx.zoom_factor() != preferences.ui_scale {
        ctx.set_zoom_factor(preferences.ui_scale);
    }
}

/// The interface scale, `by` steps larger.
pub fn stepped(scale: f32, by: i32) -> f32 {
    let steps = (scale / STEP).round() + by as f32;
    (steps * STEP).clamp(*UI_SCALES.start(), *UI_SCALES.end())
}

fn reset(preferences: &mut Preferences) {
    let default = Preferences::default();
    preferences.theme = default.theme;
    preferences.ui_scale = default.ui_scale;
    preferences.photon_renderer = default.photon_renderer;
    preferences.snapping = default.snapping;
    preferences.preview_megabytes = default.preview_megabytes;
}

/// The memory of a preview, applied when the drag ends: each change makes the preview anew.
fn memory(ui: &mut Ui, megabytes: &mut u32) {
    let held = egui::Id::unique("preview memory");
    let dragged: Option<u32> = ui.data(|data| data.get_temp(held));
    let mut shown = dragged.unwrap_or(*megabytes);
    let field = DragValue::new(&mut shown).range(PREVIEW_MEGABYTES).speed(2.0).suffix(" MB");
    let response = ui.add(field.update_while_editing(false)).accessible_name("Preview memory");
    if response.dragged() {
        ui.data_mut(|data| data.insert_temp(held, shown));
    } else if dragged.is_some() || response.changed() {
        ui.data_mut(|data| data.remove::<u32>(held));
        *megabytes = shown;
    }
}

/// The interface scale in per cent, applied when the drag ends: the field would move under the pointer.
fn scale(ui: &mut Ui, scale: &mut f32) {
    let held = egui::Id::unique("interface scale");
    let dragged: Option<f32> = ui.data(|data| data.get_temp(held));
    let mut percent = dragged.unwrap_or(100.0 * *scale);
    let (least, most) = (100.0 * UI_SCALES.start(), 100.0 * UI_SCALES.end());
    let field = DragValue::new(&mut percent).range(least..=most).speed(1.0).fixed_decimals(0).suffix(" %");
    let response = ui.add(field.update_while_editing(false)).accessible_name("Interface scale");
    if response.dragged() {
        ui.data_mut(|data| data.insert_temp(held, percent));
    } else if dragged.is_some() || response.changed() {
        ui.data_mut(|data| data.remove::<f32>(held));
        *scale = percent / 100.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_of_the_size_lead_back_and_end_at_the_limits() {
        let mut scale = 1.0;
        for _ in 0..5 {
            scale = stepped(scale, 1);
        }
        // f32 sums of tenths.
        assert!((scale - 1.5).abs() < 1e-5);
        assert!((stepped(stepped(scale, 1), -1) - scale).abs() < 1e-5);
        assert_eq!((stepped(3.0, 1), stepped(0.5, -1)), (3.0, 0.5));
    }
}
