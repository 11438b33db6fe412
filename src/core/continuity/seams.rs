//! Dark seams between bright parts of a picture.

use glam::Vec2;

use super::picture::Picture;

/// Cells per plane unit.
const CELLS: f32 = 256.0;
/// Density below which darkness tells nothing, over the mean where there is light.
const FAINT: f32 = 0.3;

/// The dark seams of some photons: what a closing of their density fills in.
pub struct Seams {
    columns: usize,
    rows: usize,
    density: Vec<f32>,
    closed: Vec<f32>,
    total: f64,
}

impl Seams {
    /// The seams of photons on a plane of this extent, whose longer side is 1; those outside are left out.
    pub fn new(positions: &[Vec2], extent: Vec2) -> Self {
        let density = Picture::counted(positions, extent, CELLS).blurred();
        let closed = density.closed();
        let Picture { columns, rows, .. } = density;
        Self { columns, rows, total: density.sum(), density: density.cells, closed: closed.cells }
    }

    /// Number of cells along x and y; the side of each is 1/256.
    pub fn cells(&self) -> [usize; 2] {
        [self.columns, self.rows]
    }

    /// What the closing fills in, over all light; 0 where there is none.
    pub fn share(&self) -> f64 {
        let pairs = self.closed.iter().zip(&self.density);
        let filled: f64 = pairs.map(|(closed, density)| f64::from(closed - density)).sum();
        if self.total > 0.0 { filled / self.total } else { 0.0 }
    }

    /// For each cell, row by row: the share of the light around it that is missing there, 0..=1; 0 in faint light.
    pub fn darkness(&self) -> impl Iterator<Item = f32> {
        let lit = self.density.iter().filter(|density| **density > 0.0).count();
        let faint = FAINT * self.total as f32 / lit.max(1) as f32;
        let dark = move |(closed, density): (&f32, &f32)| {
            if *closed > faint { (closed - density) / closed } else { 0.0 }
        };
        self.closed.iter().zip(&self.density).map(dark)
    }
}
