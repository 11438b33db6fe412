//! The contact sheet of a sequence, made from the files of its frames: the same bytes whichever run wrote them, and when.

use std::path::{Path, PathBuf};

use rayon::prelude::*;

use super::kept_picture::kept_thumbnail;
use super::output_folder::CONTACT_SHEET;
use crate::Result;
use crate::export::{Overlay, OverlayLine, evenly_chosen, sheet};
use crate::project::Project;
use crate::render::{Image, PlaneView};

/// Pictures on the sheet.
pub(super) const PICTURES: usize = 12;
/// Its columns.
const COLUMNS: usize = 4;
/// Frames that are decoded at once.
const TOGETHER: usize = 4;

/// Small pictures in screen values with the numbers of their frames.
pub(super) type Thumbnails = Vec<(i32, Image)>;

/// The small pictures of a sheet of the `requested` frames in a folder, of those that have a file with a picture.
///
/// # Errors
/// A file that cannot be read.
pub(super) fn thumbnails(project: &Project, folder: &Path, requested: &[i32]) -> Result<Thumbnails> {
    let view = project.render.view.view();
    let thumbnail = |&frame: &i32| -> Result<Option<(i32, Image)>> {
        Ok(kept_thumbnail(&project.output, folder, frame, &view)?.map(|picture| (frame, picture)))
    };
    let mut thumbnails = Vec::new();
    for frames in evenly_chosen(requested, PICTURES).chunks(TOGETHER) {
        thumbnails
            .extend(frames.par_iter().map(thumbnail).collect::<Result<Vec<_>>>()?.into_iter().flatten());
    }
    Ok(thumbnails)
}

/// What the sheet of a sequence shows beside the frames.
pub(super) struct ContactSheet<'a> {
    /// The folder of the frames.
    pub(super) folder: &'a Path,
    /// The fingerprint of the frames.
    pub(super) fingerprint: &'a str,
    /// The drawn constraints.
    pub(super) drawn: &'a [OverlayLine],
    /// The plane on which they are drawn; none where there are none.
    pub(super) plane: Option<&'a PlaneView>,
}

impl ContactSheet<'_> {
    /// Writes it; returns its path.
    ///
    /// # Errors
    /// The system refuses.
    pub(super) fn write(&self, thumbnails: &Thumbnails) -> Result<PathBuf> {
        let path = self.folder.join(CONTACT_SHEET);
        let size = thumbnails.first().map_or([1, 1], |(_, p)| [p.width, p.height]);
        let pixel_from_plane = |point| self.plane.and_then(|plane| plane.pixel_from_plane(point, size));
        let overlay = Overlay { lines: self.drawn, pixel_from_plane: &pixel_from_plane };
        // It is as finished as it can be: any run of the same makes it anew.
        let texts = [("passes", "0"), ("passes_planned", "0"), ("fingerprint", self.fingerprint)]
            .map(|(name, text)| (name, text.to_owned()));
        sheet::write_contact_sheet(&path, thumbnails, COLUMNS, overlay, &texts)?;
        Ok(path)
    }
}
