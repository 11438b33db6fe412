//! Pictures in linear light.

use glam::Vec3;

/// RGB, linear Rec.709 primaries, f32; row 0 is the top.
#[derive(Clone, Debug, PartialEq, serde::Deserialize, serde::Serialize)]
pub struct Image {
    /// Pixels per row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// `width * height` colours, row by row.
    pub pixels: Vec<Vec3>,
}

impl Image {
    /// A black picture.
    pub fn new(width: usize, height: usize) -> Self {
        Self { width, height, pixels: vec![Vec3::ZERO; width * height] }
    }

    /// The colour at column `x` of row `y`.
    ///
    /// # Panics
    /// Outside the picture.
    pub fn at(&self, x: usize, y: usize) -> Vec3 {
        assert!(x < self.width && y < self.height, "({x}, {y}) lies outside the picture");
        self.pixels[y * self.width + x]
    }

    /// The sum of two pictures of one size, pixel by pixel in f32.
    ///
    /// # Panics
    /// If the sizes differ.
    pub fn plus(&self, other: &Self) -> Self {
        assert_eq!((self.width, self.height), (other.width, other.height), "pictures of one size");
        let pixels = self.pixels.iter().zip(&other.pixels).map(|(a, b)| a + b).collect();
        Self { width: self.width, height: self.height, pixels }
    }

    /// The picture at another size, by area averaging.
    pub fn resized(&self, width: usize, height: usize) -> Self {
        let columns = coverage(self.width, width);
        let rows = coverage(self.height, height);
        let mut out = Self::new(width, height);
        for (y, row) in out.pixels.chunks_exact_mut(width.max(1)).enumerate() {
            for (x, pixel) in row.iter_mut().enumerate() {
                for &(sy, wy) in &rows[y] {
                    for &(sx, wx) in &columns[x] {
                        *pixel += self.pixels[sy * self.width + sx] * (wx * wy);
                    }
                }
            }
        }
        out
    }
}

/// For each of `to` equal parts of a line of `from` cells: the cells it covers and their shares, which sum to 1.
fn coverage(from: usize, to: usize) -> Vec<Vec<(usize, f32)>> {
    let scale = from as f64 / to as f64;
    (0..to)
        .map(|i| {
            let (a, b) = (i as f64 * scale, (i + 1) as f64 * scale);
            (a as usize..(b.ceil() as usize).min(from))
                .map(|s| (s, (((s + 1) as f64).min(b) - (s as f64).max(a)) / scale))
                .filter(|&(_, share)| share > 0.0)
                .map(|(s, share)| (s, share as f32))
                .collect()
        })
        .collect()
}
