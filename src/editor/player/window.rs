//! The window of the player.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use egui::{
    Align, ColorImage, Context, DragValue, Key, Label, Modifiers, Pos2, Rect, Response, Sense, Slider,
    Stroke, StrokeKind, TextureHandle, TextureOptions, Ui, vec2,
};

use super::noise::{self, Steadiness};
use super::{Clock, Loader, Sequence};
use crate::editor::dialogs::{PickRequest, Picker, Purpose};
use crate::editor::theme;
use crate::editor::timeline::icons::{self, Icon};

/// Width of a digit, points.
const DIGIT: f32 = 7.5;
/// Height of everything below the picture, points.
const CONTROLS: f32 = 64.0;

/// The player of rendered frames.
#[derive(Default)]
pub struct Player {
    /// Whether its window is open.
    pub open: bool,
    show: Option<Show>,
    problem: Option<String>,
    /// The folder or file that was opened last.
    place: Option<PathBuf>,
}

/// A sequence that is played.
struct Show {
    sequence: Sequence,
    loader: Loader,
    clock: Clock,
    /// Frames per second.
    rate: f64,
    /// The picture on the screen, and its index.
    texture: Option<(usize, TextureHandle)>,
    /// The part of the picture whose steadiness is told, in shares of its sides.
    part: Option<Rect>,
    /// Its steadiness around the picture of this index, of so many that were read.
    steady: Option<([usize; 2], Option<Steadiness>)>,
    /// Where the drag began that draws the part.
    corner: Option<Pos2>,
}

impl Player {
    /// Opens the window and plays the frames of a folder, or those that a file belongs to.
    pub fn play(&mut self, ctx: &Context, path: &Path) {
        self.open = true;
        self.place = Some(path.to_owned());
        let ctx = ctx.clone();
        let begun = Sequence::find(path).and_then(|sequence| {
            let loader = Loader::start(&sequence, move || ctx.request_repaint())?;
            let [frames, seconds] = sequence.frames_per_second.map(f64::from);
            let clock = Clock::new(sequence.holds());
            let rate = frames / seconds;
            Ok(Show { loader, clock, rate, texture: None, part: None, steady: None, corner: None, sequence })
        });
        (self.show, self.problem) = match begun {
            Ok(show) => (Some(show), None),
            Err(problem) => (None, Some(problem)),
        };
    }

    /// Takes the keys that play and step, for the window on top.
    pub fn take_keys(&mut self, ctx: &Context) {
        let Some(show) = self.show.as_mut().filter(|_| self.open) else { return };
        let hit = |key| ctx.input_mut(|input| input.consume_key(Modifiers::NONE, key));
        if hit(Key::Space) {
            show.clock.toggle();
        }
        let steps = [(Key::Comma, -1), (Key::Period, 1), (Key::ArrowLeft, -1), (Key::ArrowRight, 1)];
        for (_, by) in steps.into_iter().filter(|(key, _)| hit(*key)) {
            show.clock.step(by);
        }
    }

    /// Shows the window if it is open.
    pub fn show(&mut self, ctx: &Context, picker: &mut Picker) {
        if !self.open {
            // Pictures take memory that nobody looks at.
            self.show = None;
            return;
        }
        let mut open = true;
        let window = egui::Window::new("Player")
            .id(egui::Id::unique("Player"))
            .open(&mut open)
            .collapsible(false)
            .resizable(true);
        let middle = ctx.content_rect().center() - vec2(380.0, 260.0);
        let window = window.default_pos(middle).default_size([760.0, 500.0]).min_size([420.0, 260.0]);
        window.show(ctx, |ui| {
            ui.horizontal(|ui| {
                if ui.button("Open frames…").clicked() {
                    let folder = self.place.as_deref().map(|place| match place.is_dir() {
                        true => place.to_owned(),
                        false => place.parent().unwrap_or(place).to_owned(),
                    });
                    picker.ask(PickRequest::new(Purpose::Frames).in_folder(folder), ctx);
                }
                if let Some(place) = &self.place {
                    ui.weak(place.to_string_lossy());
                }
            });
            if let Some(problem) = &self.problem {
                ui.colored_label(theme::words(ui.visuals(), theme::BAD), problem);
            }
            match &mut self.show {
                Some(show) => show.show(ui),
                None => {
                    ui.weak("Choose a picture of a rendered sequence, or drop its folder on the window.");
                }
            }
        });
        self.open = open;
    }
}

impl Show {
    fn show(&mut self, ui: &mut Ui) {
        let index = self.clock.index();
        let slot = self.loader.get(index);
        // Playback waits for a picture that was not read yet.
        let waits = slot.is_none() && self.loader.count() < self.sequence.frames.len();
        if let Some(Ok(picture)) = &slot {
            self.upload(ui, index, picture);
        }
        let mut shown = None;
        let room = vec2(ui.available_width(), (ui.available_height() - CONTROLS).max(60.0));
        ui.allocate_ui_with_layout(
            room,
            egui::Layout::centered_and_justified(egui::Direction::TopDown),
            |ui| {
                ui.set_min_size(room);
                match (&slot, &self.texture) {
                    (Some(Err(problem)), _) => {
                        ui.colored_label(theme::words(ui.visuals(), theme::BAD), problem);
                    }
                    (_, Some((_, texture))) => {
                        let (number, _) = &self.sequence.frames[index];
                        let picture = egui::Image::new(texture).max_size(room).maintain_aspect_ratio(true);
                        let picture = picture.sense(Sense::drag());
                        shown = Some(ui.add(picture.alt_text(format!("Frame {number}"))));
                    }
                    _ => {
                        ui.spinner();
                    }
                }
            },
        );
        if let Some(response) = shown {
            self.mark(ui, &response);
        }
        self.scrub(ui, index);
        ui.horizontal(|ui| self.controls(ui, index));
        let seconds = if waits { 0.0 } else { ui.input(|input| input.stable_dt).into() };
        if let Some(next) = self.clock.advance(seconds, self.rate) {
            ui.ctx().request_repaint_after(Duration::from_secs_f64(next.min(1.0)));
        }
    }

