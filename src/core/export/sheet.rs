//! The contact sheet: the frames of a sequence on one page.

use std::path::Path;

use glam::Vec3;

use super::overlay::Overlay;
use super::png::{self, PngDepth};
use super::text;
use crate::Result;
use crate::render::image::Image;

/// Background, a dark neutral grey in screen values.
pub(super) const SURROUND: Vec3 = Vec3::splat(0.11);
/// Captions, screen values.
pub(super) const INK: Vec3 = Vec3::splat(0.72);
/// Margin between and around pictures, pixels.
pub(super) const GAP: usize = 12;
/// Height of the line with the frame number.
const CAPTION: usize = 26;
/// Its font size.
const LETTERS: f32 = 20.0;

/// At most `count` of `frames`, evenly spaced, including the first and the last.
pub fn evenly_chosen(frames: &[i32], count: usize) -> Vec<i32> {
    let count = count.min(frames.len());
    // Steps between the first and the last, each rounded to the nearest frame.
    let steps = count.saturating_sub(1).max(1);
    (0..count).map(|i| frames[(i * (frames.len() - 1) + steps / 2) / steps]).collect()
}

/// Writes a PNG with the pictures (screen values, all of one size) row by row, each under the overlay and with its number
/// below; and texts by their names ([`png`]).
///
/// # Panics
/// If the pictures differ in size.
pub fn write_contact_sheet(
    path: &Path,
    pictures: &[(i32, Image)],
    columns: usize,
    overlay: Overlay,
    texts: &[(&str, String)],
) -> Result<()> {
    png::write_with_texts(path, &arrange(pictures, columns, overlay), PngDepth::Eight, texts)
}

/// The page itself, in screen values.
fn arrange(pictures: &[(i32, Image)], columns: usize, overlay: Overlay) -> Image {
    let columns = columns.clamp(1, pictures.len().max(1));
    let rows = pictures.len().div_ceil(columns);
    let (width, height) = pictures.first().map_or((1, 1), |(_, p)| (p.width, p.height));
    let cell = (width + GAP, height + GAP + CAPTION);
    let mut page = Image::new(columns * cell.0 + GAP, rows * cell.1 + GAP);
    page.pixels.fill(SURROUND);
    for (i, (number, picture)) in pictures.iter().enumerate() {
        assert_eq!((picture.width, picture.height), (width, height), "pictures of one size");
        let (left, top) = (GAP + i % columns * cell.0, GAP + i / columns * cell.1);
        paste(&mut page, picture, left, top, overlay);
        let place = [left as f32, (top + height) as f32 + 0.5 * (CAPTION as f32 - LETTERS)];
        text::draw(&mut page, &number.to_string(), place, LETTERS, INK);
    }
    page
}

/// Copies a picture with the overlay onto the page, which must have room for it.
pub(super) fn paste(page: &mut Image, picture: &Image, left: usize, top: usize, overlay: Overlay) {
    let mut picture = picture.clone();
    overlay.draw(&mut picture);
    for (y, row) in picture.pixels.chunks_exact(picture.width.max(1)).enumerate() {
        let start = (top + y) * page.width + left;
        page.pixels[start..start + picture.width].copy_from_slice(row);
    }
}
