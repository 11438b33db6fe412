//! Opening, saving and leaving documents. Nothing here waits for a disk: the saver replies when it is done.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use eframe::egui;
use lightloom_core::scene::mesh;

use super::App;
use super::file_state::{Leave, PendingQuestion};
use crate::editor::asset::{AssetUse, TargetSlot};
use crate::editor::dialogs::{self, PickRequest, Purpose, Question};
use crate::editor::document::Document;
use crate::editor::relative_path;
use crate::editor::store::{Fingerprint, Journal, Recovery, SaveRequest, Saver, StoreReply, StoreRequest};
use crate::editor::templates::{self, TEMPLATES};

impl App {
    /// Handles the replies of threads, file dialogs and questions.
    pub(super) fn receive(&mut self, ctx: &egui::Context) {
        while let Some(answer) = self.files.saver.as_ref().and_then(Saver::answer) {
            self.answered(ctx, answer);
        }
        if let Some((purpose, path)) = self.picker.show(ctx) {
            self.picked(ctx, purpose, path);
        }
        if let Some((question, _)) = &self.files.question {
            if let Some(answer) = question.show(ctx) {
                self.decided(ctx, answer);
            }
        } else if let Some(recovery) = self.files.lost.pop() {
            self.offer(recovery);
        } else if let Some(export) = self.interrupted.pop() {
            let settings = &export.settings;
            let (title, folder) = (settings.project.name.clone(), settings.folder.display().to_string());
            let question = Question::Export { title, folder };
            self.files.question = Some((question, PendingQuestion::Export(Box::new(export))));
        }
        self.imported(ctx);
        let dropped = ctx.input(|input| input.raw.dropped_files.clone());
        for file in dropped {
            self.dropped(ctx, file.path().to_owned());
        }
        if ctx.input(|input| input.viewport().close_requested()) && !self.files.closing {
            ctx.send_viewport_cmd(egui::ViewportCommand::CancelClose);
            self.leave(ctx, Leave::Quit);
        }
    }

    fn answered(&mut self, ctx: &egui::Context, answer: StoreReply) {
        match answer {
            StoreReply::Opened(path, Ok(opened)) => {
                let template = self.files.template.take().is_some_and(|template| template == path);
                let document =
                    Document::opened(opened.file, (!template).then_some((path.clone(), opened.seen)));
                self.replace(document);
                if !template {
                    self.preferences.add_recent(&path);
                }
                if !opened.notes.is_empty() {
                    self.editor.status = opened.notes.join("; ");
                }
            }
            StoreReply::Opened(path, Err(error)) => {
                self.files.template = None;
                self.show_message(format!("'{}' cannot be opened", name(&path)), error.to_string());
            }
            StoreReply::Saved(save, Ok(saved)) => {
                self.place(&save.path);
                self.editor.document.mark_saved(save.project, save.path.clone(), saved.seen);
                let subject = self.subject();
                self.editor.preview.relocated(&subject);
                self.preferences.add_recent(&save.path);
                self.editor.status = saved.note.unwrap_or_else(|| format!("Saved '{}'", name(&save.path)));
                if let Some(leave) = self.files.after_save.take() {
                    self.leave(ctx, leave);
                }
            }
            StoreReply::Saved(save, Err(error)) => {
                self.files.after_save = None;
                self.show_message(format!("'{}' was not saved", name(&save.path)), error.to_string());
            }
            StoreReply::ChangedOnDisk(save) => {
                let question = Question::Changed { title: name(&save.path), unsaved: true };
                self.files.question = Some((question, PendingQuestion::Changed(Box::new(save))));
            }
            StoreReply::Lost(lost) => self.files.lost = lost,
            StoreReply::Failed(why) => self.editor.status = why,
        }
    }