    /// Draws the part of the picture that is dragged out, whose steadiness is told.
    fn mark(&mut self, ui: &Ui, response: &Response) {
        let picture = picture_in(response.rect, self.texture.as_ref());
        if response.drag_started() {
            self.corner = ui.input(|input| input.pointer.press_origin());
        }
        if let (true, Some(from), Some(to)) =
            (response.dragged(), self.corner, response.interact_pointer_pos())
        {
            (self.part, self.steady) = (Some(noise::part(picture, from, to)), None);
        }
        if response.clicked() || response.double_clicked() {
            (self.part, self.steady) = (None, None);
        }
        if let Some(part) = self.part {
            let at = |share: Pos2| picture.min + share.to_vec2() * picture.size();
            let rect = Rect::from_min_max(at(part.min), at(part.max));
            ui.painter().rect_stroke(rect, 0.0, Stroke::new(1.0, theme::ACCENT), StrokeKind::Outside);
        }
    }

    /// How steady the marked part is, in words.
    fn steady_words(&mut self, index: usize) -> Option<String> {
        let part = self.part?;
        let (count, read) = (self.sequence.frames.len(), self.loader.count());
        // Every few pictures: while it plays the next would say nearly the same.
        let key = [index / 5, read];
        if self.steady.is_none_or(|(of, _)| of != key) {
            let found = noise::steadiness((index, count), part, |at| self.loader.seen(at));
            self.steady = Some((key, found));
        }
        Some(match self.steady?.1 {
            Some(Steadiness { noise, pictures }) => {
                format!("Noise {noise:.2} of 255, over {pictures} pictures")
            }
            None => "No three pictures of it in a row".into(),
        })
    }

    fn upload(&mut self, ui: &Ui, index: usize, picture: &Arc<ColorImage>) {
        match &mut self.texture {
            Some((shown, _)) if *shown == index => {}
            Some((shown, texture)) => {
                texture.set(picture.clone(), TextureOptions::LINEAR);
                *shown = index;
            }
            none => {
                let texture = ui.ctx().load_texture("player", picture.clone(), TextureOptions::LINEAR);
                *none = Some((index, texture));
            }
        }
    }

    /// The slider over all pictures.
    fn scrub(&mut self, ui: &mut Ui, index: usize) {
        let mut at = index;
        ui.spacing_mut().slider_width = ui.available_width();
        let last = self.sequence.frames.len() - 1;
        let slider = ui.add(Slider::new(&mut at, 0..=last).show_value(false)).accessible_name("Position");
        if slider.dragged() || slider.changed() {
            self.clock.playing = false;
            self.clock.go(at);
        }
    }

    fn controls(&mut self, ui: &mut Ui, index: usize) {
        let last = self.sequence.frames.len() - 1;
        let clock = &mut self.clock;
        let mut step = |ui: &mut Ui, icon: Icon, label: &str, to: usize| {
            if icons::button(ui, icon, label, false).on_hover_text(label).clicked() {
                clock.playing = false;
                clock.go(to);
            }
        };
        step(ui, Icon::First, "First picture", 0);
        step(ui, Icon::Back, "Previous picture", index.saturating_sub(1));
        step(ui, Icon::Forward, "Next picture", (index + 1).min(last));
        step(ui, Icon::Last, "Last picture", last);
        let (icon, label) = if clock.playing { (Icon::Pause, "Pause") } else { (Icon::Play, "Play") };
        if icons::button(ui, icon, label, clock.playing).on_hover_text(label).clicked() {
            clock.toggle();
        }
        if icons::button(ui, Icon::Loop, "Loop", clock.looping).on_hover_text("Loop").clicked() {
            clock.looping = !clock.looping;
        }
        let field = DragValue::new(&mut self.rate).range(0.1..=1000.0).speed(0.1).max_decimals(3);
        let tip = "Frames per second of playback; the files keep theirs.";
        ui.add(field.suffix(" fps")).on_hover_text(tip).accessible_name("Playback rate");
        let (number, _) = &self.sequence.frames[index];
        // As wide as the longest number: what follows stays where it is while it plays.
        let digits =
            self.sequence.frames.iter().map(|(number, _)| number.to_string().len()).max().unwrap_or(1);
        let label = Label::new(format!("Frame {number}")).halign(Align::Min);
        ui.add_sized([42.0 + DIGIT * digits as f32, 18.0], label);
        let count = self.sequence.frames.len();
        let read = self.loader.count();
        ui.weak(if read < count { format!("{read} of {count} read") } else { format!("{count} pictures") });
        if self.part.is_none() {
            ui.weak("Drag over a part that stands still for its noise.");
        } else if let Some(words) = self.steady_words(index) {
            let tip = "Root mean square of what changes from frame to frame in the marked part, on the screen's scale of 0 to 255; even \
                       movement does not count. Below about 1 nobody sees it; more passes lower it.";
            ui.label(words).on_hover_text(tip);
        }
    }
}

/// The rectangle that a picture fills in the middle of its room.
fn picture_in(room: Rect, texture: Option<&(usize, TextureHandle)>) -> Rect {
    let Some((_, texture)) = texture else { return room };
    let size = texture.size_vec2();
    let scale = (room.size() / size).min_elem();
    Rect::from_center_size(room.center(), size * scale)
}
