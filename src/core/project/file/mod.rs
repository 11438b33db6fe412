//! Layout-preserving saving of project files: only edited values change.
//!
//! An unchanged project is written as the bytes that were read. A changed one is a three-way merge ([`merge`]) of the file, the
//! project as it was read, and the project as it is now. Unknown members stay with their object, numbers stay as typed,
//! unchanged defaults are not added. The text depends on the file and the project alone, so undoing all changes gives the
//! old bytes back, also after saving.
//!
//! The command line reads with [`Project::load`], which refuses unknown members as typing errors.

mod align;
mod layout;
mod merge;
mod tree;
pub(super) mod unknown;

use std::io::Write as _;
use std::path::Path;

use super::{Project, load};
use crate::{Error, Result};
use layout::Style;
use tree::Node;

/// A project with the text it was read from.
#[derive(Clone, Debug, PartialEq)]
pub struct ProjectFile {
    text: String,
    project: Project,
}

impl ProjectFile {
    /// Reads and checks a project file. The notes name the unknown members, which are kept and not used.
    ///
    /// # Errors
    /// Unreadable, malformed or out of range: each names the file and the place in it.
    pub fn open(path: &Path) -> Result<(Self, Vec<String>)> {
        Self::parse(&crate::files::read_regular_file(path, load::MAX_BYTES)?, path)
    }

    /// The same from the file's bytes; `path` is only named in errors.
    ///
    /// # Errors
    /// As [`ProjectFile::open`].
    pub fn parse(bytes: &[u8], path: &Path) -> Result<(Self, Vec<String>)> {
        let (project, unknown) = load::parse_tolerantly(bytes, path)?;
        let text = String::from_utf8(bytes.to_vec())
            .map_err(|_| Error::format(path, "", "is not UTF-8 text; save it as UTF-8"))?;
        let note = |place| format!("{place} is unknown to this program; it is kept and not used");
        Ok((Self { text, project }, unknown.into_iter().map(note).collect()))
    }

    /// The file of a project that was never saved.
    ///
    /// # Errors
    /// As [`Project::check`].
    pub fn new(project: Project) -> Result<Self> {
        project.check()?;
        let text = plain(&project)?;
        Ok(Self { text, project })
    }

    /// The project as it was read.
    pub fn project(&self) -> &Project {
        &self.project
    }

    /// The text of an edited version of this file's project.
    ///
    /// # Errors
    /// Refuses a project that would not load again (a value that is not finite, say), by the value's path.
    pub fn text_of(&self, project: &Project) -> Result<String> {
        project.check()?;
        if *project == self.project {
            return Ok(self.text.clone());
        }
        let (was, now) = (json(&self.project)?, json(project)?);
        let read = |text| Node::read(text).map_err(unwritable);
        let (file, was, now) = (read(self.text.trim_start_matches('\u{feff}'))?, read(&was)?, read(&now)?);
        let text = Style::of(&self.text).format(&merge::merge(&file, &was, &now));
        // Unknown members may gain a meaning beside the new values. Then the project is written without them.
        match load::parse_tolerantly(text.as_bytes(), Path::new("")) {
            Ok((again, _)) if again == *project => Ok(text),
            _ => plain(project),
        }
    }

    /// Saves an edited version of this file's project atomically: the old file at `path` stays whole until the new one is on
    /// the disk. Returns the text.
    ///
    /// # Errors
    /// Names the file and the system's reason; the old file is left as it was.
    pub fn save(&self, path: &Path, project: &Project) -> Result<String> {
        let text = self.text_of(project)?;
        crate::files::write_atomic(path, |file| file.write_all(text.as_bytes()))?;
        crate::files::sync_folder_of(path)?;
        Ok(text)
    }
}

/// The text of a project without a file, formatted like the example projects.
fn plain(project: &Project) -> Result<String> {
    let text = json(project)?;
    let node = Node::read(&text).map_err(unwritable)?;
    Ok(Style::of("{}\n").format(&merge::fresh(&node)))
}

/// All values of a project as JSON text. `serde_json::Value` would turn an f32 into an f64 of many digits.
fn json(project: &Project) -> Result<String> {
    serde_json::to_string(project).map_err(unwritable)
}

fn unwritable(error: serde_json::Error) -> Error {
    Error::value("project", format!("cannot be written as JSON: {error}"))
}
