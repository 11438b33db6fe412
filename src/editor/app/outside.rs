//! Files for the project: picked or dropped ones, and those that lie outside of its folder. The user is asked once, in words,
//! whether they shall be copied beside the project or are trusted where they are.

use std::path::{Path, PathBuf};

use eframe::egui;
use lightloom_core::Error;
use lightloom_core::project::relative;

use super::App;
use super::file_state::{Elsewhere, PendingQuestion};
use super::files::name;
use super::task::Task;
use crate::editor::asset::AssetUse;
use crate::editor::dialogs::{Answer, PickRequest, Purpose, Question};
use crate::editor::store::{CollectRequest, StoreRequest, Watch, collect};
use crate::editor::templates;

/// Most files that a question lists.
const LISTED: usize = 6;

impl App {
    /// Asks for a file for the project.
    pub(super) fn pick_file(&mut self, ctx: &egui::Context, pick: AssetUse) {
        let folder = self.own_folder();
        self.picker.ask(PickRequest::new(Purpose::Asset(pick)).in_folder(folder), ctx);
    }

    /// Asks for a scene or a picture to import.
    pub(super) fn ask_what_to_import(&mut self, ctx: &egui::Context) {
        let folder = self.own_folder();
        self.picker.ask(PickRequest::new(Purpose::Import).in_folder(folder), ctx);
    }

    /// Looks where a file lies that was picked for this use.
    pub(super) fn locate(&mut self, pick: AssetUse, file: PathBuf) {
        self.files.located = Some((file.clone(), pick));
        let origin = self.origin();
        self.request(StoreRequest::Locate(file, origin));
    }

    /// The picked file comes into the project, at once or after a question.
    pub(super) fn located(&mut self, file: &Path, outside: bool) {
        let Some((path, pick)) = self.files.located.take().filter(|(path, _)| path == file) else { return };
        // An unsaved project has no folder yet: saving it brings its files together.
        let decided = self.files.outside.or(self.editor.document.path().is_none().then_some(Elsewhere::Copy));
        match (outside, decided) {
            (false, _) => self.insert(&pick, &path),
            (true, Some(Elsewhere::Copy)) => self.decide_pick(&pick, &path, Answer::Yes),
            (true, Some(Elsewhere::Trust)) => self.decide_pick(&pick, &path, Answer::No),
            (true, None) => {
                let title = format!("'{}' is not in the project's folder", name(&path));
                let question = Question::Outside { title, files: String::new(), no: "Cancel" };
                self.files.ask(question, PendingQuestion::Pick(path, pick));
            }
        }
    }

    /// What was picked is used, as the user decided.
    pub(super) fn decide_pick(&mut self, pick: &AssetUse, path: &Path, answer: Answer) {
        if answer == Answer::Cancel {
            return;
        }
        self.admit(vec![path.to_owned()], answer);
        self.insert(pick, path);
        self.editor.status = match answer {
            Answer::Yes => format!("'{}' is copied beside the project when it is saved", name(path)),
            _ => format!("'{}' is trusted where it is", name(path)),
        };
    }

    /// Lets the project read these files.
    fn admit(&mut self, files: Vec<PathBuf>, answer: Answer) {
        files.iter().for_each(|file| self.files.admitted.add(file));
        if answer == Answer::Yes {
            self.files.outside = Some(Elsewhere::Copy);
            return;
        }
        self.files.outside = Some(Elsewhere::Trust);
        files.iter().for_each(|file| self.files.trusted.add(file));
        self.request(StoreRequest::Trust(files));
    }

    /// Puts a file into the project.
    fn insert(&mut self, pick: &AssetUse, file: &Path) {
        if *pick == AssetUse::Mesh {
            return self.import(file);
        }
        if let AssetUse::Picture(at) = pick {
            return self.put_picture(at, file);
        }
        self.put(pick, relative(file, &templates::file_of(&self.editor.document)));
    }

