//! The sequences of frames that lie in a folder.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::contact_sheet::{ContactSheet, PICTURES};
use super::kept_picture::thumbnail_of;
use crate::export::{FrameFormat, evenly_chosen, inspect};
use crate::render::RenderSettings;
use crate::{Error, Result};

/// The files of the sequences in a folder by name with `#` in place of the number, such as `shot.#.exr`, then by number.
pub(super) fn sequences(folder: &Path) -> Result<BTreeMap<String, BTreeMap<i32, PathBuf>>> {
    let mut found: BTreeMap<String, BTreeMap<i32, PathBuf>> = BTreeMap::new();
    for entry in std::fs::read_dir(folder).map_err(Error::io("read", folder))? {
        let path = entry.map_err(Error::io("read", folder))?.path();
        let Some(name) = path.file_name().and_then(|name| name.to_str()) else { continue };
        if let Some((sequence, number)) = split(name) {
            found.entry(sequence).or_default().insert(number, path);
        }
    }
    Ok(found)
}

/// The name of a sequence and the number of a frame, from the name of its file: `name.0001.exr`.
fn split(name: &str) -> Option<(String, i32)> {
    let (stem, ending) = name.rsplit_once('.')?;
    FrameFormat::ALL.iter().find(|format| format.extension() == ending)?;
    let (before, number) = stem.rsplit_once('.')?;
    let digits = number.strip_prefix('-').unwrap_or(number);
    let number = number.parse().ok().filter(|_| !digits.is_empty())?;
    Some((format!("{before}.#.{ending}"), number))
}

/// Writes the contact sheet of the frames that lie in a folder, as a render of all of them does; returns its path.
///
/// # Errors
/// There are no frames; one cannot be read; the system refuses.
pub fn write_sheet(folder: &Path) -> Result<PathBuf> {
    let sequences = sequences(folder)?;
    let pictures = sequences.iter().find(|(name, frames)| {
        // EXR files come first: their light is what a sheet is made from.
        let first = frames.values().next();
        first.is_some_and(|path| thumbnail_of(path, &view_of(path)).is_ok_and(|picture| picture.is_some()))
            && !name.contains("_plane.")
    });
    let Some((_, frames)) = pictures else {
        let what = format!("there is no frame with a picture in '{}'", folder.display());
        return Err(Error::value("DIR", what));
    };
    let numbers: Vec<i32> = frames.keys().copied().collect();
    let mut thumbnails = Vec::new();
    for frame in evenly_chosen(&numbers, PICTURES) {
        let path = &frames[&frame];
        thumbnails.extend(thumbnail_of(path, &view_of(path))?.map(|picture| (frame, picture)));
    }
    let first = frames.values().next().and_then(|path| inspect(path).ok());
    let fingerprint = first.as_ref().and_then(|file| file.fingerprint()).unwrap_or_default();
    ContactSheet { folder, fingerprint, drawn: &[], plane: None }.write(&thumbnails)
}

/// The view transform that a frame was made for, by the settings in it.
fn view_of(path: &Path) -> crate::render::view::View {
    let settings = inspect(path).ok().and_then(|file| {
        let text = file.texts.get("render")?;
        serde_json::from_str::<RenderSettings>(text).ok()
    });
    settings.unwrap_or_default().view.view()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_told_by_a_number_between_dots() {
        assert_eq!(split("shot.0007.exr"), Some(("shot.#.exr".into(), 7)));
        assert_eq!(split("a.b.-3.png"), Some(("a.b.#.png".into(), -3)));
        assert_eq!((split("contact_sheet.png"), split("7.exr"), split("shot.0007.jpg")), (None, None, None));
    }
}
