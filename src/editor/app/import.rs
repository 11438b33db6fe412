//! Scenes of other programs: read on a thread of their own, then put into the open project in one step.

use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::time::Duration;

use eframe::egui;
use lightloom_core::import::{self, Import};
use lightloom_core::{Progress, Result};

use super::App;
use crate::editor::document::{Document, Edit};
use crate::editor::relative_path;
use crate::editor::session::Panel;
use crate::editor::templates;

/// How often the window looks whether the file is read.
const LOOK: Duration = Duration::from_millis(30);

/// A file that is being read for the open document.
pub(super) struct Importing {
    file: PathBuf,
    result: Receiver<Result<Import>>,
    progress: Progress,
}

impl Drop for Importing {
    fn drop(&mut self) {
        self.progress.cancel();
    }
}

impl App {
    /// Replaces the document by an empty project, with its scene in the panel.
    pub(super) fn begin_empty(&mut self) {
        self.replace(Document::new(import::empty_project(), None));
        self.editor.session.panel = Panel::Scene;
    }

    /// Begins to read a scene for the open project; one that is still being read is given up.
    pub(super) fn import(&mut self, file: &Path) {
        let (sender, result) = channel();
        let progress = Progress::new();
        let (path, reading) = (file.to_owned(), progress.clone());
        // The window may have given it up.
        let read = move || drop(sender.send(import::read(&path, &reading)));
        match std::thread::Builder::new().name("import".into()).spawn(read) {
            Ok(_) => {
                self.editor.status = format!("Reading '{}'", super::files::name(file));
                self.importing = Some(Importing { file: file.to_owned(), result, progress });
            }
            Err(error) => self.editor.status = format!("no thread could be started to read it: {error}"),
        }
    }

    /// Takes over a scene that was read.
    pub(super) fn imported(&mut self, ctx: &egui::Context) {
        let Some(importing) = &self.importing else { return };
        let result = match importing.result.try_recv() {
            Ok(result) => result,
            Err(TryRecvError::Empty) => return ctx.request_repaint_after(LOOK),
            // The thread ended without an answer: it panicked.
            Err(TryRecvError::Disconnected) => Err(lightloom_core::Error::format(
                &importing.file,
                "",
                "could not be read: a fault of the program",
            )),
        };
        let file = importing.file.clone();
        self.importing = None;
        match result {
            Ok(import) => self.put_in(&import, &file),
            Err(error) => {
                self.editor.status.clear();
                self.show_message(
                    format!("'{}' cannot be imported", super::files::name(&file)),
                    error.to_string(),
                );
            }
        }
    }

    fn put_in(&mut self, import: &Import, file: &Path) {
        let written = relative_path::relative(file, &templates::file_of(&self.editor.document));
        let mut project = (**self.editor.document.project()).clone();
        import.add_to(&mut project, &written);
        self.external = true;
        self.editor.edit(Edit::Scene(project.scene.map(Box::new)));
        if project.render != self.editor.document.project().render {
            self.editor.edit(Edit::Render(project.render));
        }
        self.editor.document.settle();
        self.editor.session.panel = Panel::Scene;
        let summary = &import.summary;
        self.editor.status = summary.line();
        if !summary.notes.is_empty() {
            let text = format!("{}.\n\n{}", summary.line(), summary.notes.join("\n"));
            self.show_message(format!("'{}' was imported", super::files::name(file)), text);
        }
    }
}
