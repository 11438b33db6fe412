//! The open project: what it is, where it is saved, and what it was before.

mod edit;
mod history;

use std::path::{Path, PathBuf};
use std::sync::Arc;

pub use edit::Edit;
pub use history::{History, STEPS};
use lightloom_core::Result;
use lightloom_core::project::Project;

/// The open project.
#[derive(Clone, Debug)]
pub struct Document {
    project: Arc<Project>,
    /// The project as it stands in its file.
    saved: Arc<Project>,
    path: Option<PathBuf>,
    history: History,
    /// Whether it holds work that no file has: a recovered one, say.
    unsaved: bool,
}

impl Document {
    /// A project that stands in the file `path`; without one it was never saved.
    pub fn new(project: Project, path: Option<PathBuf>) -> Self {
        let project = Arc::new(project);
        Self { saved: project.clone(), project, path, history: History::default(), unsaved: false }
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

    /// `project` stands in the file `path` now.
    pub fn mark_saved(&mut self, project: Arc<Project>, path: PathBuf) {
        self.saved = project;
        self.path = Some(path);
        self.unsaved = false;
    }

    /// It holds work that no file has.
    pub fn mark_unsaved(&mut self) {
        self.unsaved = true;
    }
}
