//! Files for the project: picked or dropped ones, and those that lie outside of its folder. The user is asked once, in words,
//! whether they shall be copied beside the project or are trusted where they are.

use std::path::{Path, PathBuf};

use eframe::egui;
use lightloom_core::Result;
use lightloom_core::project::{Collection, relative};
use lightloom_core::scene::mesh;

use super::App;
use super::file_state::{Elsewhere, Leave, PendingQuestion};
use super::files::name;
use crate::editor::asset::{AssetUse, TargetSlot};
use crate::editor::dialogs::{Answer, PickRequest, Purpose, Question};
use crate::editor::store::{CollectRequest, StoreRequest};
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
        let written = relative(file, &templates::file_of(&self.editor.document));
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

    /// Asks for a folder to collect the project into.
    pub(super) fn ask_where_to_collect(&mut self, ctx: &egui::Context) {
        let folder = self.own_folder();
        self.picker.ask(PickRequest::new(Purpose::CollectFolder).in_folder(folder), ctx);
    }

    /// Copies the project as it is now, with all its files, into a folder.
    pub(super) fn collect(&mut self, folder: PathBuf) {
        let mut origin = self.origin();
        if self.editor.document.path().is_none() {
            origin.file.set_file_name(self.file_name());
        }
        match self.editor.document.file() {
            Ok(file) => {
                let project = self.editor.document.project().clone();
                self.request(StoreRequest::Collect(CollectRequest { folder, file, project, origin }));
            }
            Err(error) => self.show_message("The project cannot be collected".into(), error.to_string()),
        }
    }

    /// The project was collected, or not.
    pub(super) fn collected(&mut self, result: Result<Box<(PathBuf, Collection)>>) {
        match result {
            Ok(collected) => {
                let (path, collection) = *collected;
                let count = collection.copied.len();
                let megabytes = collection.bytes as f64 / 1e6;
                self.editor.status =
                    format!("Collected as '{}': {count} files, {megabytes:.1} MB", path.display());
                if !collection.notes.is_empty() {
                    self.show_message("The project was collected, but".into(), collection.notes.join("\n"));
                }
            }
            Err(error) => self.show_message("The project was not collected".into(), error.to_string()),
        }
    }

    /// A file that was dropped on the window: a project is opened, a folder of frames is played, a mesh comes into the scene,
    /// a picture or points become what the key frame after the playhead shows.
    pub(super) fn dropped(&mut self, ctx: &egui::Context, file: PathBuf) {
        let ending = file.extension().map(|ending| ending.to_string_lossy().to_lowercase());
        let ends = |pick: &AssetUse| ending.as_deref().is_some_and(|ending| pick.files().1.contains(&ending));
        let keys = &self.editor.document.project().keys;
        let after = keys.iter().position(|key| key.frame >= self.editor.session.playhead);
        let at = TargetSlot { key: after.unwrap_or(keys.len().saturating_sub(1)), caustic: None };
        if file.is_dir() {
            return self.windows.player.play(ctx, &file);
        }
        if matches!(ending.as_deref(), Some("json" | "lightloom")) {
            return self.leave(ctx, Leave::Open(file));
        }
        match [AssetUse::Mesh, AssetUse::Picture(at.clone()), AssetUse::Points(at)]
            .iter()
            .find(|pick| ends(pick))
        {
            Some(pick) => self.locate(pick.clone(), file),
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
}
