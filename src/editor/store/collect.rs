//! The open project copied with all its files.

use std::path::PathBuf;
use std::sync::Arc;

use lightloom_core::project::{AssetFolder, Collection, Project, ProjectFile, collect_into};
use lightloom_core::{Progress, Result};

use super::Origin;

/// A project to be copied with all its files into a folder.
#[derive(Clone, Debug)]
pub struct CollectRequest {
    /// The folder.
    pub folder: PathBuf,
    /// The file it was read from.
    pub file: Arc<ProjectFile>,
    /// The current project.
    pub project: Arc<Project>,
    /// Where its paths hold; its file name is that of the collected project.
    pub origin: Origin,
}

/// Copies the project; returns the project file there. Nothing is left in the folder of a copy that fails or is cancelled.
///
/// # Errors
/// As [`collect_into`].
pub fn collect(request: &CollectRequest, progress: &Progress) -> Result<(PathBuf, Collection)> {
    let Origin { file, admitted, .. } = &request.origin;
    let assets = AssetFolder::new(file, false)?.admitting(admitted.clone());
    collect_into(&request.folder, (&request.file, &request.project), (file, &assets), progress)
}
