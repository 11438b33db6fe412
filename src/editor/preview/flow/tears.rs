//! The map of tears: where photons have left the neighbours they have in the key that is seen, and where cracks open.

use std::sync::Arc;

use glam::{Vec2, vec2};
use lightloom_core::Progress;
use lightloom_core::continuity::{Neighbourhoods, Seams, TORN, chosen_rows};
use lightloom_core::engine::Preview;

use super::picture::{HeatMap, Request};
use super::sample::cells;
use crate::editor::session::FieldMap;

/// Cells of the map along the longer side.
const CELLS: f32 = 128.0;
/// Missing shares of light between which cracks are drawn ever stronger: below, photons are scattered by chance.
const DARK: [f32; 2] = [0.25, 0.75];

/// Remembers the key that is seen from frame to frame.
#[derive(Default)]
pub(super) struct TearFinder {
    last: Option<SeenKey>,
}

/// The light of one key.
struct SeenKey {
    preview: Arc<Preview>,
    number: usize,
    positions: Vec<Vec2>,
    neighbourhoods: Neighbourhoods,
    seams: Seams,
}

impl SeenKey {
    fn new(preview: &Arc<Preview>, number: usize, rows: &[usize]) -> Self {
        let positions = chosen(preview.at_key(number), rows);
        let all: Vec<usize> = (0..rows.len()).collect();
        Self {
            neighbourhoods: Neighbourhoods::new(&positions, &all),
            seams: Seams::new(&positions, preview.extent()),
            preview: preview.clone(),
            positions,
            number,
        }
    }
}

fn chosen(all: &[Vec2], rows: &[usize]) -> Vec<Vec2> {
    rows.iter().map(|&row| all[row]).collect()
}

impl TearFinder {
    /// The map at the frame of a request: above 0 torn, 1 at the distance from which a photon counts as torn; below 0
    /// cracked, -1 where the light around has all gone. None before the frame is known, and when cancelled.
    pub(super) fn map(&mut self, request: &Request, progress: &Progress) -> Option<HeatMap> {
        let Request { preview, frame, .. } = request;
        let rows = chosen_rows(preview.photons());
        let positions = chosen(preview.positions(*frame)?, &rows);
        let number = preview.seen_key(*frame);
        let is_seen = |key: &SeenKey| Arc::ptr_eq(&key.preview, preview) && key.number == number;
        let key = match self.last.take().filter(is_seen) {
            Some(key) => key,
            None => SeenKey::new(preview, number, &rows),
        };
        let key = self.last.insert(key);
        progress.check().ok()?;
        let mut map = torn(&positions, &key.neighbourhoods.residuals(&positions), preview.extent());
        progress.check().ok()?;
        let seams = Seams::new(&positions, preview.extent());
        let opened = seams.opened(&positions, &key.seams, &key.positions);
        crack(&mut map, &opened, seams.cells(), preview.extent());
        Some(map)
    }
}

/// The mean over the photons near each node.
fn torn(positions: &[Vec2], residuals: &[f64], extent: Vec2) -> HeatMap {
    let cells = cells(extent, CELLS);
    let last = vec2(cells[0] as f32, cells[1] as f32);
    let mut sums = vec![(0.0, 0.0); (cells[0] + 1) * (cells[1] + 1)];
    for (p, residual) in positions.iter().zip(residuals) {
        let node = (*p / extent * last).round().clamp(Vec2::ZERO, last);
        let (sum, count) = &mut sums[node.y as usize * (cells[0] + 1) + node.x as usize];
        *sum += (residual / TORN).min(1.0) as f32;
        *count += 1.0f32;
    }
    let values = sums.into_iter().map(|(sum, count)| sum / count.max(1.0)).collect();
    HeatMap { of: FieldMap::Tears, cells, values, most: 1.0 }
}

/// Draws cracks into a map: `opened` says how dark each of their own cells has become.
fn crack(map: &mut HeatMap, opened: &[f32], [columns, rows]: [usize; 2], extent: Vec2) {
    let last = vec2(map.cells[0] as f32, map.cells[1] as f32);
    let side = extent.max_element() / columns.max(rows) as f32;
    for (i, dark) in opened.iter().enumerate() {
        let strength = (dark - DARK[0]) / (DARK[1] - DARK[0]);
        if strength > 0.0 {
            let centre = vec2((i % columns) as f32 + 0.5, (i / columns) as f32 + 0.5) * side;
            let node = (centre / extent * last).round().clamp(Vec2::ZERO, last);
            let value = &mut map.values[node.y as usize * (map.cells[0] + 1) + node.x as usize];
            *value = value.min(-strength.min(1.0));
        }
    }
}