    /// Makes use of a file, a path relative to the project.
    pub(super) fn put(&mut self, pick: &AssetUse, written: String) {
        if let Some(edit) = pick.edit(self.editor.document.project(), written) {
            self.editor.edit(edit);
            self.editor.document.settle();
        }
    }

    /// Looks for files of the open project that lie outside of its folder.
    pub(super) fn find_outside(&mut self) {
        let origin = self.origin();
        let project = self.editor.document.project().clone();
        self.files.request(StoreRequest::FindOutside(project, origin));
    }

    /// Asks what to do with files of the open project that lie outside of its folder.
    pub(super) fn ask_outside(&mut self, files: Vec<PathBuf>) {
        let title = match files.len() {
            0 => return,
            1 => format!("'{}' reads a file outside of its folder", self.editor.document.title()),
            count => format!("'{}' reads {count} files outside of its folder", self.editor.document.title()),
        };
        let mut list: String =
            files.iter().take(LISTED).map(|file| format!("{}\n", file.display())).collect();
        if files.len() > LISTED {
            list += &format!("and {} more\n", files.len() - LISTED);
        }
        let question = Question::Outside { title, files: list + "\n", no: "Do not read" };
        self.files.ask(question, PendingQuestion::Outside(files));
    }

    /// What the opened project reads from elsewhere, as the user decided.
    pub(super) fn decide_outside(&mut self, files: Vec<PathBuf>, answer: Answer) {
        if answer == Answer::Cancel {
            return;
        }
        self.admit(files, answer);
        if answer == Answer::Yes {
            // Saving is what copies them.
            self.editor.document.mark_unsaved();
        }
    }

    /// Reads all files of the project again, with those that they name.
    pub(super) fn reload_assets(&mut self) {
        self.engine.forget();
        self.files.edition += 1;
        self.editor.status = "The files of the project are read again".into();
    }

    /// Reads the files of the project again that changed.
    pub(super) fn notice_changes(&mut self) {
        if self.files.watch.as_ref().is_some_and(Watch::has_changed) {
            tracing::info!("files of the project changed");
            self.files.edition += 1;
        }
    }

    /// Asks for a folder to collect the project into.
    pub(super) fn ask_where_to_collect(&mut self, ctx: &egui::Context) {
        let folder = self.own_folder();
        self.picker.ask(PickRequest::new(Purpose::CollectFolder).in_folder(folder), ctx);
    }

    /// Copies the project as it is now, with all its files, into a folder; a copy that is still being made is given up.
    pub(super) fn collect(&mut self, folder: PathBuf) {
        let mut origin = self.origin();
        if self.editor.document.path().is_none() {
            origin.file.set_file_name(self.file_name());
        }
        let file = match self.editor.document.file() {
            Ok(file) => file,
            Err(error) => {
                return self.show_message("The project cannot be collected".into(), error.to_string());
            }
        };
        let project = self.editor.document.project().clone();
        let path = folder.clone();
        let request = CollectRequest { folder, file, project, origin };
        match Task::start("Collecting into", &path, move |progress| collect(&request, progress)) {
            Ok(task) => {
                self.editor.status.clear();
                self.collecting = Some(task);
            }
            Err(error) => self.editor.status = format!("no thread could be started to copy it: {error}"),
        }
    }

    /// Tells that the project was collected, or not.
    pub(super) fn collected(&mut self, ctx: &egui::Context) {
        let Some(result) = self.collecting.as_ref().and_then(|task| task.result(ctx)) else { return };
        self.collecting = None;
        match result {
            Ok((path, collection)) => {
                let count = collection.copied.len();
                let megabytes = collection.bytes as f64 / 1e6;
                self.editor.status =
                    format!("Collected as '{}': {count} files, {megabytes:.1} MB", path.display());
                if !collection.notes.is_empty() {
                    self.show_message("The project was collected, but".into(), collection.notes.join("\n"));
                }
            }
            Err(Error::Cancelled) => {
                self.editor.status = "Collecting was cancelled; what was copied is removed".into();
            }
            Err(error) => self.show_message("The project was not collected".into(), error.to_string()),
        }
    }
}
