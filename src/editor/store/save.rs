//! Saving a project: its files come along, the previous version is kept, and another's work is not overwritten.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use lightloom_core::project::{Admitted, AssetFolder, Collect, Missing, Project, ProjectFile};
use lightloom_core::{Error, Progress, Result, files};

use super::{Fingerprint, Folders, backups, disk};

/// Maximum size of a project file; a larger file is not overwritten.
pub(super) const MOST_BYTES: u64 = 64 << 20;

/// A request to save a project.
#[derive(Clone, Debug)]
pub struct SaveRequest {
    /// Destination.
    pub path: PathBuf,
    /// The file it was read from.
    pub file: Arc<ProjectFile>,
    /// The current project.
    pub project: Arc<Project>,
    /// Where it comes from; none where its paths hold at `path` and its files stay where they are.
    pub origin: Option<Origin>,
    /// Expected fingerprint of the file at `path`; none overwrites whatever is there.
    pub seen: Option<Fingerprint>,
}

/// Where the paths of a project hold, and which files it may read.
#[derive(Clone, Debug)]
pub struct Origin {
    /// The project file, existing or not, that its paths are relative to.
    pub file: PathBuf,
    /// The files outside of its folder that it reads.
    pub admitted: Admitted,
    /// Those of them that stay where they are, since the user trusts them for good.
    pub trusted: Admitted,
}

/// A file that was written.
#[derive(Clone, Debug)]
pub struct Saved {
    /// Its new fingerprint.
    pub seen: Fingerprint,
    /// The project as it was written: with the paths of its files there.
    pub project: Arc<Project>,
    /// New paths of its files by old ones, as written.
    pub renamed: BTreeMap<String, String>,
    /// Files that were copied beside it.
    pub copied: usize,
    /// Why there is no backup of the previous version, if so.
    pub note: Option<String>,
}

/// Saves a project; none where the file does not have the expected fingerprint.
pub(super) fn save(folders: &Folders, request: &SaveRequest) -> Result<Option<Saved>> {
    // Through a link the file behind it is written; the link stays.
    let path = request.path.canonicalize().unwrap_or_else(|_| request.path.clone());
    let old = present(&path)?;
    if let (Some(old), Some(seen)) = (&old, request.seen)
        && Fingerprint::of(old) != seen
    {
        return Ok(None);
    }
    let write = |project: &Project| {
        let text = request.file.text_of(project)?;
        let old = old.as_ref().filter(|old| old.as_slice() != text.as_bytes());
        let kept = old.map(|old| backups::keep(folders, &path, old, MOST_BYTES));
        let text = request.file.save(&path, project)?;
        Ok((text, kept.and_then(Result::err).map(|error| format!("saved, but without backup: {error}"))))
    };
    let (project, renamed, copied, (text, note)) = match &request.origin {
        None => (request.project.clone(), BTreeMap::new(), 0, write(&request.project)?),
        Some(origin) => {
            let here = AssetFolder::new(&origin.file, false)?.admitting(origin.admitted.clone());
            let there = AssetFolder::new(&request.path, false)?.admitting(origin.trusted.clone());
            let stays = |real: &Path| there.allows(real);
            let (from, to, missing) = (&*origin.file, &*request.path, Missing::Keep);
            let collect = Collect { from, assets: &here, to, stays: &stays, missing };
            let (done, written) = collect.run(&request.project, &Progress::new(), write)?;
            (Arc::new(done.project), done.renamed, done.copied.len(), written)
        }
    };
    if let Some(folder) = path.parent() {
        disk::sweep(folder);
    }
    Ok(Some(Saved { seen: Fingerprint::of(text.as_bytes()), project, renamed, copied, note }))
}

/// The content of the file at `path`; none where there is none. Refuses a file that must not be overwritten.
fn present(path: &Path) -> Result<Option<Vec<u8>>> {
    match std::fs::metadata(path) {
        Ok(data) if data.permissions().readonly() => {
            Err(Error::format(path, "", "is write-protected; save under another name"))
        }
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(None),
        Ok(_) | Err(_) => files::read_regular_file(path, MOST_BYTES).map(Some),
    }
}
