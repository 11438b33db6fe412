//! The trust list: files that projects may read wherever they are, in the user's state folder. The command line reads it, too.

use std::path::{Path, PathBuf};

use lightloom_core::project::Admitted;
use lightloom_core::{Error, Result, files};
use serde::{Deserialize, Serialize};

use super::{Folders, disk};

/// Maximum size of the list.
const MOST_BYTES: u64 = 16 << 20;

#[derive(Debug, Default, Serialize, Deserialize)]
#[serde(default)]
struct TrustList {
    /// Absolute paths.
    files: Vec<PathBuf>,
}

/// The files that the user trusts; none where the list is not there, or cannot be read.
pub fn trusted(folders: Option<&Folders>) -> Admitted {
    Admitted::new(folders.and_then(|folders| read(folders).ok()).unwrap_or_default().files)
}

/// Adds files to the list.
///
/// # Errors
/// The list cannot be read or written; then it is unchanged.
pub(super) fn trust(folders: &Folders, files: &[PathBuf]) -> Result<()> {
    let mut list = read(folders)?;
    for file in files {
        let real = file.canonicalize().map_err(Error::io("find", file))?;
        // JSON cannot hold another path.
        if real.to_str().is_none() {
            return Err(Error::format(
                file,
                "",
                "has a name that is not UTF-8; rename it, or copy it beside the project",
            ));
        }
        if !list.files.contains(&real) {
            list.files.push(real);
        }
    }
    write(folders, &list)
}

/// Empties the list.
///
/// # Errors
/// The list cannot be written; then it is unchanged.
pub(super) fn forget(folders: &Folders) -> Result<()> {
    write(folders, &TrustList::default())
}

fn read(folders: &Folders) -> Result<TrustList> {
    let path = file_in(&folders.state);
    match files::read_regular_file(&path, MOST_BYTES) {
        Ok(bytes) => serde_json::from_slice(&bytes)
            .map_err(|e| Error::format(&path, "", format!("is no trust list: {e}; delete it"))),
        Err(Error::Io { source, .. }) if source.kind() == std::io::ErrorKind::NotFound => {
            Ok(TrustList::default())
        }
        Err(error) => Err(error),
    }
}

fn write(folders: &Folders, list: &TrustList) -> Result<()> {
    let text = serde_json::to_string_pretty(list)
        .map_err(|e| Error::value("trust list", format!("cannot be written as JSON: {e}")))?;
    disk::write(&file_in(&folders.state), (text + "\n").as_bytes())
}

fn file_in(state: &Path) -> PathBuf {
    state.join("trusted.json")
}