    fn decided(&mut self, ctx: &egui::Context, answer: dialogs::Answer) {
        let Some((_, asked)) = self.files.question.take() else { return };
        match (asked, answer) {
            (PendingQuestion::Leave(leave), dialogs::Answer::Yes) => {
                self.files.after_save = Some(leave);
                self.save(ctx);
            }
            (PendingQuestion::Leave(leave), dialogs::Answer::No) => self.go(ctx, leave),
            (PendingQuestion::Recover(recovery), dialogs::Answer::Yes) => self.recover(*recovery),
            (PendingQuestion::Recover(recovery), dialogs::Answer::No) => {
                self.request(StoreRequest::Discard(recovery));
            }
            (PendingQuestion::Changed(save), dialogs::Answer::Yes) => {
                self.request(StoreRequest::Open(save.path));
            }
            (PendingQuestion::Changed(save), dialogs::Answer::No) => {
                self.request(StoreRequest::Save(SaveRequest { seen: None, ..*save }));
            }
            (PendingQuestion::Export(export), dialogs::Answer::Yes) => {
                self.exports.add(export.settings.clone());
                export.forget();
                self.windows.export.open = true;
            }
            (PendingQuestion::Export(export), dialogs::Answer::No) => export.forget(),
            (_, dialogs::Answer::Cancel) | (PendingQuestion::Nothing, _) => self.files.after_save = None,
        }
    }

    /// Opens work recovered from a crash.
    fn recover(&mut self, recovery: Recovery) {
        match &recovery.work {
            Ok(file) => {
                let at = recovery.path.clone().zip(recovery.seen);
                let mut document = Document::opened(file.clone(), at);
                document.mark_unsaved();
                self.replace(document);
                self.files.journal = Some(Journal::resume(recovery));
            }
            Err(error) => self.show_message("The recovery file cannot be read".into(), error.to_string()),
        }
    }

    fn offer(&mut self, recovery: Recovery) {
        let minutes = recovery.age.as_secs() / 60;
        let when = match minutes {
            0 => "less than a minute ago".to_owned(),
            1..120 => format!("{minutes} minutes ago"),
            _ => format!("{} hours ago", minutes / 60),
        };
        let (title, file_changed) = (recovery.title.clone(), recovery.file_changed);
        let question = Question::Recover { title, when, file_changed };
        self.files.question = Some((question, PendingQuestion::Recover(Box::new(recovery))));
    }

    /// Leaves the document, after a question where it has unsaved changes.
    pub(super) fn leave(&mut self, ctx: &egui::Context, leave: Leave) {
        if self.editor.document.is_unsaved() {
            let question = Question::Unsaved { title: self.editor.document.title() };
            self.files.question = Some((question, PendingQuestion::Leave(leave)));
        } else {
            self.go(ctx, leave);
        }
    }

    fn go(&mut self, ctx: &egui::Context, leave: Leave) {
        if let Some(journal) = &self.files.journal {
            journal.clean();
        }
        match leave {
            Leave::Quit => {
                self.files.closing = true;
                ctx.send_viewport_cmd(egui::ViewportCommand::Close);
            }
            Leave::Open(path) => self.request(StoreRequest::Open(path)),
            Leave::Empty => self.begin_empty(),
            Leave::New(template) => {
                let Some(folder) = templates::folder() else {
                    return self.show_message("The examples are missing".into(), templates::MISSING.into());
                };
                let path = folder.join(TEMPLATES[template.min(TEMPLATES.len() - 1)].file);
                self.files.template = Some(path.clone());
                self.request(StoreRequest::Open(path));
            }
        }
    }

    /// Names the project's files from the folder of `path`, where it is saved now.
    fn place(&mut self, path: &Path) {
        let from = templates::file_of(&self.editor.document);
        if from.parent() != path.parent() {
            self.editor.document.relocate(|project| relative_path::relocated(project, &from, path));
        }
    }

    /// Asks for a project to open.
    pub(super) fn ask_what_to_open(&mut self, ctx: &egui::Context) {
        let folder = templates::file_of(&self.editor.document).parent().map(Path::to_owned);
        self.picker.ask(PickRequest::new(Purpose::OpenProject).in_folder(folder), ctx);
    }

    /// Saves to the document's file, or asks for one.
    pub(super) fn save(&mut self, ctx: &egui::Context) {
        match self.editor.document.path().map(Path::to_owned) {
            Some(path) => self.save_to(path, self.editor.document.seen()),
            None => self.save_as(ctx),
        }
    }

    /// Asks for a file to save to.
    pub(super) fn save_as(&mut self, ctx: &egui::Context) {
        let folder = self.editor.document.path().and_then(Path::parent).map(Path::to_owned);
        let name = match self.editor.document.path() {
            Some(path) => name(path),
            None => format!("{}.json", self.editor.document.title().to_lowercase().replace([' ', ','], "_")),
        };
        self.picker.ask(PickRequest::new(Purpose::SaveProject).in_folder(folder).named(name), ctx);
    }

