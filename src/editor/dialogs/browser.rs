//! The built-in file dialog for systems without one: a list of folders and files, and a path field.

use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, channel};
use std::thread;

use egui::{Button, Context, Key, RichText, ScrollArea, TextEdit, Ui};

use super::modal::modal;
use super::request::{PickRequest, Purpose, with_ending};
use crate::editor::theme;

/// Maximum number of listed entries of a folder.
const MOST: usize = 5_000;

/// The state of the open dialog.
pub(super) struct Browser {
    purpose: Purpose,
    folder: PathBuf,
    /// The typed path, relative to the folder or absolute.
    typed: String,
    listing: Listing,
    /// An existing file that needs a confirmation before it is overwritten.
    overwrite: Option<PathBuf>,
    wake: Context,
}

enum Listing {
    Reading(Receiver<Read>),
    Read(Read),
}

/// The content of a folder, or the result of a typed path.
#[derive(Clone, Debug, Default)]
struct Read {
    folder: PathBuf,
    entries: Vec<FolderEntry>,
    problem: Option<String>,
    /// The typed path, if it can be chosen.
    taken: Option<PathBuf>,
    /// Whether it would overwrite a file.
    exists: bool,
}

#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct FolderEntry {
    is_file: bool,
    name: String,
}

impl Browser {
    pub(super) fn new(request: &PickRequest, ctx: &Context) -> Self {
        let folder = request.folder.clone();
        let home = || directories::UserDirs::new().map(|dirs| dirs.home_dir().to_owned());
        let folder =
            folder.or_else(|| std::env::current_dir().ok()).or_else(home).unwrap_or_else(|| "/".into());
        let listing = read(folder.clone(), None, request.purpose.clone(), ctx);
        Self {
            purpose: request.purpose.clone(),
            folder,
            typed: request.name.clone(),
            listing,
            overwrite: None,
            wake: ctx.clone(),
        }
    }

