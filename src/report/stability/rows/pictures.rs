//! Rows of targets: one that is the source, one of a single pixel, and one in which one pixel outshines all.

use super::flow::rest;
use super::row::Expected::{Fails, Holds};
use super::row::Row;
use crate::effort::Effort;
use crate::stability::picture_case::PictureCase;

pub(super) fn target(effort: Effort) -> Vec<Row> {
    const DARK: &str = "a black target attracts nothing; the message names the file";
    let picture = |name: &str, expected, second: &'static str, draw: fn(usize, usize) -> f32| {
        Row::new(name, expected, move |effort| PictureCase::new(second, draw, effort))
    };
    let one_pixel = |x, y| f32::from(x == 20 && y == 40);
    let bright_pixel = |x, y| if x == 20 && y == 40 { 1e8 } else { 1.0 };
    let precise = Holds("shares of the light are summed in double precision");
    let mut rows = rest(effort);
    rows.extend([
        picture("the same picture twice", Holds("light at rest keeps its flux"), "a", |_, _| 1.0),
        picture("one pixel", Holds("a pixel has an area"), "b", one_pixel),
        picture("one pixel 1e8 times as bright as the others", precise, "b", bright_pixel),
        picture("black", Fails("b.exr", DARK), "b", |_, _| 0.0),
    ]);
    rows
}
