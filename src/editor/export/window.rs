//! The export window: settings of a new export, and the status of all exports.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use egui::{Button, Context, RichText, TextEdit, Ui, vec2};
use lightloom_core::engine::Existing;
use lightloom_core::export::FilmFormat;
use lightloom_core::project::Project;

use super::form;
use super::job::ExportSettings;
use super::job_list::JobList;
use super::options::ExportOptions;
use super::queue::Exports;
use crate::editor::access::Access;
use crate::editor::context::EditorContext;
use crate::editor::dialogs::Picker;
use crate::editor::{templates, theme};

/// Width of the settings, points.
const LEFT: f32 = 350.0;

/// The export window.
pub struct ExportWindow {
    /// Whether it is open.
    pub open: bool,
    /// Which files outside of its folder the project may read.
    pub access: Access,
    /// The options as set by the user.
    options: Option<ExportOptions>,
    /// Those of an export that goes on, to be shown next.
    resumed: Option<ExportOptions>,
    /// The project's own options and file when last shown.
    own: Option<(ExportOptions, Option<PathBuf>)>,
    /// Time limit in minutes, and whether it is used.
    limit: (f64, bool),
    jobs: JobList,
}

impl Default for ExportWindow {
    fn default() -> Self {
        let (options, resumed, own, jobs) = (None, None, None, JobList::default());
        Self { open: false, access: Access::default(), options, resumed, own, limit: (10.0, false), jobs }
    }
}

impl ExportWindow {
    /// Sets the output folder.
    pub fn set_folder(&mut self, folder: PathBuf) {
        if let Some(options) = &mut self.options {
            options.folder = folder;
        }
    }

    /// Takes the options of an export that goes on.
    pub fn show_options_of(&mut self, export: &ExportSettings) {
        let ExportSettings { project, file, folder, film, limit, .. } = export;
        let ending = |film: &PathBuf| {
            FilmFormat::ALL.into_iter().find(|f| film.extension() == Some(f.extension().as_ref()))
        };
        let (film, folder) = (film.as_ref().and_then(ending), folder.clone());
        self.resumed = Some(ExportOptions { film, folder, ..ExportOptions::of(project, Some(file)) });
        self.limit = (limit.map_or(self.limit.0, |limit| limit.as_secs_f64() / 60.0), limit.is_some());
    }

    /// Shows the window if it is open.
    pub fn show(
        &mut self,
        ctx: &Context,
        editor: &mut EditorContext,
        exports: &mut Exports,
        picker: &mut Picker,
    ) {
        if !self.open {
            return;
        }
        let project = editor.document.project().clone();
        let file = editor.document.path().map(ToOwned::to_owned);
        self.follow(ExportOptions::of(&project, file.as_deref()), file);
        if let Some(options) = self.resumed.take() {
            self.options = Some(options);
        }
        let mut open = true;
        let middle = ctx.content_rect().center() - vec2(390.0, 260.0);
        let window = egui::Window::new("Export")
            .id(egui::Id::unique("Export"))
            .open(&mut open)
            .collapsible(false)
            .resizable(false);
        window.default_pos(middle).fixed_size([780.0, 520.0]).show(ctx, |ui| {
            ui.horizontal_top(|ui| {
                ui.vertical(|ui| {
                    ui.set_width(LEFT);
                    ui.set_min_height(500.0);
                    if let (Some(options), Some((own, _))) = (&mut self.options, &self.own) {
                        form::show(ui, editor, (options, own), &mut self.limit, picker);
                    }
                    self.begin(ui, editor, &project, exports);
                });
                ui.separator();
                ui.vertical(|ui| {
                    ui.set_min_width(380.0);
                    self.jobs.show(ui, editor.session.playhead, exports, editor.actions);
                });
            });
        });
        self.open = open;
    }

    /// Options not set by the user follow the project; another file resets all.
    fn follow(&mut self, own: ExportOptions, file: Option<PathBuf>) {
        match (&mut self.options, &self.own) {
            (Some(options), Some((before, of))) if *of == file => options.follow(before, &own),
            (options, _) => *options = Some(own.clone()),
        }
        self.own = Some((own, file));
    }

    /// The export button, and the equivalent command line.
    fn begin(&mut self, ui: &mut Ui, editor: &EditorContext, project: &Project, exports: &mut Exports) {
        let Some(options) = &self.options else { return };
        let applied = options.apply(project);
        let frames = applied.as_ref().ok().and_then(|project| project.frames().ok()).unwrap_or_default();
        ui.add_space(10.0);
        let text = match frames.len() {
            1 => "Export 1 frame".to_owned(),
            count => format!("Export {count} frames"),
        };
        let button = Button::new(RichText::new(text).strong()).fill(ui.visuals().selection.bg_fill);
        let begin = ui.add_enabled_ui(applied.is_ok(), |ui| ui.add_sized([LEFT - 8.0, 30.0], button)).inner;
        if let Err(error) = &applied {
            ui.colored_label(theme::words(ui.visuals(), theme::BAD), error.to_string());
        }
        if let Ok(project) = applied.as_ref()
            && begin.clicked()
        {
            let shown =
                if frames.contains(&editor.session.playhead) { Some(editor.session.playhead) } else { None };
            exports.add(ExportSettings {
                project: Arc::new(project.clone()),
                file: templates::file_of(editor.document),
                access: self.access.clone(),
                folder: options.folder.clone(),
                film: options.film_file(),
                limit: self.limit.1.then(|| Duration::from_secs_f64(60.0 * self.limit.0.clamp(0.1, 1e6))),
                shown: shown.or(frames.get(frames.len() / 2).copied()).unwrap_or_default(),
                existing: Existing::Refuse,
            });
        }
        ui.add_space(10.0);
        command_line(ui, editor, project, options);
    }
}

fn command_line(ui: &mut Ui, editor: &EditorContext, project: &Project, options: &ExportOptions) {
    ui.label("Equivalent command line");
    let Some(file) = editor.document.path() else {
        ui.weak("Save the project to see its command line.");
        return;
    };
    let line = options.command_line(project, file);
    let mut text = line.as_str();
    let field = TextEdit::multiline(&mut text).font(egui::TextStyle::Monospace).desired_rows(5);
    ui.add(field.desired_width(LEFT - 8.0)).accessible_name("Command line");
    ui.horizontal(|ui| {
        if ui.small_button("Copy").clicked() {
            ui.ctx().copy_text(line.clone());
        }
        if editor.document.is_unsaved() {
            ui.weak("It renders the file as last saved.");
        }
    });
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    #[test]
    fn an_export_that_goes_on_is_shown_with_the_options_that_it_has() {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("projects/letters_free.json");
        let project = Project::load(&file).expect("an example");
        let options = ExportOptions {
            frames: "1-20".into(),
            size: [320, 200],
            passes: 3,
            film: Some(FilmFormat::Apng),
            folder: "frames".into(),
            ..ExportOptions::of(&project, Some(&file))
        };
        let mut window = ExportWindow::default();
        window.show_options_of(&ExportSettings {
            project: Arc::new(options.apply(&project).expect("good options")),
            file,
            access: Access::default(),
            folder: options.folder.clone(),
            film: options.film_file(),
            limit: Some(Duration::from_secs(90)),
            shown: 1,
            existing: Existing::Refuse,
        });
        assert_eq!(window.resumed, Some(options));
        assert_eq!(window.limit, (1.5, true));
    }
}
