//! Opening, saving and leaving documents. Nothing here waits for a disk: the saver replies when it is done.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use eframe::egui;
use lightloom_core::project::{Project, ProjectFile, moved};

use super::App;
use super::file_state::{Leave, Opening, PendingQuestion};
use crate::editor::dialogs::{self, PickRequest, Purpose, Question};
use crate::editor::document::Document;
use crate::editor::export::interrupted;
use crate::editor::menu::ago;
use crate::editor::store::{
    Backup, Fingerprint, Hold, Journal, Origin, Recovery, SaveRequest, Saved, Saver, StoreReply, StoreRequest,
};
use crate::editor::templates::{self, TEMPLATES};

impl App {
    /// Handles the replies of threads, file dialogs and questions.
    pub(super) fn receive(&mut self, ctx: &egui::Context) {
        self.look_again(ctx);
        while let Some(answer) = self.files.saver.as_ref().and_then(Saver::answer) {
            self.answered(ctx, answer);
        }
        self.notice_changes();
        if let Some((purpose, path)) = self.picker.show(ctx) {
            self.picked(ctx, purpose, path);
        }
        if let Some((question, _)) = &self.files.question {
            if let Some(answer) = question.show(ctx) {
                self.decided(ctx, answer);
            }
        } else if !self.files.waiting.is_empty() {
            self.files.question = Some(self.files.waiting.remove(0));
        } else if let Some(recovery) = self.files.lost.pop() {
            self.offer(recovery);
        } else if let Some(export) = self.interrupted.pop() {
            let settings = &export.settings;
            let own = settings.project.name.trim();
            let title = if own.is_empty() { name(&settings.file) } else { own.to_owned() };
            let folder = settings.folder.display().to_string();
            let question = Question::Export { title, folder };
            self.files.question = Some((question, PendingQuestion::Export(Box::new(export))));
        }
        self.imported(ctx);
        self.collected(ctx);
        self.placed(ctx);
        if std::mem::take(&mut self.files.asks_outside) {
            self.find_outside();
        }
        let dropped = ctx.input(|input| input.raw.dropped_files.clone());
        for file in dropped {
            self.dropped(ctx, file.path().to_owned());
        }
        if ctx.input(|input| input.viewport().close_requested()) && !self.files.closing {
            ctx.send_viewport_cmd(egui::ViewportCommand::CancelClose);
            self.leave(ctx, Leave::Quit);
        }
    }

    /// Looks again for what an earlier run left. What is found already is held, and not found again.
    fn look_again(&mut self, ctx: &egui::Context) {
        let Some(&seconds) = self.looks_again.as_slice().first() else { return };
        let left = Duration::from_secs(seconds).saturating_sub(self.begun.elapsed());
        if !left.is_zero() {
            return ctx.request_repaint_after(left);
        }
        self.looks_again.next();
        self.files.request(StoreRequest::LookForLost);
        self.interrupted.extend(self.records.iter().flat_map(|records| interrupted(records)));
        ctx.request_repaint();
    }