    /// Shows the dialog; returns the chosen path, or `Some(None)` when cancelled.
    pub(super) fn show(&mut self, ctx: &Context) -> Option<Option<PathBuf>> {
        if let Some(taken) = self.collect() {
            return Some(Some(taken));
        }
        let mut answer = None;
        let shown = modal(ctx, "file dialog").show(ctx, |ui| {
            ui.set_width(560.0);
            ui.heading(self.purpose.title());
            ui.add_space(4.0);
            self.above(ui);
            self.list(ui);
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
                Read { problem: Some("the folder could not be read".into()), ..Read::default() }
            }
        };
        if let Some(taken) = read.taken.clone() {
            if !read.exists {
                return Some(taken);
            }
            self.overwrite = Some(taken);
        }
        if read.problem.is_none() {
            self.folder.clone_from(&read.folder);
        }
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

    fn list(&mut self, ui: &mut Ui) {
        let mut wanted = None;
        let mut chosen = None;
        egui::Frame::new().fill(ui.visuals().extreme_bg_color).inner_margin(4.0).corner_radius(4.0).show(
            ui,
            |ui| {
                let area =
                    ScrollArea::vertical().auto_shrink(false).max_height(260.0).min_scrolled_height(260.0);
                let Listing::Read(read) = &self.listing else {
                    area.show(ui, |ui| ui.weak("Reading…"));
                    return;
                };
                area.show(ui, |ui| {
                    if let Some(problem) = &read.problem {
                        ui.colored_label(theme::BAD, problem);
                    }
                    ui.with_layout(egui::Layout::top_down_justified(egui::Align::Min), |ui| {
                        for entry in &read.entries {
                            let text = if entry.is_file {
                                RichText::new(&entry.name)
                            } else {
                                RichText::new(format!("{}/", entry.name)).strong()
                            };
                            let response = ui.selectable_label(self.typed == entry.name, text);
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
            },
        );
        self.go(wanted);
        if let Some((name, at_once)) = chosen {
            self.typed = name;
            if at_once {
                self.take();
            }
        }
    }

    /// The path field and the buttons.
    fn below(&mut self, ui: &mut Ui) -> Option<Option<PathBuf>> {
        if let Some(path) = self.overwrite.clone() {
            return self.ask_again(ui, path);
        }
        let hint = if self.purpose.saves() { "Name or path of the file" } else { "Name or path" };
        let field = TextEdit::singleline(&mut self.typed).hint_text(hint).desired_width(f32::INFINITY);
        let response = ui.add(field).accessible_name("Path");
        let entered = response.lost_focus() && ui.input(|i| i.key_pressed(Key::Enter));
        let mut answer = None;
        ui.add_space(4.0);
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
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

    fn ask_again(&mut self, ui: &mut Ui, path: PathBuf) -> Option<Option<PathBuf>> {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        ui.colored_label(theme::WARN, format!("'{name}' already exists. Overwrite it?"));
        let mut answer = None;
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            if ui.button("Overwrite").clicked() {
                answer = Some(Some(path));
            }
            if ui.button("Choose another name").clicked() {
                self.overwrite = None;
            }
        });
        answer
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

/// A typed path with ~ replaced by the home folder.
fn home(typed: &str) -> PathBuf {
    let rest = typed.strip_prefix("~/").or_else(|| (typed == "~").then_some(""));
    match (rest, directories::UserDirs::new()) {
        (Some(rest), Some(dirs)) => dirs.home_dir().join(rest),
        _ => typed.into(),
    }
}

/// Reads a folder, or resolves a path, on a thread of its own.
fn read(folder: PathBuf, path: Option<PathBuf>, purpose: Purpose, wake: &Context) -> Listing {
    let (sender, receiver) = channel();
    let wake = wake.clone();
    let work = move || {
        // The dialog may be closed by now.
        let _ = sender.send(look(folder, path, purpose));
        wake.request_repaint();
    };
    // Without a thread the sender is dropped, which shows as a message.
    let _ = thread::Builder::new().name("folder".into()).spawn(work);
    Listing::Reading(receiver)
}

fn look(folder: PathBuf, path: Option<PathBuf>, purpose: Purpose) -> Read {
    let wants_folder = purpose.files().1.is_empty();
    match path {
        // A folder that was typed is gone to, unless it is what is wanted.
        Some(path) if path.is_dir() && !wants_folder => list(path, purpose),
        Some(path) if wants_folder || path.is_file() || purpose.saves() => {
            let saved = with_ending(&purpose, path.clone());
            let exists = purpose.saves() && saved.exists();
            Read { taken: Some(path), exists, ..list(folder, purpose) }
        }
        Some(path) => {
            let problem = Some(format!("'{}' does not exist", path.display()));
            Read { problem, ..list(folder, purpose) }
        }
        None => list(folder, purpose),
    }
}

/// The folders and the files of the wanted kind, sorted by name, without hidden ones.
fn list(folder: PathBuf, purpose: Purpose) -> Read {
    let folder = folder.canonicalize().unwrap_or(folder);
    let entries = match std::fs::read_dir(&folder) {
        Ok(entries) => entries,
        Err(error) => {
            let problem = Some(format!("'{}' cannot be read: {error}", folder.display()));
            return Read { folder, problem, ..Read::default() };
        }
    };
    let endings = purpose.files().1;
    let wanted = |path: &Path| {
        let ending = path.extension().map(|e| e.to_string_lossy().to_lowercase());
        ending.is_some_and(|ending| endings.contains(&ending.as_str()))
    };
    let mut entries: Vec<FolderEntry> = entries
        .flatten()
        .take(MOST)
        .filter_map(|entry| {
            let name = entry.file_name().to_string_lossy().into_owned();
            let is_file = !entry.path().is_dir();
            let shown = !name.starts_with('.') && (!is_file || wanted(&entry.path()));
            shown.then_some(FolderEntry { is_file, name })
        })
        .collect();
    entries.sort();
    Read { folder, entries, ..Read::default() }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn place() -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("frames")).unwrap();
        for name in ["b.json", "A.JSON", "d.obj", ".hidden.json"] {
            std::fs::write(folder.path().join(name), "{}").unwrap();
        }
        folder
    }

    #[test]
    fn folders_come_first_and_only_files_of_the_kind_are_listed() {
        let folder = place();
        let names = |purpose| {
            list(folder.path().into(), purpose).entries.into_iter().map(|e| e.name).collect::<Vec<_>>()
        };
        assert_eq!(names(Purpose::OpenProject), ["frames", "A.JSON", "b.json"]);
        assert_eq!(names(Purpose::ExportFolder), ["frames"]);
        assert_eq!(names(Purpose::Asset(crate::editor::asset::AssetUse::Mesh)), ["frames", "d.obj"]);
    }

    #[test]
    fn a_typed_path_leads_to_a_file_a_folder_or_a_message() {
        let folder = place();
        let at = |name: &str, purpose| look(folder.path().into(), Some(folder.path().join(name)), purpose);
        assert_eq!(at("b.json", Purpose::OpenProject).taken, Some(folder.path().join("b.json")));
        let inside = at("frames", Purpose::OpenProject);
        assert!(inside.taken.is_none() && inside.folder.ends_with("frames"));
        assert!(at("none.json", Purpose::OpenProject).problem.is_some());
        assert!(at("frames", Purpose::ExportFolder).taken.is_some());
    }

    #[test]
    fn saving_over_a_file_asks_again_also_where_the_ending_was_not_typed() {
        let folder = place();
        let at =
            |name: &str| look(folder.path().into(), Some(folder.path().join(name)), Purpose::SaveProject);
        assert!(at("b.json").exists && at("b").exists);
        assert!(!at("new").exists && at("new").taken.is_some());
    }
}
