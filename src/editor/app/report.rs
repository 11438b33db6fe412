//! The report that a user sends with a question.

use std::io::Write as _;
use std::path::Path;

use eframe::egui;
use lightloom_core::files;

use super::App;
use crate::editor::dialogs::{PickRequest, Purpose};
use crate::log;

impl App {
    /// Asks for a file for the report.
    pub(super) fn ask_where_to_report(&mut self, ctx: &egui::Context) {
        let request =
            PickRequest::new(Purpose::SaveReport).in_folder(self.own_folder()).named("lightloom_report.txt");
        self.picker.ask(request, ctx);
    }

    /// Writes the report.
    pub(super) fn save_report(&mut self, path: &Path) {
        let text = log::report(&self.report_sections());
        match files::write_atomic(path, |file| file.write_all(text.as_bytes())) {
            Ok(()) => self.editor.status = format!("The report is in '{}'", path.display()),
            Err(error) => self.show_message("The report was not saved".into(), error.to_string()),
        }
    }

    /// Puts what the status bar says into the log.
    pub(super) fn log_status(&mut self) {
        if self.logged != self.editor.status {
            self.logged.clone_from(&self.editor.status);
            if !self.logged.is_empty() {
                tracing::info!("{}", self.logged);
            }
        }
    }

    /// What the window knows: no content of files, and of their names those alone that messages tell.
    fn report_sections(&self) -> [(&'static str, String); 4] {
        let project = self.editor.document.project();
        let meshes = project.scene.as_ref().map_or(0, |scene| scene.meshes.len());
        let render = &project.render;
        let sizes = format!(
            "{} keys, {meshes} meshes, {} lines and walls, {} x {} pixels, {} photons, {} passes",
            project.keys.len(),
            project.constraints.len(),
            render.width,
            render.height,
            render.photons,
            render.passes
        );
        let preview = &self.editor.preview;
        let notes: String = preview.notes().iter().map(|note| format!("{note}\n")).collect();
        let problem =
            preview.problem().map_or_else(String::new, |problem| format!("not computed: {problem}\n"));
        [
            (
                "graphics",
                format!("{}\nphotons are drawn by the card: {}", self.graphics, self.draws_on_gpu()),
            ),
            ("preferences", self.preferences.without_files()),
            ("open project", sizes),
            (
                "notes on it",
                if notes.is_empty() && problem.is_empty() { "none".into() } else { problem + &notes },
            ),
        ]
    }
}