    fn answered(&mut self, ctx: &egui::Context, answer: StoreReply) {
        match answer {
            StoreReply::Opened(path, Ok(opened)) => {
                let opening =
                    self.files.opening.take().filter(|(of, _)| *of == path).map(|(_, opening)| opening);
                let at = match &opening {
                    None => Some((path.clone(), opened.seen)),
                    Some(Opening::Backup(of, seen)) => Some((of.clone(), *seen)),
                    Some(Opening::Template) => None,
                };
                let mut document = Document::opened(opened.file, at);
                match opening {
                    None => self.preferences.add_recent(&path),
                    Some(Opening::Backup(..)) => document.mark_unsaved(),
                    Some(Opening::Template) => (),
                }
                self.replace(document);
                if !opened.notes.is_empty() {
                    self.editor.status = opened.notes.join("; ");
                }
            }
            StoreReply::Opened(path, Err(error)) => {
                self.files.opening = None;
                self.show_message(format!("'{}' cannot be opened", name(&path)), error.to_string());
            }
            StoreReply::Saved(save, Ok(saved)) => {
                self.saved(&save, saved);
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
                self.files.ask(question, PendingQuestion::Changed(Box::new(save)));
            }
            StoreReply::Attached(path, hold, backups) => self.attached(&path, hold, backups),
            StoreReply::ChangedMeanwhile(path, seen) => self.changed_meanwhile(path, seen),
            StoreReply::Outside(_, files) => self.ask_outside(files),
            StoreReply::Located(path, outside) => self.located(&path, outside),
            StoreReply::Lost(lost) => self.files.lost.extend(lost),
            StoreReply::Failed(why) => self.editor.status = why,
            StoreReply::Fault(words) => {
                (self.files.after_save, self.files.opening) = (None, None);
                let text = format!(
                    "A fault of the program: {words}. What was being read or written then was not; the work is unharmed, try again."
                );
                self.show_message("A file was not read or written".into(), text);
            }
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
            (PendingQuestion::ChangedMeanwhile(path, _), dialogs::Answer::Yes) => {
                self.request(StoreRequest::Open(path));
            }
            (PendingQuestion::ChangedMeanwhile(_, seen), dialogs::Answer::No) => {
                self.editor.document.keep_over(seen);
            }
            (PendingQuestion::Pick(path, pick), answer) => self.decide_pick(&pick, &path, answer),
            (PendingQuestion::Outside(files), answer) => self.decide_outside(files, answer),
            (PendingQuestion::Changed(save), dialogs::Answer::No) => {
                self.request(StoreRequest::Save(SaveRequest { seen: None, ..*save }));
            }
            (PendingQuestion::Export(export), dialogs::Answer::Yes) => {
                self.exports.add(export.settings.clone());
                if export.settings.file == templates::file_of(&self.editor.document) {
                    self.windows.export.show_options_of(&export.settings);
                }
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
                let here = templates::file_of(&document);
                if let Some(there) = recovery.base.as_ref().filter(|there| **there != here) {
                    document.relocate(|project| project.relocated(there, &here));
                }
                document.mark_unsaved();
                // The user let it read them before.
                self.replace_admitting(document, &recovery.admitted);
                self.files.journal = Some(Journal::resume(recovery));
            }
            Err(error) => self.show_message("The recovery file cannot be read".into(), error.to_string()),
        }
    }

    fn offer(&mut self, recovery: Recovery) {
        let when = ago(recovery.age);
        let (title, file_changed) = (recovery.title.clone(), recovery.file_changed);
        let question = Question::Recover { title, when, file_changed };
        self.files.ask(question, PendingQuestion::Recover(Box::new(recovery)));
    }

