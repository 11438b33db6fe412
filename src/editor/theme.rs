//! Colours, spacing and type: neutral greys around the light, so that colours are judged as they are.

use egui::{Color32, CornerRadius, FontFamily, FontId, Margin, Stroke, TextStyle, Theme, Visuals, vec2};

/// Colour of directed lines, as in the exported sheets.
pub const LINE: Color32 = Color32::from_rgb(255, 148, 20);
/// Colour of walls, as in the exported sheets.
pub const WALL: Color32 = Color32::from_rgb(237, 41, 199);
/// Colour of targets.
pub const TARGET: Color32 = Color32::from_rgb(92, 200, 255);
/// Colour of selected and active elements.
pub const ACCENT: Color32 = Color32::from_rgb(64, 156, 255);
/// Colour of success.
pub const GOOD: Color32 = Color32::from_rgb(84, 190, 120);
/// Colour of warnings.
pub const WARN: Color32 = Color32::from_rgb(236, 172, 58);
/// Colour of errors.
pub const BAD: Color32 = Color32::from_rgb(232, 92, 84);
/// Surround of the pictures in both themes: judging light needs a dark, neutral surround.
pub const SURROUND: Color32 = Color32::from_gray(22);

/// Applies colours, spacing and fonts to both themes of a context.
pub fn apply(ctx: &egui::Context) {
    for theme in [Theme::Dark, Theme::Light] {
        ctx.style_mut_of(theme, |style| {
            style.visuals = visuals(theme);
            style.text_styles = [
                (TextStyle::Small, FontId::new(10.5, FontFamily::Proportional)),
                (TextStyle::Body, FontId::new(13.0, FontFamily::Proportional)),
                (TextStyle::Button, FontId::new(13.0, FontFamily::Proportional)),
                (TextStyle::Heading, FontId::new(15.0, FontFamily::Proportional)),
                (TextStyle::Monospace, FontId::new(12.0, FontFamily::Monospace)),
            ]
            .into();
            let spacing = &mut style.spacing;
            spacing.item_spacing = vec2(8.0, 6.0);
            spacing.button_padding = vec2(8.0, 3.0);
            spacing.interact_size = vec2(40.0, 22.0);
            spacing.slider_width = 150.0;
            spacing.window_margin = Margin::same(12);
            spacing.menu_margin = Margin::same(6);
            style.interaction.tooltip_delay = 0.4;
        });
    }
}

fn visuals(theme: Theme) -> Visuals {
    let dark = theme == Theme::Dark;
    let mut v = if dark { Visuals::dark() } else { Visuals::light() };
    let grey =
        |dark_value: u8, light_value: u8| Color32::from_gray(if dark { dark_value } else { light_value });
    v.panel_fill = grey(38, 236);
    v.window_fill = grey(44, 245);
    v.extreme_bg_color = grey(26, 252);
    v.faint_bg_color = grey(44, 228);
    v.window_stroke = Stroke::new(1.0, grey(62, 200));
    v.selection.bg_fill = ACCENT.gamma_multiply(if dark { 0.55 } else { 0.4 });
    v.selection.stroke = Stroke::new(1.0, if dark { Color32::WHITE } else { Color32::BLACK });
    v.hyperlink_color = ACCENT;
    v.slider_trailing_fill = true;
    let radius = CornerRadius::same(4);
    let w = &mut v.widgets;
    for (widget, fill, text) in [
        (&mut w.noninteractive, grey(38, 236), grey(205, 45)),
        (&mut w.inactive, grey(58, 218), grey(220, 40)),
        (&mut w.hovered, grey(72, 206), grey(245, 20)),
        (&mut w.active, grey(86, 194), grey(255, 0)),
        (&mut w.open, grey(64, 212), grey(235, 30)),
    ] {
        widget.corner_radius = radius;
        widget.bg_fill = fill;
        widget.weak_bg_fill = fill;
        widget.fg_stroke = Stroke::new(1.2, text);
        widget.bg_stroke = Stroke::NONE;
        widget.expansion = 0.0;
    }
    w.noninteractive.bg_stroke = Stroke::new(1.0, grey(54, 208));
    w.hovered.bg_stroke = Stroke::new(1.0, grey(96, 170));
    v.window_corner_radius = CornerRadius::same(8);
    v.menu_corner_radius = CornerRadius::same(6);
    v
}
