//! The comparison sheet: the same frames by several methods, a row per method.

use std::path::Path;

use super::overlay::Overlay;
use super::png::{self, PngDepth};
use super::sheet::{GAP, INK, SURROUND, paste};
use super::text;
use crate::Result;
use crate::render::image::Image;

/// Width of the text column, pixels.
const TEXT_WIDTH: usize = 450;
/// Line heights of the heading, of a row's title, and of its other lines.
const HEADING: f32 = 46.0;
const TITLE: f32 = 44.0;
const LINE: f32 = 30.0;
/// Font size of small text.
const SMALL: f32 = 26.0;
/// Height of the line with the frame numbers.
const NUMBERS: usize = 34;
/// Titles, screen values.
const BRIGHT: glam::Vec3 = glam::Vec3::splat(0.93);

/// The content of the sheet.
#[derive(Clone, Debug)]
pub struct ComparisonSheet {
    /// Heading.
    pub heading: String,
    /// Smaller text beside the heading.
    pub subheading: String,
    /// Frame numbers, above the columns.
    pub numbers: Vec<i32>,
    /// One row per method.
    pub rows: Vec<MethodRow>,
}

/// The row of one method.
#[derive(Clone, Debug)]
pub struct MethodRow {
    /// Name of the method.
    pub title: String,
    /// Its figures, a name and a value per line.
    pub lines: Vec<(String, String)>,
    /// One picture per frame, screen values, all of one size.
    pub pictures: Vec<Image>,
}

/// Writes the sheet as PNG.
///
/// # Panics
/// If the pictures differ in size.
pub fn write_comparison(path: &Path, comparison: &ComparisonSheet, overlay: Overlay) -> Result<()> {
    png::write(path, &arrange(comparison, overlay), PngDepth::Eight)
}

fn arrange(comparison: &ComparisonSheet, overlay: Overlay) -> Image {
    let ComparisonSheet { heading, subheading, numbers, rows } = comparison;
    let pictures = || rows.iter().flat_map(|row| &row.pictures);
    let (width, height) = pictures().next().map_or((1, 1), |p| (p.width, p.height));
    assert!(pictures().all(|p| (p.width, p.height) == (width, height)), "pictures of one size");
    let lines = rows.iter().map(|row| row.lines.len()).max().unwrap_or(0);
    let row_height = height.max((TITLE + LINE * (lines as f32 + 0.5)) as usize) + GAP;
    let top = 2 * GAP + HEADING as usize + NUMBERS;
    let left = 2 * GAP + TEXT_WIDTH;
    let mut page = Image::new(left + numbers.len() * (width + GAP), top + rows.len() * row_height);
    page.pixels.fill(SURROUND);

    let end = text::draw(&mut page, heading, [GAP as f32 * 1.5, GAP as f32], HEADING, BRIGHT);
    let beside = [end + GAP as f32 * 2.0, GAP as f32 + 0.5 * (HEADING - SMALL) + 3.0];
    text::draw(&mut page, subheading, beside, SMALL, INK);
    for (column, number) in numbers.iter().enumerate() {
        let place = [(left + column * (width + GAP)) as f32, (top - NUMBERS) as f32];
        text::draw(&mut page, &format!("frame {number}"), place, SMALL, INK);
    }
    for (i, row) in rows.iter().enumerate() {
        let top = top + i * row_height;
        draw_text(&mut page, row, top as f32);
        for (column, picture) in row.pictures.iter().enumerate() {
            paste(&mut page, picture, left + column * (width + GAP), top, overlay);
        }
    }
    page
}

/// The title of a row and its lines below, in columns of names and values.
fn draw_text(page: &mut Image, row: &MethodRow, top: f32) {
    let left = GAP as f32 * 1.5;
    text::draw(page, &row.title, [left, top - 4.0], TITLE, BRIGHT);
    for (i, (name, value)) in row.lines.iter().enumerate() {
        let y = top + TITLE + LINE * i as f32;
        text::draw(page, name, [left, y], SMALL, INK);
        text::draw(page, value, [left + 0.42 * TEXT_WIDTH as f32, y], SMALL, BRIGHT);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_has_room_for_all_words_and_pictures() {
        let row = |count| MethodRow {
            title: "flow".into(),
            lines: vec![("transport cost".into(), "1.01".into()); 6],
            pictures: vec![Image::new(40, 20); count],
        };
        for (count, rows) in [(0, 0), (0, 1), (1, 1), (3, 2)] {
            let sheet = ComparisonSheet {
                heading: "Letters".into(),
                subheading: "two methods".into(),
                numbers: (0..count as i32).collect(),
                rows: vec![row(count); rows],
            };
            let page = arrange(&sheet, Overlay::NONE);
            assert!(page.width >= TEXT_WIDTH + count * 40 && page.height >= rows * 150);
        }
    }
}
