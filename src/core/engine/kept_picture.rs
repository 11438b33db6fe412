//! The picture of a frame that is there already, for contact sheets and films.

use std::path::{Path, PathBuf};

use glam::Vec3;

use super::existing::pictures_of;
use crate::export::exr;
use crate::files::read_regular_file;
use crate::project::OutputSettings;
use crate::render::Image;
use crate::render::view::View;
use crate::{Error, Result};

/// Width of a picture on a contact sheet, pixels.
const THUMBNAIL: usize = 480;
/// Largest frame that is read.
const MAX_BYTES: u64 = 8 << 30;

/// The picture of a frame in screen values; none where no file of it shows one.
///
/// # Errors
/// A file that cannot be read.
pub(super) fn kept_picture(
    output: &OutputSettings,
    folder: &Path,
    frame: i32,
    view: &View,
) -> Result<Option<Image>> {
    let mut files = pictures_of(output, folder, frame)?;
    // The screen values themselves come before the light that they are made from.
    files.sort_by(|a, b| b.cmp(a));
    first(&files, |path| picture_of(path, view))
}

/// As [`kept_picture`], as small as on a contact sheet.
///
/// # Errors
/// A file that cannot be read.
pub(super) fn kept_thumbnail(
    output: &OutputSettings,
    folder: &Path,
    frame: i32,
    view: &View,
) -> Result<Option<Image>> {
    let mut files = pictures_of(output, folder, frame)?;
    // The light comes before what a screen shows of it.
    files.sort();
    first(&files, |path| thumbnail_of(path, view))
}

/// The first picture that there is.
fn first(files: &[PathBuf], read: impl Fn(&Path) -> Result<Option<Image>>) -> Result<Option<Image>> {
    let there = files.iter().filter(|path| path.is_file());
    there.map(|path| read(path)).filter_map(Result::transpose).next().transpose()
}

/// The picture of a file in screen values; none where it shows none.
///
/// # Errors
/// A file that cannot be read.
fn picture_of(path: &Path, view: &View) -> Result<Option<Image>> {
    if is_png(path) {
        return of_png(path).map(Some);
    }
    Ok(exr::read_beauty(path)?.map(|light| view.apply(&light)))
}

/// As [`picture_of`], as small as on a contact sheet; of an EXR file the light is averaged, not what a screen shows of it.
///
/// # Errors
/// A file that cannot be read.
pub(super) fn thumbnail_of(path: &Path, view: &View) -> Result<Option<Image>> {
    if is_png(path) {
        return of_png(path).map(|picture| Some(small(&picture)));
    }
    Ok(exr::read_beauty(path)?.map(|light| view.apply(&small(&light))))
}

/// A picture as small as on a contact sheet.
pub(super) fn small(image: &Image) -> Image {
    image.resized(THUMBNAIL, (THUMBNAIL * image.height).div_ceil(image.width))
}

fn is_png(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending == "png")
}

/// The screen values of a PNG.
fn of_png(path: &Path) -> Result<Image> {
    let bytes = read_regular_file(path, MAX_BYTES)?;
    let decoded = image::load_from_memory_with_format(&bytes, image::ImageFormat::Png)
        .map_err(|error| Error::format(path, "", format!("cannot be decoded: {error}")))?
        .into_rgb32f();
    let (width, height) = (decoded.width() as usize, decoded.height() as usize);
    Ok(Image { width, height, pixels: decoded.pixels().map(|pixel| Vec3::from(pixel.0)).collect() })
}
