//! Dark seams between bright parts of a picture.

use glam::{Vec2, vec2};
use rayon::prelude::*;
use rstar::RTree;
use rstar::primitives::GeomWithData;

use super::picture::Picture;

/// Cells per plane unit.
const CELLS: f32 = 256.0;
/// Density below which darkness tells nothing, over the mean where there is light.
const FAINT: f32 = 0.3;
/// Photons around a dark cell that tell where it was in another picture: some on each side of a seam.
const AROUND: usize = 8;

/// The dark seams of some photons: what a closing of their density fills in.
pub struct Seams {
    columns: usize,
    rows: usize,
    /// By cell, row by row.
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

    /// The seams that were not there in a key: for each cell, row by row, the share of the light around it that is missing,
    /// 0..=1, less that of the same part of the picture in the `key`. 0 in faint light. The photons are at `now` here, and
    /// were at `then` in the key, row by row, finite.
    pub fn opened(&self, now: &[Vec2], key: &Self, then: &[Vec2]) -> Vec<f32> {
        let entry = |(p, row): (&Vec2, usize)| GeomWithData::new(p.to_array(), row);
        let tree = RTree::bulk_load(now.iter().zip(0..).map(entry).collect());
        let [dark, dark_then] = [self.darkness(), key.darkness()];
        let opened = |(cell, dark): (usize, &f32)| {
            if *dark <= 0.0 {
                return 0.0;
            }
            let place = (vec2((cell % self.columns) as f32, (cell / self.columns) as f32) + 0.5) / CELLS;
            let around = tree.nearest_neighbor_iter(place.to_array()).take(AROUND).map(|entry| entry.data);
            let moved: Vec<Vec2> = around.map(|row| then[row] - now[row]).collect();
            let was = place + moved.iter().sum::<Vec2>() / moved.len().max(1) as f32;
            (dark - key.darkest_near(was, &dark_then)).max(0.0)
        };
        dark.par_iter().enumerate().map(opened).collect()
    }

    /// For each cell the share of the light around it that is missing; 0 in faint light.
    fn darkness(&self) -> Vec<f32> {
        let lit = self.density.iter().filter(|density| **density > 0.0).count();
        let faint = FAINT * self.total as f32 / lit.max(1) as f32;
        let dark = |(closed, density): (&f32, &f32)| {
            if *closed > faint { (closed - density) / closed } else { 0.0 }
        };
        self.closed.iter().zip(&self.density).map(dark).collect()
    }

    /// The darkest of the cells at a place and next to it; 0 outside.
    fn darkest_near(&self, place: Vec2, darkness: &[f32]) -> f32 {
        let [x, y] = (place * CELLS).floor().to_array().map(|cell| cell as i64);
        let around = (y - 1..=y + 1).flat_map(|y| (x - 1..=x + 1).map(move |x| (x, y)));
        let inside =
            around.filter(|(x, y)| (0..self.columns as i64).contains(x) && (0..self.rows as i64).contains(y));
        inside.map(|(x, y)| darkness[y as usize * self.columns + x as usize]).fold(0.0, f32::max)
    }
}
