//! What the workers work on.

use std::path::PathBuf;
use std::sync::Arc;

use lightloom_core::engine::Sketcher;
use lightloom_core::project::{AssetFolder, Project};
use lightloom_core::{Error, Result};

/// A project, and where its files are.
#[derive(Clone, Debug)]
pub struct Subject {
    /// The project.
    pub project: Arc<Project>,
    /// The project file, or one that could stand there: its files are found from its folder.
    pub base: PathBuf,
    /// Whether it may read files from anywhere.
    pub external: bool,
}

impl Subject {
    /// Whether nothing differs; projects are compared by pointer.
    pub fn is(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.project, &other.project) && self.is_beside(other)
    }

    fn is_beside(&self, other: &Self) -> bool {
        self.base == other.base && self.external == other.external
    }
}

/// What a worker remembers from sketch to sketch of one document.
#[derive(Default)]
pub(super) struct Studio {
    last: Option<(Subject, Sketcher)>,
}

impl Studio {
    /// The sketcher of a subject's folder.
    ///
    /// # Errors
    /// The folder cannot be found.
    pub(super) fn sketcher(&mut self, subject: &Subject) -> Result<&mut Sketcher> {
        if self.last.as_ref().is_none_or(|(last, _)| !last.is_beside(subject)) {
            let sketcher = Sketcher::new(AssetFolder::new(&subject.base, subject.external)?);
            self.last = Some((subject.clone(), sketcher));
        }
        self.last.as_mut().map(|(_, sketcher)| sketcher).ok_or(Error::Cancelled)
    }
}
