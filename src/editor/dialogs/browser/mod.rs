//! The built-in file dialog for systems without one: places, a list of folders and files, and a field for a name or path.

mod listing;
mod thumbnails;

use std::path::{Path, PathBuf};

use egui::text::{CCursor, CCursorRange};
use egui::{Align, Button, Context, Id, Key, Layout, RichText, ScrollArea, Sense, TextEdit, Ui, vec2};

pub(in crate::editor::dialogs) use self::listing::home;
use self::listing::{FolderEntry, Listing, Read, make, read};
use self::thumbnails::{Thumbnails, is_picture};
use super::modal::modal;
use super::request::{PickRequest, Purpose};
use crate::editor::theme;

/// Size of the dialog's list, points.
const LIST: egui::Vec2 = vec2(480.0, 280.0);
/// Width of the places, points.
const PLACES: f32 = 130.0;
/// Height of a row with a thumbnail, points.
const PICTURE: f32 = 40.0;
/// Frames after which the field of the name has the keys, or something else has.
const SETTLES: u32 = 10;

/// The state of the open dialog.
pub(super) struct Browser {
    purpose: Purpose,
    folder: PathBuf,
    /// Folders used of late, newest first.
    recent: Vec<PathBuf>,
    /// The typed path, relative to the folder or absolute.
    typed: String,
    /// The name of a folder to be made.
    new_folder: Option<String>,
    /// Whether the field of the name takes the keys in the next frame.
    takes_keys: bool,
    /// The part of its text that is selected in the next frame; none leaves it as it is.
    selects: Option<CCursorRange>,
    listing: Listing,
    thumbnails: Thumbnails,
    /// An existing file that needs a confirmation before it is overwritten.
    overwrite: Option<PathBuf>,
    wake: Context,
    /// Frames in which it was shown.
    frames: u32,
}

impl Browser {
    /// A dialog for a request.
    pub(super) fn new(request: &PickRequest, recent: &[PathBuf], ctx: &Context) -> Self {
        let folder = request.folder.clone().unwrap_or_else(|| home("~"));
        let typed = request.name.clone();
        // A proposed name is replaced by typing.
        let all = CCursorRange::two(CCursor::new(0), CCursor::new(typed.chars().count()));
        Self {
            purpose: request.purpose.clone(),
            selects: Some(all),
            listing: read(folder.clone(), None, request.purpose.clone(), ctx),
            folder,
            recent: recent.to_vec(),
            takes_keys: true,
            typed,
            new_folder: None,
            thumbnails: Thumbnails::new(ctx),
            overwrite: None,
            wake: ctx.clone(),
            frames: 0,
        }
    }

    /// Whether keys reach the field of the name. A window that is new takes no focus in its first frames.
    pub(super) fn takes_keys(&self, ctx: &Context) -> bool {
        self.frames > SETTLES || ctx.memory(|memory| memory.has_focus(field_id()))
    }

    /// Shows the dialog; returns the chosen path, or `Some(None)` when cancelled.
    pub(super) fn show(&mut self, ctx: &Context) -> Option<Option<PathBuf>> {
        if let Some(taken) = self.collect() {
            return Some(Some(taken));
        }
        self.frames = self.frames.saturating_add(1);
        if self.frames <= SETTLES {
            ctx.request_repaint();
        }
        let mut answer = None;
        let shown = modal(ctx, "file dialog").show(ctx, |ui| {
            // The list has a margin, and stands apart from the places.
            ui.set_width(LIST.x + PLACES + 16.0);
            ui.heading(self.purpose.title());
            ui.add_space(4.0);
            self.above(ui);
            ui.horizontal_top(|ui| {
                self.places(ui);
                self.list(ui);
            });
            ui.add_space(4.0);
            answer = self.below(ui);
        });
        if answer.is_none() && shown.should_close() { Some(None) } else { answer }
    }

    /// Takes the result of the reading thread; returns a typed path that can be chosen.
    fn collect(&mut self) -> Option<PathBuf> {
        let Listing::Reading(results) = &self.listing else { return None };
        let read = match results.try_recv() {
            Ok(read) => read,
            Err(std::sync::mpsc::TryRecvError::Empty) => return None,
            Err(std::sync::mpsc::TryRecvError::Disconnected) => {
                Read { problem: Some("The folder could not be read.".into()), ..Read::default() }
            }
        };
        if let Some(taken) = read.taken.clone() {
            if !read.exists {
                return Some(taken);
            }
            self.overwrite = Some(taken);
        }
        if read.folder.is_absolute() && read.folder != self.folder {
            self.folder.clone_from(&read.folder);
            // A path that led here has been used up.
            if self.purpose.saves() {
                let name = Path::new(&self.typed).file_name().map(|name| name.to_string_lossy().into_owned());
                self.typed = name.unwrap_or_default();
            } else {
                self.typed.clear();
            }
        }
        self.takes_keys = true;
        self.listing = Listing::Read(read);
        None
    }

