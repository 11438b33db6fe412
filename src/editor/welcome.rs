//! The welcome window: a new project from an example, or a recent one.

use egui::{
    Button, ColorImage, Context, Image, Layout, RichText, Sense, TextureHandle, TextureOptions, Ui, vec2,
};

use super::action::Action;
use super::command::Command;
use super::dialogs::modal;
use super::menu::Recent;
use super::templates::TEMPLATES;
use super::theme;

/// Size of a thumbnail, points.
const PICTURE: egui::Vec2 = vec2(224.0, 140.0);
/// Maximum number of recent files.
const RECENT: usize = 6;

/// The welcome window.
#[derive(Default)]
pub struct Welcome {
    /// Whether it is open.
    pub open: bool,
    /// The thumbnails, once shown.
    pictures: Vec<Option<TextureHandle>>,
}

impl Welcome {
    /// Shows the window if it is open; returns the choice and closes it.
    pub fn show(&mut self, ctx: &Context, recent: &[Recent]) -> Option<Action> {
        if !self.open {
            return None;
        }
        if self.pictures.is_empty() {
            self.pictures = TEMPLATES.iter().map(|t| picture(ctx, t.name, t.picture)).collect();
        }
        let mut chosen = None;
        let shown = modal(ctx, "welcome").show(ctx, |ui| {
            ui.set_width(3.0 * (PICTURE.x + 16.0) + 16.0);
            ui.label(RichText::new("Start from an example").heading());
            ui.weak("Each can be changed and saved as your own.");
            ui.add_space(8.0);
            for row in 0..TEMPLATES.len().div_ceil(3) {
                ui.horizontal_top(|ui| {
                    for index in (3 * row)..(3 * row + 3).min(TEMPLATES.len()) {
                        if self.card(ui, index) {
                            chosen = Some(Action::New(index));
                        }
                    }
                });
                ui.add_space(6.0);
            }
            ui.separator();
            chosen = chosen.take().or(below(ui, recent));
        });
        if chosen.is_some() || shown.should_close() {
            self.open = false;
        }
        chosen
    }

    fn card(&self, ui: &mut Ui, index: usize) -> bool {
        let template = &TEMPLATES[index];
        let (rect, response) = ui.allocate_exact_size(PICTURE + vec2(12.0, 66.0), Sense::click());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, template.name));
        let hot = response.hovered() || response.has_focus();
        let fill = if hot {
            ui.visuals().widgets.hovered.weak_bg_fill
        } else {
            ui.visuals().widgets.inactive.weak_bg_fill.gamma_multiply(0.5)
        };
        ui.painter().rect_filled(rect, 6.0, fill);
        let place = egui::Rect::from_min_size(rect.min + vec2(6.0, 6.0), PICTURE);
        ui.painter().rect_filled(place, 4.0, theme::SURROUND);
        if let Some(texture) = self.pictures.get(index).and_then(Option::as_ref) {
            Image::new(texture).corner_radius(4.0).paint_at(ui, place);
        }
        let words = egui::Rect::from_min_max(place.left_bottom() + vec2(2.0, 4.0), rect.max - vec2(8.0, 4.0));
        let mut inside =
            ui.new_child(egui::UiBuilder::new().max_rect(words).layout(Layout::top_down(egui::Align::Min)));
        inside.spacing_mut().item_spacing.y = 1.0;
        inside.add(egui::Label::new(RichText::new(template.name).strong()).selectable(false));
        inside.add(egui::Label::new(RichText::new(template.line).small().weak()).wrap().selectable(false));
        response.clicked()
    }
}

fn below(ui: &mut Ui, recent: &[Recent]) -> Option<Action> {
    let mut chosen = None;
    ui.horizontal_wrapped(|ui| {
        if ui.button("Empty project").clicked() {
            chosen = Some(Command::NewEmpty.into());
        }
        if ui.button("Open…").clicked() {
            chosen = Some(Command::Open.into());
        }
        for Recent { path, is_there } in recent.iter().take(RECENT) {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            let shown = ui.add_enabled(*is_there, Button::new(name.as_ref()).frame(false));
            if shown.on_hover_text(path.to_string_lossy()).clicked() {
                chosen = Some(Action::Open(path.clone()));
            }
        }
    });
    chosen
}

/// A thumbnail as a texture; none where it cannot be decoded.
fn picture(ctx: &Context, name: &str, png: &[u8]) -> Option<TextureHandle> {
    let image = image::load_from_memory(png).ok()?.into_rgb8();
    let size = [image.width() as usize, image.height() as usize];
    Some(ctx.load_texture(name, ColorImage::from_rgb(size, &image), TextureOptions::LINEAR))
}
