//! Autosave: every change goes to the journal, the preferences to their file.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use eframe::egui;

use super::App;
use crate::editor::preferences;
use crate::editor::store::{Note, StoreRequest};
use crate::editor::templates;

impl App {
    /// Sends changes since the last frame to the file threads. Copies pointers only.
    pub(super) fn autosave(&mut self, ctx: &egui::Context) {
        self.note_project();
        self.watch();
        let last_sent = &mut self.files.last_sent;
        if last_sent.preferences.as_ref() != Some(&self.preferences) {
            let first = last_sent.preferences.replace(self.preferences.clone()).is_none();
            preferences::apply(ctx, &self.preferences);
            if self.engine.limit_previews(self.preferences.preview_megabytes) {
                self.editor.begin_preview();
            }
            self.recents.ask(self.preferences.recent.clone());
            if !first && self.keeps_preferences {
                self.files.request(StoreRequest::Remember(Box::new(self.preferences.clone())));
            }
        }
        let title = format!(
            "{}{}{} – Lightloom",
            if self.editor.document.is_unsaved() { "● " } else { "" },
            self.editor.document.title(),
            if self.editor.document.read_only().is_some() { " (read-only)" } else { "" }
        );
        if self.files.title != title {
            ctx.send_viewport_cmd(egui::ViewportCommand::Title(title.clone()));
            self.files.title = title;
        }
    }

    /// Has the files of the project watched, and those that its meshes name.
    fn watch(&mut self) {
        let (project, light) = (self.editor.document.project(), self.editor.preview.preview());
        let base = templates::file_of(&self.editor.document);
        let folder = base.parent().map(Path::to_owned).unwrap_or_default();
        let mut files: Vec<PathBuf> = project.files().into_iter().map(|file| folder.join(file)).collect();
        let named =
            light.map_or(&[][..], |light| light.mesh_files()).iter().filter(|file| !files.contains(file));
        files.extend(named.cloned().collect::<Vec<_>>());
        if let Some(watch) = self.files.watch.as_ref().filter(|_| files != self.files.last_sent.watched) {
            watch.look_at(files.clone());
            self.files.last_sent.watched = files;
        }
    }

    fn note_project(&mut self) {
        let project = self.editor.document.project().clone();
        if self.files.last_sent.project.as_ref().is_some_and(|last_sent| Arc::ptr_eq(last_sent, &project)) {
            return;
        }
        let first = self.files.last_sent.project.replace(project.clone()).is_none();
        let Ok(file) = self.editor.document.file() else { return };
        let Some(journal) = &self.files.journal else { return };
        if !self.editor.document.is_unsaved() {
            if !first {
                journal.clean();
            }
            return;
        }
        journal.note(Note {
            path: self.editor.document.path().map(ToOwned::to_owned),
            title: self.editor.document.title(),
            file,
            project,
            seen: self.editor.document.seen(),
            base: templates::file_of(&self.editor.document),
            admitted: self.files.admitted.files(),
        });
    }
}
