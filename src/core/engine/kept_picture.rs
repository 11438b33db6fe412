//! The picture of a frame that is there already, for contact sheets and films.

use std::path::Path;

use glam::Vec3;

use super::existing::files_of;
use crate::export::{FrameLayer, exr};
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
    let plane = format!("_{}.", FrameLayer::Plane.name());
    let mut files = files_of(output, folder, frame)?;
    // The screen values themselves come before the light that they are made from.
    files.sort_by(|a, b| b.cmp(a));
    for path in files {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if !path.is_file() || name.contains(&plane) {
            continue;
        }
        if let Some(picture) = picture_of(&path, view)? {
            return Ok(Some(picture));
        }
    }
    Ok(None)
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
