//! The open project: what it is, where it is saved, and what it was before.

mod edit;
mod history;

use std::path::{Path, PathBuf};
use std::sync::Arc;

pub use edit::Edit;
pub use history::{History, STEPS};
use lightloom_core::Result;
use lightloom_core::project::{Project, ProjectFile};

use super::store::Fingerprint;

/// The open project.
#[derive(Clone, Debug)]
pub struct Document {
    project: Arc<Project>,
    /// The project as it stands in its file.
    saved: Arc<Project>,
    path: Option<PathBuf>,
    /// The text that the project came from; none for one that never was a file.
    file: Option<Arc<ProjectFile>>,
    /// The content of the file at `path` when it was last read or written.
    seen: Option<Fingerprint>,
    history: History,
    /// Whether it holds work that no file has: a recovered one, say.
    unsaved: bool,
}

impl Document {
    /// A project that stands in the file `path`; without one it was never saved.
    pub fn new(project: Project, path: Option<PathBuf>) -> Self {
        let project = Arc::new(project);
        let (file, seen, history) = (None, None, History::default());
        Self { saved: project.clone(), project, path, file, seen, history, unsaved: false }
    }

    /// A project that was read from a file. It stands at `at`; without a place it is a new one that began with that text.
    pub fn opened(file: Arc<ProjectFile>, at: Option<(PathBuf, Fingerprint)>) -> Self {
        let (path, seen) = at.unzip();
        Self { file: Some(file.clone()), seen, ..Self::new(file.project().clone(), path) }
    }

    /// What the project's text is made from: it keeps what this program does not know.
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

    /// The content of its file when that was last read or written.
    pub fn seen(&self) -> Option<Fingerprint> {
        self.seen
    }

    /// The project as it is now.
    pub fn project(&self) -> &Arc<Project> {
        &self.project
    }

    /// The file it stands in; none where it was never saved.
    pub fn path(&self) -> Option<&Path> {
        self.path.as_deref()
    }

    /// What the window calls it: the file's name, or the project's.
    pub fn title(&self) -> String {
        let file = self.path.as_ref().and_then(|path| path.file_name());
        file.map_or_else(
            || if self.project.name.is_empty() { "Untitled".into() } else { self.project.name.clone() },
            |name| name.to_string_lossy().into_owned(),
        )
    }

    /// Whether there is something to save.
    pub fn is_unsaved(&self) -> bool {
        self.unsaved || (!Arc::ptr_eq(&self.project, &self.saved) && self.project != self.saved)
    }

    /// Undo and redo.
    pub fn history(&self) -> &History {
        &self.history
    }

    /// Changes the project; one step until [`Self::settle`].
    ///
    /// # Errors
    /// A value that cannot be used; the project stays as it was.
    pub fn edit(&mut self, edit: Edit) -> Result<()> {
        let name = edit.name();
        let after = edit.apply(&self.project)?;
        if after != *self.project {
            self.history.push(&self.project, name);
            self.project = Arc::new(after);
        }
        Ok(())
    }

    /// The gesture is over: what comes next is a step of its own.
    pub fn settle(&mut self) {
        self.history.settle(&self.project);
    }

    /// The gesture is broken off: the project is as before it.
    pub fn abort(&mut self) {
        self.project = self.history.abort().unwrap_or_else(|| self.project.clone());
    }

    /// Takes the last step back.
    pub fn undo(&mut self) {
        self.project = self.history.undo(&self.project).unwrap_or_else(|| self.project.clone());
    }

    /// Does again what was taken back.
    pub fn redo(&mut self) {
        self.project = self.history.redo(&self.project).unwrap_or_else(|| self.project.clone());
    }

    /// `project` stands in the file `path` now, whose content is `seen`.
    pub fn mark_saved(&mut self, project: Arc<Project>, path: PathBuf, seen: Fingerprint) {
        self.saved = project;
        (self.path, self.seen) = (Some(path), Some(seen));
        self.unsaved = false;
    }

    /// The document moves to another folder: `there` names the same files from it, now and in what can be undone.
    pub fn relocate(&mut self, there: impl Fn(&Project) -> Project) {
        self.project = Arc::new(there(&self.project));
        self.history.change_all(|project| Arc::new(there(project)));
    }

    /// It holds work that no file has.
    pub fn mark_unsaved(&mut self) {
        self.unsaved = true;
    }
}