    /// Leaves the document, after a question where it has unsaved changes.
    pub(super) fn leave(&mut self, ctx: &egui::Context, leave: Leave) {
        if self.editor.document.is_unsaved() {
            let question = Question::Unsaved { title: self.editor.document.title() };
            self.files.ask(question, PendingQuestion::Leave(leave));
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
                self.device.close();
                ctx.send_viewport_cmd(egui::ViewportCommand::Close);
            }
            Leave::Open(path) => self.request(StoreRequest::Open(path)),
            Leave::Empty => self.begin_empty(),
            Leave::Backup(backup) => {
                let document = &self.editor.document;
                if let Some((path, seen)) = document.path().map(Path::to_owned).zip(document.seen()) {
                    self.files.opening = Some((backup.clone(), Opening::Backup(path, seen)));
                    self.request(StoreRequest::Open(backup));
                }
            }
            Leave::New(template) => {
                let Some(folder) = templates::folder() else {
                    return self.show_message("The examples are missing".into(), templates::MISSING.into());
                };
                let path = folder.join(TEMPLATES[template.min(TEMPLATES.len() - 1)].file);
                self.files.opening = Some((path.clone(), Opening::Template));
                self.request(StoreRequest::Open(path));
            }
        }
    }

    /// The document was written: it and its history name files as they are called there.
    fn saved(&mut self, save: &SaveRequest, saved: Saved) {
        let (from, to) = (templates::file_of(&self.editor.document), save.path.clone());
        let [old_name, new_name] = [&self.editor.document.project().output.name, &saved.project.output.name];
        let (old_name, new_name) = (old_name.clone(), new_name.clone());
        let title = Some(saved.project.name.clone()).filter(|_| self.editor.document.path().is_none());
        let moves = from.parent() != to.parent() || saved.renamed.iter().any(|(old, new)| old != new);
        if moves || old_name != new_name || title.is_some() {
            let admitted = self.files.admitted.clone();
            let folder = from.parent().map(Path::to_owned).unwrap_or_default();
            self.editor.document.relocate(|project| {
                let mut project = project.clone();
                project.rename_files(|file| {
                    saved.renamed.get(file).cloned().unwrap_or_else(|| {
                        // Only the history names it: it is copied should it come back.
                        admitted.add(&folder.join(file));
                        moved(file, &from, &to)
                    })
                });
                if project.output.name == old_name {
                    project.output.name.clone_from(&new_name);
                }
                if let Some(title) = title.as_ref().filter(|_| project.name.is_empty()) {
                    project.name.clone_from(title);
                }
                project
            });
        }
        let new = self.editor.document.path() != Some(&to);
        self.editor.document.mark_saved(saved.project, to.clone(), saved.seen);
        let subject = self.subject();
        self.editor.preview.relocated(&subject);
        self.preferences.add_recent(&to);
        let copied = match saved.copied {
            0 => String::new(),
            1 => "; 1 file was copied beside it".to_owned(),
            count => format!("; {count} files were copied beside it"),
        };
        self.editor.status = saved.note.unwrap_or_else(|| format!("Saved '{}'{copied}", name(&to)));
        if new {
            self.files.backups.clear();
        }
        self.request(StoreRequest::Attach(Some((to, saved.seen))));
    }

    /// Holds and watches the file of the document that was opened, and looks for files outside of its folder.
    pub(super) fn attach(&mut self) {
        if let Some(version) = self.editor.document.project().newer() {
            let text = format!(
                "It is of version {version} of the format. What this program does not know of it is not shown, and kept. It is \
                 opened read-only: Save asks for another name."
            );
            self.editor.document.protect("a newer Lightloom wrote it".into());
            self.show_message(
                format!("'{}' was written by a newer Lightloom", self.editor.document.title()),
                text,
            );
        }
        let document = &self.editor.document;
        let file = document.path().map(Path::to_owned).zip(document.seen());
        self.files.request(StoreRequest::Attach(file));
        self.find_outside();
    }

    fn attached(&mut self, path: &Path, hold: Hold, backups: Vec<Backup>) {
        if self.editor.document.path() != Some(path) {
            return;
        }
        self.files.backups = backups;
        match hold {
            Hold::Here(notice) => {
                self.editor.status = notice.unwrap_or_else(|| std::mem::take(&mut self.editor.status));
            }
            Hold::Elsewhere(who) => {
                let title = format!("'{}' is open in {who}", name(path));
                let text = "It is opened read-only here: Save asks for another name.".to_owned();
                self.editor.document.protect(format!("it is open in {who}"));
                self.show_message(title, text);
            }
        }
    }

    fn changed_meanwhile(&mut self, path: PathBuf, seen: Fingerprint) {
        let document = &self.editor.document;
        if document.path() == Some(&path) && document.seen() != Some(seen) {
            let question = Question::Changed { title: name(&path), unsaved: document.is_unsaved() };
            self.files.ask(question, PendingQuestion::ChangedMeanwhile(path, seen));
        }
    }

    /// Where the paths of the open project hold, and what it may read.
    pub(super) fn origin(&self) -> Origin {
        Origin {
            file: templates::file_of(&self.editor.document),
            admitted: self.files.admitted.clone(),
            trusted: self.files.trusted.clone(),
        }
    }

    /// The folder of the document's file; none where it has none, and dialogs begin in the user's last folder.
    pub(super) fn own_folder(&self) -> Option<PathBuf> {
        self.editor.document.path().and_then(Path::parent).map(Path::to_owned)
    }

    /// Asks for a project to open.
    pub(super) fn ask_what_to_open(&mut self, ctx: &egui::Context) {
        let folder = self.own_folder();
        self.picker.ask(PickRequest::new(Purpose::OpenProject).in_folder(folder), ctx);
    }

    /// Saves to the document's file, or asks for one.
    pub(super) fn save(&mut self, ctx: &egui::Context) {
        match self.editor.document.path().map(Path::to_owned) {
            Some(path) if self.editor.document.read_only().is_none() => {
                self.save_to(path, self.editor.document.seen());
            }
            _ => self.save_as(ctx),
        }
    }

    /// Asks for a file to save to.
    pub(super) fn save_as(&mut self, ctx: &egui::Context) {
        let folder = self.own_folder();
        let name = self.file_name();
        self.picker.ask(PickRequest::new(Purpose::SaveProject).in_folder(folder).named(name), ctx);
    }

    /// The name of the document's file, or one made of its title.
    pub(super) fn file_name(&self) -> String {
        match self.editor.document.path() {
            Some(path) => name(path),
            None => format!(
                "{}.json",
                self.editor.document.title().to_lowercase().replace([' ', ',', '/', '\\'], "_")
            ),
        }
    }

    fn save_to(&mut self, path: PathBuf, seen: Option<Fingerprint>) {
        let document = &mut self.editor.document;
        if let Some(why) = document.read_only().filter(|_| document.path() == Some(&path)) {
            let text = format!("It is read-only here: {why}. Save it under another name.");
            return self.show_message(format!("'{}' was not saved", name(&path)), text);
        }
        let file = match document.file() {
            Ok(file) => file,
            Err(error) => return self.show_message("The project cannot be saved".into(), error.to_string()),
        };
        let mut project = frames_named_after(document.project(), document.path(), &file, &path);
        if document.path().is_none()
            && project.name.is_empty()
            && let Some(stem) = path.file_stem()
        {
            Arc::make_mut(&mut project).name = stem.to_string_lossy().into_owned();
        }
        tracing::info!("saves '{}'", path.display());
        let origin = Some(self.origin());
        self.request(StoreRequest::Save(SaveRequest { path, file, project, origin, seen }));
    }

    pub(super) fn request(&mut self, request: StoreRequest) {
        if !self.files.request(request) {
            self.editor.status =
                "no thread could be started for file access; nothing can be opened or saved".into();
        }
    }

    fn picked(&mut self, ctx: &egui::Context, purpose: Purpose, path: PathBuf) {
        match purpose {
            Purpose::OpenProject => self.leave(ctx, Leave::Open(path)),
            Purpose::SaveProject => self.save_to(path, None),
            Purpose::CollectFolder => self.collect(path),
            Purpose::ExportFolder => self.windows.export.set_folder(path),
            Purpose::Frames => self.windows.player.play(ctx, &path),
            Purpose::Import => self.dropped(ctx, path),
            Purpose::SaveReport => self.save_report(&path),
            Purpose::Asset(pick) => self.locate(pick, path),
        }
    }

    /// Shows a message window.
    pub(super) fn show_message(&mut self, title: String, text: String) {
        tracing::warn!("{title}: {text}");
        self.files.ask(Question::Message { title, text }, PendingQuestion::Nothing);
    }
}

/// The project whose frames are called as its file is from now on, unless the user gave them another name. `before` is the file
/// it had, `file` what it was read from.
fn frames_named_after(
    project: &Arc<Project>,
    before: Option<&Path>,
    file: &ProjectFile,
    path: &Path,
) -> Arc<Project> {
    let stem = |path: &Path| path.file_stem().map(|stem| stem.to_string_lossy().into_owned());
    let own = &project.output.name;
    let Some((called, number)) = own.find('.').map(|dot| own.split_at(dot)) else { return project.clone() };
    let follows = match before {
        Some(before) => stem(before).is_some_and(|stem| stem == called),
        // A new document: what its example calls them.
        None => file.project().output.name == *own,
    };
    match stem(path).filter(|new| follows && new != called && !new.contains(['#', '%', '$', '\\'])) {
        Some(new) => {
            let mut project = (**project).clone();
            project.output.name = new + number;
            Arc::new(project)
        }
        None => project.clone(),
    }
}

/// The name of a file without its folder.
pub(super) fn name(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}
