//! The subject of the workers: a project and the place of its files.

use std::path::PathBuf;
use std::sync::Arc;

use lightloom_core::Result;
use lightloom_core::engine::Engine;
use lightloom_core::project::Project;

use crate::editor::access::Access;
use crate::editor::engine::SharedEngine;

/// A project, and the place of its files.
#[derive(Clone, Debug)]
pub struct Subject {
    /// The project.
    pub project: Arc<Project>,
    /// The project file, or one that could stand there: files are found from its folder.
    pub base: PathBuf,
    /// Which files outside of that folder may be read.
    pub access: Access,
}

impl Subject {
    /// Whether nothing differs; projects are compared by pointer.
    pub fn is(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.project, &other.project) && self.base == other.base && self.access == other.access
    }

    /// The engine that works on the subject.
    ///
    /// # Errors
    /// The folder cannot be found.
    pub(super) fn engine(&self, shared: &SharedEngine) -> Result<Engine> {
        shared.of(&self.base, &self.access)
    }
}
