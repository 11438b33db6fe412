//! A project and the file it came from, so that saving changes what the artist changed and nothing else.
//!
//! Unchanged, a project is written as the very bytes that were read. Changed, the text is merged of three: the file's, the
//! project's as it was read, and the project's as it is now ([`merge`]). What the program does not know stays with its
//! object, numbers stay as they were typed, values that nobody wrote and nobody changed are not added. The text depends on
//! the file and the project alone, so whoever undoes all changes gets the old bytes back, also after saving.
//!
//! The command line reads with [`Project::load`], which takes an unknown member for the typing error that it mostly is.

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

/// A project together with the text it was read from.
#[derive(Clone, Debug, PartialEq)]
pub struct ProjectFile {
    text: String,
    project: Project,
}

impl ProjectFile {
    /// Reads and checks a project file. Beside it come the places of what it holds and this program does not know: that is
    /// kept and not used.
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

    /// A project that was never saved.
    ///
    /// # Errors
    /// Refuses a project that would not load again.
    pub fn new(project: Project) -> Result<Self> {
        project.check()?;
        let text = plain(&project)?;
        Ok(Self { text, project })
    }

    /// The project as it was read.
    pub fn project(&self) -> &Project {
        &self.project
    }

    /// The text of a project that came from this file by changes.
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
        let text = Style::of(&self.text).lay_out(&merge::merge(&file, &was, &now));
        // What the file holds may come to mean something else beside the new values. Then the project is what counts.
        match load::parse_tolerantly(text.as_bytes(), Path::new("")) {
            Ok((again, _)) if again == *project => Ok(text),
            _ => plain(project),
        }
    }

    /// Saves a project that came from this file in one step: the old file at `path` stays whole until the new one is on the
    /// disk. Returns the text.
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

/// A project on its own, laid out like those that come with the program.
fn plain(project: &Project) -> Result<String> {
    let text = json(project)?;
    let node = Node::read(&text).map_err(unwritable)?;
    Ok(Style::of("{}\n").lay_out(&merge::fresh(&node)))
}

/// All values of a project. From text, not from values in memory: there an f32 would become an f64 of many digits.
fn json(project: &Project) -> Result<String> {
    serde_json::to_string(project).map_err(unwritable)
}

fn unwritable(error: serde_json::Error) -> Error {
    Error::value("project", format!("cannot be written as JSON: {error}"))
}
