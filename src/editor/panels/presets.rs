//! Presets of the flow, one line each.

use egui::{Align2, CornerRadius, Role, Sense, Stroke, TextStyle, Ui, WidgetInfo, vec2};
use lightloom_core::flow::{FlowSettings, TurbulenceSettings};

use super::pictures::{self, Picture};
use crate::editor::theme;

/// A preset of the flow.
pub struct Preset {
    /// Its label.
    pub name: &'static str,
    /// The values it sets, and how that looks.
    pub help: &'static str,
    picture: &'static Picture,
    set: fn(&mut FlowSettings),
}

/// All presets, in the order of their buttons.
#[rustfmt::skip]
pub const PRESETS: &[Preset] = &[
    Preset { name: "Liquid", help: "Sets gamma 0: light swirls around itself like water.", picture: &pictures::LIQUID, set: |f| f.gamma = 0.0 },
    Preset { name: "Gradient", help: "Sets gamma 1: light spreads and gathers without swirls.", picture: &pictures::GRADIENT, set: |f| f.gamma = 1.0 },
    Preset { name: "Silk", help: "Sets gamma 0.5 and alpha 0.1, no turbulence: wide, calm folds.", picture: &pictures::SILK, set: silk },
    Preset { name: "Storm", help: "Sets turbulence of strength 50 on grids of 12 and 24 cells.", picture: &pictures::STORM, set: storm },
];

fn silk(flow: &mut FlowSettings) {
    (flow.gamma, flow.alpha, flow.turbulence) = (0.5, 0.1, None);
}

fn storm(flow: &mut FlowSettings) {
    let settings = flow.turbulence.take().unwrap_or_default();
    flow.turbulence =
        Some(TurbulenceSettings { strength: 50.0, grids: vec![12, 24], weights: None, ..settings });
}

impl Preset {
    /// The flow with the values of this preset; the rest stays.
    pub fn apply(&self, flow: &FlowSettings) -> FlowSettings {
        let mut flow = flow.clone();
        (self.set)(&mut flow);
        flow
    }
}

/// The presets side by side; a click applies one.
pub(super) fn show(ui: &mut Ui, flow: &mut FlowSettings) {
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 6.0;
        let width = (ui.available_width() - 18.0) / 4.0;
        for preset in PRESETS {
            let new = preset.apply(flow);
            if button(ui, preset, width, new == *flow) {
                *flow = new;
            }
        }
    });
}

fn button(ui: &mut Ui, preset: &Preset, width: f32, chosen: bool) -> bool {
    let picture = vec2(width, width * 0.625);
    let (rect, response) = ui.allocate_exact_size(picture + vec2(0.0, 18.0), Sense::click());
    let (image, words) = rect.split_top_bottom_at_y(rect.top() + picture.y);
    pictures::paint(ui, preset.picture, image);
    let stroke = if chosen || response.has_focus() {
        Stroke::new(2.0, theme::ACCENT)
    } else if response.hovered() {
        ui.visuals().widgets.hovered.bg_stroke
    } else {
        ui.visuals().widgets.noninteractive.bg_stroke
    };
    ui.painter().rect_stroke(image, CornerRadius::same(3), stroke, egui::StrokeKind::Inside);
    let font = TextStyle::Small.resolve(ui.style());
    ui.painter().text(words.center(), Align2::CENTER_CENTER, preset.name, font, ui.visuals().text_color());
    response.widget_info(|| {
        WidgetInfo::selected(Role::Button, ui.is_enabled(), chosen, format!("Preset {}", preset.name))
    });
    response.on_hover_text(preset.help).clicked()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_preset_gives_a_flow_that_the_core_takes_and_gives_it_once() {
        for preset in PRESETS {
            let once = preset.apply(&FlowSettings::default());
            assert!(once.check("flow").is_ok(), "{}", preset.name);
            assert_ne!(once, FlowSettings::default(), "{}", preset.name);
            assert_eq!(preset.apply(&once), once, "{}", preset.name);
        }
    }
}