    /// The path of the folder, with a button for each ancestor.
    fn above(&mut self, ui: &mut Ui) {
        let mut wanted = None;
        ui.horizontal_wrapped(|ui| {
            ui.spacing_mut().item_spacing.x = 2.0;
            let mut parts: Vec<&Path> = self.folder.ancestors().collect();
            parts.reverse();
            for part in parts {
                let name = part.file_name().map_or_else(|| "/".into(), |name| name.to_string_lossy());
                if ui.add(Button::new(name.as_ref()).small()).clicked() {
                    wanted = Some(part.to_owned());
                }
            }
        });
        self.go(wanted);
    }

    /// Home, recent folders, and a new one.
    fn places(&mut self, ui: &mut Ui) {
        let mut wanted = None;
        ui.allocate_ui_with_layout(
            vec2(PLACES, LIST.y + 8.0),
            Layout::top_down_justified(Align::Min),
            |ui| {
                ui.set_width(PLACES);
                if ui.add(Button::new("Home").right_text("")).clicked() {
                    wanted = Some(home("~"));
                }
                if ui.add(Button::new("New folder").right_text("")).clicked() {
                    self.new_folder = Some(String::new());
                }
                if !self.recent.is_empty() {
                    ui.add_space(6.0);
                    ui.weak("Recent");
                }
                for folder in self.recent.iter().take(7) {
                    let last: Vec<_> =
                        folder.iter().rev().take(2).map(|part| part.to_string_lossy()).collect();
                    let name = last.into_iter().rev().collect::<Vec<_>>().join("/");
                    let button = Button::new(name).frame(false).truncate().right_text("");
                    if ui.add(button).on_hover_text(folder.to_string_lossy()).clicked() {
                        wanted = Some(folder.clone());
                    }
                }
            },
        );
        self.go(wanted);
    }

    fn list(&mut self, ui: &mut Ui) {
        let (mut wanted, mut chosen) = (None, None);
        let frame =
            egui::Frame::new().fill(ui.visuals().extreme_bg_color).inner_margin(4.0).corner_radius(4.0);
        frame.show(ui, |ui| {
            ui.set_width(LIST.x);
            ui.vertical(|ui| {
                let area =
                    ScrollArea::vertical().auto_shrink(false).max_height(LIST.y).min_scrolled_height(LIST.y);
                let Listing::Read(read) = &self.listing else {
                    area.show(ui, |ui| ui.weak("Reading…"));
                    return;
                };
                area.show(ui, |ui| {
                    if let Some(problem) = &read.problem {
                        ui.add(
                            egui::Label::new(
                                RichText::new(problem).color(theme::words(ui.visuals(), theme::BAD)),
                            )
                            .wrap(),
                        );
                    }
                    ui.with_layout(Layout::top_down_justified(Align::Min), |ui| {
                        for entry in &read.entries {
                            let response = row(
                                ui,
                                entry,
                                self.typed == entry.name,
                                (&self.folder, &mut self.thumbnails),
                            );
                            if response.clicked() && entry.is_file {
                                chosen = Some((entry.name.clone(), false));
                            } else if response.clicked() {
                                wanted = Some(self.folder.join(&entry.name));
                            }
                            if response.double_clicked() && entry.is_file {
                                chosen = Some((entry.name.clone(), true));
                            }
                        }
                    });
                    if read.entries.is_empty() && read.problem.is_none() {
                        ui.weak(format!("No folders or matching files here ({}).", self.purpose.files().0));
                    }
                });
            });
        });
        self.go(wanted);
        if let Some((name, at_once)) = chosen {
            self.typed = name;
            if at_once {
                self.take();
            }
        }
    }

