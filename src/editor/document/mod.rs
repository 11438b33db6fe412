//! The open document: a project, its file, and its history.

mod edit;
mod history;

use std::path::{Path, PathBuf};
use std::sync::Arc;

pub use edit::Edit;
pub use history::{History, STEPS};
use lightloom_core::Result;
use lightloom_core::project::{Project, ProjectFile};

use super::store::Fingerprint;

/// A project with its file and its history.
#[derive(Clone, Debug)]
pub struct Document {
    project: Arc<Project>,
    /// The project as last saved.
    saved: Arc<Project>,
    path: Option<PathBuf>,
    /// The text that the project was read from; none for one that was never a file.
    file: Option<Arc<ProjectFile>>,
    /// Fingerprint of the file at `path` when it was last read or written.
    seen: Option<Fingerprint>,
    history: History,
    /// Whether it is unsaved regardless of edits, such as a recovered document.
    unsaved: bool,
    /// Why it must not be saved to its file, if so.
    read_only: Option<String>,
}

impl Document {
    /// A document of a project saved at `path`, or never saved.
    pub fn new(project: Project, path: Option<PathBuf>) -> Self {
        let project = Arc::new(project);
        let (file, seen, history) = (None, None, History::default());
        Self { saved: project.clone(), project, path, file, seen, history, unsaved: false, read_only: None }
    }

    /// A document read from a file saved at `at`; without `at`, a new one based on that text.
    pub fn opened(file: Arc<ProjectFile>, at: Option<(PathBuf, Fingerprint)>) -> Self {
        let (path, seen) = at.unzip();
        Self { file: Some(file.clone()), seen, ..Self::new(file.project().clone(), path) }
    }

    /// The project file that text is written through: it keeps fields that this program does not know.
    ///
    /// # Errors
    /// The project would not load again.
    pub fn file(&mut self) -> Result<Arc<ProjectFile>> {
        if let Some(file) = &self.file {
            return Ok(file.clone());
        }
        let file = Arc::new(ProjectFile::new((*self.project).clone())?);
        self.file = Some(file.clone());
        Ok(file)
    }

    /// Fingerprint of its file when that was last read or written.
    pub fn seen(&self) -> Option<Fingerprint> {
        self.seen
    }

    /// The current project.
    pub fn project(&self) -> &Arc<Project> {
        &self.project
    }

    /// Its file; none where it was never saved.
    pub fn path(&self) -> Option<&Path> {
        self.path.as_deref()
    }

    /// Its title: the name of the file, or of the project.
    pub fn title(&self) -> String {
        let file = self.path.as_ref().and_then(|path| path.file_name());
        file.map_or_else(
            || if self.project.name.is_empty() { "Untitled".into() } else { self.project.name.clone() },
            |name| name.to_string_lossy().into_owned(),
        )
    }

    /// Whether there are unsaved changes.
    pub fn is_unsaved(&self) -> bool {
        self.unsaved || (!Arc::ptr_eq(&self.project, &self.saved) && self.project != self.saved)
    }

    /// Undo and redo.
    pub fn history(&self) -> &History {
        &self.history
    }

    /// Edits the project; all edits until [`Self::settle`] are one undo step.
    ///
    /// # Errors
    /// An invalid value; the project is unchanged.
    pub fn edit(&mut self, edit: Edit) -> Result<()> {
        let name = edit.name();
        let after = edit.apply(&self.project)?;
        if after != *self.project {
            self.history.push(&self.project, name);
            self.project = Arc::new(after);
        }
        Ok(())
    }

    /// Ends the gesture: the next edit is a new undo step.
    pub fn settle(&mut self) {
        self.history.settle(&self.project);
    }

    /// Cancels the gesture and restores the project.
    pub fn abort(&mut self) {
        self.project = self.history.abort().unwrap_or_else(|| self.project.clone());
    }

    /// Undoes the last step.
    pub fn undo(&mut self) {
        self.project = self.history.undo(&self.project).unwrap_or_else(|| self.project.clone());
    }

    /// Redoes the last undone step.
    pub fn redo(&mut self) {
        self.project = self.history.redo(&self.project).unwrap_or_else(|| self.project.clone());
    }

    /// Records that `project` was saved at `path` with the fingerprint `seen`.
    pub fn mark_saved(&mut self, project: Arc<Project>, path: PathBuf, seen: Fingerprint) {
        self.saved = project;
        (self.path, self.seen) = (Some(path), Some(seen));
        self.unsaved = false;
        self.read_only = None;
    }

    /// Why it must not be saved to its file, if so: it is saved under another name.
    pub fn read_only(&self) -> Option<&str> {
        self.read_only.as_deref()
    }

    /// Keeps it from being saved to its file, for this reason.
    pub fn protect(&mut self, why: String) {
        self.read_only = Some(why);
    }

    /// Keeps the open version beside a file that another program changed: it has the fingerprint `seen` now.
    pub fn keep_over(&mut self, seen: Fingerprint) {
        self.seen = Some(seen);
        self.unsaved = true;
    }

    /// Rewrites the file paths for another folder with `there`, in the project and its history.
    pub fn relocate(&mut self, there: impl Fn(&Project) -> Project) {
        self.project = Arc::new(there(&self.project));
        self.history.change_all(|project| Arc::new(there(project)));
    }

    /// Marks the document as unsaved.
    pub fn mark_unsaved(&mut self) {
        self.unsaved = true;
    }
}
