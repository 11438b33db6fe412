//! The files of a run that are there already: what is kept, and what may be replaced.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use rayon::prelude::*;

use super::output_folder::CONTACT_SHEET;
use crate::export::{FrameFormat, FrameLayer, FramePattern, inspect};
use crate::project::{OutputSettings, Project};
use crate::{Error, Result};

/// What becomes of frames that are there and made from something else. Those that are whole, finished and made from the
/// same are kept in any case.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Existing {
    /// The run is refused before it begins.
    #[default]
    Refuse,
    /// They are replaced.
    Overwrite,
    /// They are kept.
    Skip,
}

/// How a file stands to a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    /// It is not there, or empty.
    Missing,
    /// It is whole, finished, and made from the same.
    Done,
    /// It is made from the same, but of fewer passes than planned.
    Unfinished,
    /// It is made from something else, or damaged.
    Other,
}

/// What a run finds in its folder.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Found {
    /// Files that are not written: they are there.
    pub(super) kept: BTreeSet<PathBuf>,
    /// Frames of which a file must be written, in the order of the project.
    pub(super) wanted: Vec<i32>,
    /// Files that are made from something else, or damaged.
    others: Vec<PathBuf>,
}

impl Found {
    /// Looks at the files of all frames of a project in a folder. `fingerprint` is that of the run.
    ///
    /// # Errors
    /// A project whose frames cannot be named.
    pub(super) fn in_folder(
        project: &Project,
        folder: &Path,
        fingerprint: &str,
        existing: Existing,
    ) -> Result<Self> {
        let mut found = Self::default();
        let frames = project.frames()?;
        let files = frames.iter().map(|&frame| files_of(&project.output, folder, frame));
        let files = files.collect::<Result<Vec<_>>>()?;
        // Each is read to its end.
        let states = files.into_par_iter().map(|files| {
            let with_state = |path: PathBuf| (state(&path, fingerprint), path);
            files.into_iter().map(with_state).collect::<Vec<_>>()
        });
        for (frame, files) in frames.into_iter().zip(states.collect::<Vec<_>>()) {
            let mut lacks = false;
            for (state, path) in files {
                if state == State::Other {
                    found.others.push(path.clone());
                }
                if state == State::Done || (state == State::Other && existing == Existing::Skip) {
                    found.kept.insert(path);
                } else {
                    lacks = true;
                }
            }
            if lacks {
                found.wanted.push(frame);
            }
        }
        let sheet = folder.join(CONTACT_SHEET);
        if state(&sheet, fingerprint) == State::Other {
            found.others.push(sheet.clone());
            if existing == Existing::Skip {
                found.kept.insert(sheet);
            }
        }
        Ok(found)
    }

    /// Refuses a run that would replace files of another.
    ///
    /// # Errors
    /// `Value` at `place`, such as "--out", where there are such files and `existing` is to refuse them.
    pub(super) fn require(&self, existing: Existing, place: &str) -> Result<()> {
        let (Existing::Refuse, Some(first)) = (existing, self.others.first()) else { return Ok(()) };
        let (folder, name) = (first.parent().unwrap_or(Path::new("")), first.file_name().unwrap_or_default());
        let (count, more) = (self.others.len(), self.others.len() - 1);
        let which = match more {
            0 => format!("'{}' there was", name.display()),
            _ => format!("'{}' and {more} more files there were", name.display()),
        };
        let it = if count == 1 { "it" } else { "them" };
        let what = format!(
            "{which} made from another project or other settings, and would be lost; name another folder than '{}', or give --overwrite to replace {it} or --skip to keep {it}",
            folder.display()
        );
        Err(Error::value(place, what))
    }
}

/// The files of one frame that show what the camera sees.
///
/// # Errors
/// A pattern without a number.
pub(super) fn pictures_of(output: &OutputSettings, folder: &Path, frame: i32) -> Result<Vec<PathBuf>> {
    let pattern = FramePattern::parse(&output.name, "output.name")?;
    let shown = |format: &&FrameFormat| **format != FrameFormat::Exr || output.shows_frames();
    Ok(output.formats.iter().filter(shown).map(|&format| pattern.path(folder, frame, format)).collect())
}

/// The files of one frame.
///
/// # Errors
/// A pattern without a number.
pub(super) fn files_of(output: &OutputSettings, folder: &Path, frame: i32) -> Result<Vec<PathBuf>> {
    let mut files = pictures_of(output, folder, frame)?;
    if output.shows_plane() {
        let pattern = FramePattern::parse(&output.name, "output.name")?;
        files.push(pattern.beside(FrameLayer::Plane.name()).path(folder, frame, FrameFormat::Exr));
    }
    Ok(files)
}

fn state(path: &Path, fingerprint: &str) -> State {
    match path.metadata() {
        Err(_) => return State::Missing,
        // A placeholder holds nothing that could be lost.
        Ok(file) if file.is_file() && file.len() == 0 => return State::Missing,
        Ok(_) => (),
    }
    match inspect(path) {
        Ok(file) if file.fingerprint() == Some(fingerprint) => {
            if file.is_finished() {
                State::Done
            } else {
                State::Unfinished
            }
        }
        _ => State::Other,
    }
}
