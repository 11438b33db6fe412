//! Scenes of other programs: read on a thread of their own, then put into the open project in one step.

use std::path::Path;

use eframe::egui;
use lightloom_core::Error;
use lightloom_core::import::{self, Import};
use lightloom_core::project::relative;

use super::App;
use super::file_state::Details;
use super::files::name;
use super::task::Task;
use crate::editor::document::{Document, Edit};
use crate::editor::session::Panel;
use crate::editor::templates;

impl App {
    /// Replaces the document by an empty project, with its scene in the panel.
    pub(super) fn begin_empty(&mut self) {
        self.replace(Document::new(import::empty_project(), None));
        self.editor.session.panel = Panel::Scene;
    }

    /// Begins to read a scene for the open project; one that is still being read is given up.
    pub(super) fn import(&mut self, file: &Path) {
        let path = file.to_owned();
        match Task::start("Reading", file, move |progress| import::read(&path, progress)) {
            Ok(importing) => {
                self.editor.status.clear();
                self.importing = Some(importing);
            }
            Err(error) => self.editor.status = format!("no thread could be started to read it: {error}"),
        }
    }

    /// Takes over a scene that was read.
    pub(super) fn imported(&mut self, ctx: &egui::Context) {
        let Some(importing) = &self.importing else { return };
        let Some(result) = importing.result(ctx) else { return };
        let file = importing.file.clone();
        self.importing = None;
        match result {
            Ok(import) => self.put_in(&import, &file),
            Err(Error::Cancelled) => {
                self.editor.status = format!("'{}' was not imported: cancelled", name(&file));
            }
            Err(error) => {
                self.editor.status.clear();
                self.show_message(format!("'{}' cannot be imported", name(&file)), error.to_string());
            }
        }
    }

    fn put_in(&mut self, import: &Import, file: &Path) {
        let written = relative(file, &templates::file_of(&self.editor.document));
        let mut project = (**self.editor.document.project()).clone();
        import.add_to(&mut project, &written);
        self.editor.edit(Edit::Scene(project.scene.map(Box::new)));
        if project.render != self.editor.document.project().render {
            self.editor.edit(Edit::Render(project.render));
        }
        self.editor.document.settle();
        self.editor.session.panel = Panel::Scene;
        let summary = &import.summary;
        self.editor.status = summary.line();
        if !summary.notes.is_empty() {
            let count = match summary.notes.len() {
                1 => "1 note".to_owned(),
                more => format!("{more} notes"),
            };
            self.editor.status = format!("{count}: {}", self.editor.status);
            self.details = Some(Details {
                status: self.editor.status.clone(),
                title: format!("'{}' was imported", name(file)),
                text: format!("{}.\n\n{}", summary.line(), summary.notes.join("\n")),
            });
        }
    }
}
