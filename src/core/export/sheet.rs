//! The contact sheet: a sequence on one page.

use std::path::Path;

use glam::Vec3;

use super::png::{self, PngDepth};
use crate::Result;
use crate::render::image::Image;

/// Surround and gap, a dark neutral grey in screen values.
const SURROUND: Vec3 = Vec3::splat(0.11);
const INK: Vec3 = Vec3::splat(0.62);
const GAP: usize = 12;
/// Height of the line with the frame number.
const CAPTION: usize = 24;
/// Side of one dot of a digit.
const DOT: usize = 2;

/// At most `count` of `frames`, evenly chosen, the first and the last among them.
pub fn evenly_chosen(frames: &[i32], count: usize) -> Vec<i32> {
    let count = count.min(frames.len());
    // Steps between the first and the last, each rounded to the nearest frame.
    let steps = count.saturating_sub(1).max(1);
    (0..count).map(|i| frames[(i * (frames.len() - 1) + steps / 2) / steps]).collect()
}

/// Writes a PNG with the given pictures (screen values, all of one size) row by row, each with its number below.
///
/// # Panics
/// If the pictures differ in size.
pub fn write_contact_sheet(path: &Path, pictures: &[(i32, Image)], columns: usize) -> Result<()> {
    png::write(path, &arrange(pictures, columns), PngDepth::Eight)
}

/// The page itself, in screen values.
fn arrange(pictures: &[(i32, Image)], columns: usize) -> Image {
    let columns = columns.clamp(1, pictures.len().max(1));
    let rows = pictures.len().div_ceil(columns);
    let (width, height) = pictures.first().map_or((1, 1), |(_, p)| (p.width, p.height));
    let cell = (width + GAP, height + GAP + CAPTION);
    let mut page = Image::new(columns * cell.0 + GAP, rows * cell.1 + GAP);
    page.pixels.fill(SURROUND);
    for (i, (number, picture)) in pictures.iter().enumerate() {
        assert_eq!((picture.width, picture.height), (width, height), "pictures of one size");
        let (left, top) = (GAP + i % columns * cell.0, GAP + i / columns * cell.1);
        for (y, row) in picture.pixels.chunks_exact(width).enumerate() {
            let start = (top + y) * page.width + left;
            page.pixels[start..start + width].copy_from_slice(row);
        }
        draw_number(&mut page, *number, left, top + height + (CAPTION - 7 * DOT) / 2);
    }
    page
}

/// Draws a number with its upper left corner at a pixel; what would lie beside the page is left out.
fn draw_number(page: &mut Image, number: i32, left: usize, top: usize) {
    for (i, character) in number.to_string().bytes().enumerate() {
        let rows = if character == b'-' { MINUS } else { DIGITS[usize::from(character - b'0')] };
        for (y, x) in (0..7 * DOT).flat_map(|y| (0..5 * DOT).map(move |x| (y, x))) {
            let (px, py) = (left + i * 6 * DOT + x, top + y);
            if rows[y / DOT] >> (4 - x / DOT) & 1 == 1 && px < page.width && py < page.height {
                page.pixels[py * page.width + px] = INK;
            }
        }
    }
}

const MINUS: [u8; 7] = [0, 0, 0, 0b11110, 0, 0, 0];

/// Digits of 5 by 7 dots, a row per byte.
const DIGITS: [[u8; 7]; 10] = [
    [0b01110, 0b10001, 0b10011, 0b10101, 0b11001, 0b10001, 0b01110],
    [0b00100, 0b01100, 0b00100, 0b00100, 0b00100, 0b00100, 0b01110],
    [0b01110, 0b10001, 0b00001, 0b00010, 0b00100, 0b01000, 0b11111],
    [0b11111, 0b00010, 0b00100, 0b00010, 0b00001, 0b10001, 0b01110],
    [0b00010, 0b00110, 0b01010, 0b10010, 0b11111, 0b00010, 0b00010],
    [0b11111, 0b10000, 0b11110, 0b00001, 0b00001, 0b10001, 0b01110],
    [0b00110, 0b01000, 0b10000, 0b11110, 0b10001, 0b10001, 0b01110],
    [0b11111, 0b00001, 0b00010, 0b00100, 0b01000, 0b01000, 0b01000],
    [0b01110, 0b10001, 0b10001, 0b01110, 0b10001, 0b10001, 0b01110],
    [0b01110, 0b10001, 0b10001, 0b01111, 0b00001, 0b00010, 0b01100],
];
