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

/// One of the colours above as that of words on a panel or window: apart from the ground in both themes.
pub fn words(visuals: &Visuals, colour: Color32) -> Color32 {
    let (towards, share) = if visuals.dark_mode { (Color32::WHITE, 0.15) } else { (Color32::BLACK, 0.45) };
    colour.lerp_to_gamma(towards, share)
}

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
    v.hyperlink_color = words(&v, ACCENT);
    v.weak_text_color = Some(grey(155, 98));
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Relative luminance, and contrast, as WCAG 2.2 defines them.
    fn contrast(a: Color32, b: Color32) -> f32 {
        let luminance = |colour: Color32| {
            let [r, g, b, _] = egui::Rgba::from(colour).to_array();
            0.2126 * r + 0.7152 * g + 0.0722 * b
        };
        let (a, b) = (luminance(a), luminance(b));
        (a.max(b) + 0.05) / (a.min(b) + 0.05)
    }

    #[test]
    fn words_stand_apart_from_panels_and_windows_in_both_themes() {
        for theme in [Theme::Dark, Theme::Light] {
            let visuals = visuals(theme);
            let of_words = [GOOD, WARN, BAD, ACCENT].map(|colour| words(&visuals, colour));
            for colour in of_words.into_iter().chain([visuals.weak_text_color(), visuals.hyperlink_color]) {
                for ground in [visuals.panel_fill, visuals.window_fill] {
                    let contrast = contrast(colour, ground);
                    // What WCAG 2.2 asks of text at least, level AA.
                    assert!(contrast >= 4.5, "{theme:?}: {colour:?} on {ground:?} has {contrast:.2}");
                }
            }
        }
    }
}
