//! A low-resolution map of a picture's sampling density, for display.

use std::path::Path;

use glam::Vec2;

use super::decode;
use super::picture::Cells;
use super::settings::{Channel, ImageTarget};
use crate::{Progress, Result};

/// The sampling density of a picture, downscaled.
#[derive(Clone, Debug, PartialEq)]
pub struct Brightness {
    /// Size of the picture as shown, in heights of a pixel.
    pub size: Vec2,
    /// Cells per row.
    pub width: usize,
    /// Density of each cell over the largest, 0 to 1, row by row from the top.
    pub values: Vec<f32>,
}

impl Brightness {
    /// Reads the picture at `path`, with at most `side` cells along its longer side.
    ///
    /// # Errors
    /// `Io`, `Format` or `Limit` when the file cannot be used.
    pub fn load(path: &Path, target: &ImageTarget, side: usize) -> Result<Self> {
        let progress = &Progress::new();
        let picture = decode::read(path, progress)?;
        let mut cells = Cells::of(&picture, target, target.channel, progress)?;
        if target.channel == Channel::Brightness && cells.black_with_shape {
            cells = Cells::of(&picture, target, Channel::Alpha, progress)?;
        }
        let rows = cells.weights.len() / cells.width.max(1);
        let block = cells.width.max(rows).div_ceil(side.max(1)).max(1);
        let (width, height) = (cells.width.div_ceil(block), rows.div_ceil(block));
        let mut values = vec![0.0_f32; width * height];
        for (row, line) in cells.weights.chunks_exact(cells.width.max(1)).enumerate() {
            for (column, weight) in line.iter().enumerate() {
                values[row / block * width + column / block] += weight;
            }
        }
        let most = values.iter().copied().fold(f32::MIN_POSITIVE, f32::max);
        values.iter_mut().for_each(|value| *value /= most);
        Ok(Self { size: picture.shown_size(), width, values })
    }
}