    fn save_to(&mut self, path: PathBuf, seen: Option<Fingerprint>) {
        let from = templates::file_of(&self.editor.document);
        let project = match from.parent() == path.parent() {
            true => self.editor.document.project().clone(),
            false => Arc::new(relative_path::relocated(self.editor.document.project(), &from, &path)),
        };
        match self.editor.document.file() {
            Ok(file) => self.request(StoreRequest::Save(SaveRequest { path, file, project, seen })),
            Err(error) => self.show_message("The project cannot be saved".into(), error.to_string()),
        }
    }

    fn request(&mut self, request: StoreRequest) {
        if !self.files.request(request) {
            self.editor.status =
                "no thread could be started for file access; nothing can be opened or saved".into();
        }
    }

    fn picked(&mut self, ctx: &egui::Context, purpose: Purpose, path: PathBuf) {
        match purpose {
            Purpose::OpenProject => self.leave(ctx, Leave::Open(path)),
            Purpose::SaveProject => self.save_to(path, None),
            Purpose::ExportFolder => self.windows.export.set_folder(path),
            Purpose::Frames => self.windows.player.play(ctx, &path),
            Purpose::Import => self.dropped(ctx, path),
            Purpose::Asset(pick) => self.insert(&pick, &path),
        }
    }

    /// Asks for a file for the project.
    pub(super) fn pick_file(&mut self, ctx: &egui::Context, pick: AssetUse) {
        let folder = templates::file_of(&self.editor.document).parent().map(Path::to_owned);
        self.picker.ask(PickRequest::new(Purpose::Asset(pick)).in_folder(folder), ctx);
    }

    /// Asks for a scene or a picture to import.
    pub(super) fn ask_what_to_import(&mut self, ctx: &egui::Context) {
        let folder = templates::file_of(&self.editor.document).parent().map(Path::to_owned);
        self.picker.ask(PickRequest::new(Purpose::Import).in_folder(folder), ctx);
    }

    /// Puts a file into the project. Picking a file outside the project folder allows external files.
    fn insert(&mut self, pick: &AssetUse, file: &Path) {
        if *pick == AssetUse::Mesh {
            return self.import(file);
        }
        let base = templates::file_of(&self.editor.document);
        let written = relative_path::relative(file, &base);
        self.external = true;
        if let Some(edit) = pick.edit(self.editor.document.project(), written) {
            self.editor.edit(edit);
            self.editor.document.settle();
        }
    }

    /// A file that was dropped on the window: a project is opened, a folder of frames is played, a mesh comes into the scene, a picture or points become
    /// what the key frame after the playhead shows.
    fn dropped(&mut self, ctx: &egui::Context, file: PathBuf) {
        let ending = file.extension().map(|ending| ending.to_string_lossy().to_lowercase());
        let ends = |pick: &AssetUse| ending.as_deref().is_some_and(|ending| pick.files().1.contains(&ending));
        let keys = &self.editor.document.project().keys;
        let after = keys.iter().position(|key| key.frame >= self.editor.session.playhead);
        let at = TargetSlot { key: after.unwrap_or(keys.len().saturating_sub(1)), caustic: None };
        if file.is_dir() {
            return self.windows.player.play(ctx, &file);
        }
        if ending.as_deref() == Some("json") {
            return self.leave(ctx, Leave::Open(file));
        }
        match [AssetUse::Mesh, AssetUse::Picture(at.clone()), AssetUse::Points(at)]
            .iter()
            .find(|pick| ends(pick))
        {
            Some(pick) => self.insert(pick, &file),
            None => match mesh::advice(&file) {
                Some(advice) => {
                    self.show_message(format!("'{}' is not read", name(&file)), format!("It {advice}."));
                }
                None => {
                    self.editor.status =
                        format!("'{}' is not a project, mesh, picture or point file", name(&file));
                }
            },
        }
    }

    /// Shows a message window.
    pub(super) fn show_message(&mut self, title: String, text: String) {
        self.files.question = Some((Question::Message { title, text }, PendingQuestion::Nothing));
    }
}

/// The name of a file without its folder.
pub(super) fn name(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}
