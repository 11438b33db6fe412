//! A picture file as linear light, pixel by pixel.

use std::path::Path;

use glam::{Vec2, Vec3};

use super::decode;
use super::picture::{clean, note_on_bad};
use crate::{Progress, Result};

/// The linear light of a picture file; transparent parts are black.
#[derive(Clone, Debug)]
pub struct PictureLight {
    /// Pixels per row, and rows.
    pub size: [usize; 2],
    /// Size as shown, in heights of a pixel.
    pub shown: Vec2,
    /// Linear Rec.709, row by row from the top.
    pub pixels: Vec<Vec3>,
    /// Warnings about the file.
    pub notes: Vec<String>,
}

impl PictureLight {
    /// Reads the picture at `path`.
    ///
    /// # Errors
    /// `Io`, `Format` or `Limit` when the file cannot be used; `Cancelled`.
    pub fn load(path: &Path, progress: &Progress) -> Result<Self> {
        let picture = decode::read(path, progress)?;
        let mut notes = picture.notes.clone();
        let mut pixels = Vec::with_capacity(picture.width * picture.height);
        let (mut bad, mut clear) = (0, 0);
        let mut line = Vec::with_capacity(picture.width);
        for row in 0..picture.height {
            progress.check()?;
            picture.read_row(row, &mut line);
            for pixel in &mut line {
                bad += usize::from(clean(pixel));
                clear += usize::from(pixel[3] < 1.0);
                pixels.push(Vec3::from_slice(pixel));
            }
        }
        notes.extend(note_on_bad(path, bad));
        if clear > 0 {
            let path = path.display();
            notes.push(format!("'{path}': {clear} pixels are transparent, which count as lying over black"));
        }
        let size = [picture.width, picture.height];
        Ok(Self { size, shown: picture.shown_size(), pixels, notes })
    }
}