    /// The field of the name and the buttons.
    fn below(&mut self, ui: &mut Ui) -> Option<Option<PathBuf>> {
        if let Some(path) = self.overwrite.clone() {
            return self.ask_again(ui, path);
        }
        if self.new_folder.is_some() {
            self.ask_folder_name(ui);
            return None;
        }
        let hint = if self.purpose.saves() { "Name or path of the file" } else { "Name or path" };
        let entered = self.field(ui, hint);
        let mut answer = None;
        ui.add_space(4.0);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let folder = self.purpose.files().1.is_empty();
            let name = if self.purpose.saves() {
                "Save"
            } else if folder {
                "Choose this folder"
            } else {
                "Open"
            };
            let ready = folder || !self.typed.trim().is_empty();
            if ui.add_enabled(ready, Button::new(name).fill(ui.visuals().selection.bg_fill)).clicked()
                || (entered && ready)
            {
                self.take();
            }
            if ui.button("Cancel").clicked() {
                answer = Some(None);
            }
        });
        answer
    }

    /// The field of the name or path; returns whether Enter was pressed in it.
    fn field(&mut self, ui: &mut Ui, hint: &str) -> bool {
        let id = field_id();
        let idle = ui.memory(|memory| memory.focused().is_none());
        let field = TextEdit::singleline(&mut self.typed).id(id).hint_text(hint).desired_width(f32::INFINITY);
        let mut shown = field.show(ui);
        let response = shown.response.response.accessible_name("Path");
        if std::mem::take(&mut self.takes_keys) | idle {
            ui.memory_mut(|memory| memory.request_focus(id));
        }
        if let Some(range) = self.selects.take() {
            shown.state.cursor.set_char_range(Some(range));
            shown.state.store(ui.ctx(), id);
        }
        response.lost_focus() && ui.input(|i| i.key_pressed(Key::Enter))
    }

    fn ask_again(&mut self, ui: &mut Ui, path: PathBuf) -> Option<Option<PathBuf>> {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let colour = theme::words(ui.visuals(), theme::WARN);
        ui.colored_label(colour, format!("'{name}' already exists. Overwrite it?"));
        let mut answer = None;
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            if ui.button("Overwrite").clicked() {
                answer = Some(Some(path));
            }
            if ui.button("Choose another name").clicked() {
                self.overwrite = None;
                self.takes_keys = true;
            }
        });
        answer
    }

    fn ask_folder_name(&mut self, ui: &mut Ui) {
        let Some(mut name) = self.new_folder.take() else { return };
        let field =
            TextEdit::singleline(&mut name).hint_text("Name of the new folder").desired_width(f32::INFINITY);
        let response = ui.add(field).accessible_name("New folder");
        let entered = response.lost_focus() && ui.input(|i| i.key_pressed(Key::Enter));
        if !entered && !response.has_focus() {
            response.request_focus();
        }
        ui.add_space(4.0);
        let (mut makes, mut stays) = (entered, true);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            makes |= ui.add(Button::new("Make folder").fill(ui.visuals().selection.bg_fill)).clicked();
            stays &= !ui.button("Back").clicked();
        });
        if makes && !name.trim().is_empty() {
            self.listing = make(self.folder.join(name.trim()), self.purpose.clone(), &self.wake);
        } else if stays {
            self.new_folder = Some(name);
        } else {
            self.takes_keys = true;
        }
    }

    fn go(&mut self, folder: Option<PathBuf>) {
        if let Some(folder) = folder {
            self.listing = read(folder, None, self.purpose.clone(), &self.wake);
        }
    }

    /// Resolves the typed path.
    fn take(&mut self) {
        let typed = self.typed.trim();
        let path = if typed.is_empty() { self.folder.clone() } else { self.folder.join(home(typed)) };
        self.listing = read(self.folder.clone(), Some(path), self.purpose.clone(), &self.wake);
    }
}

fn field_id() -> Id {
    Id::unique("name in the file dialog")
}

/// A folder or file of the list; pictures have a thumbnail, decoded once they are seen.
fn row(
    ui: &mut Ui,
    entry: &FolderEntry,
    chosen: bool,
    (folder, thumbnails): (&Path, &mut Thumbnails),
) -> egui::Response {
    if !entry.is_file {
        return ui.selectable_label(chosen, RichText::new(format!("{}/", entry.name)).strong());
    }
    if !is_picture(&entry.name) {
        return ui.selectable_label(chosen, &entry.name);
    }
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), PICTURE), Sense::click());
    response.widget_info(|| egui::WidgetInfo::selected(egui::Role::Button, true, chosen, &entry.name));
    if !ui.is_rect_visible(rect) {
        return response;
    }
    if chosen || response.hovered() {
        let fill =
            if chosen { ui.visuals().selection.bg_fill } else { ui.visuals().widgets.hovered.weak_bg_fill };
        ui.painter().rect_filled(rect, 3.0, fill);
    }
    let place = egui::Rect::from_min_size(rect.min + vec2(4.0, 2.0), vec2(56.0, PICTURE - 4.0));
    ui.painter().rect_filled(place, 2.0, theme::SURROUND);
    if let Some(texture) = thumbnails.of(ui.ctx(), &folder.join(&entry.name)) {
        let size = texture.size_vec2();
        let scale = (place.width() / size.x).min(place.height() / size.y);
        let at = egui::Rect::from_center_size(place.center(), size * scale);
        egui::Image::new(texture).paint_at(ui, at);
    }
    let at = egui::pos2(place.right() + 8.0, rect.center().y);
    let font = egui::TextStyle::Body.resolve(ui.style());
    ui.painter().text(at, egui::Align2::LEFT_CENTER, &entry.name, font, ui.visuals().text_color());
    response
}
