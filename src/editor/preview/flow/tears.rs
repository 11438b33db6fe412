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

/// The neighbourhoods of one key, remembered from frame to frame.
#[derive(Default)]
pub(super) struct TearFinder {
    last: Option<(Arc<Preview>, usize, Neighbourhoods)>,
}

impl TearFinder {
    /// The map at the frame of a request: above 0 torn, 1 at the distance from which a photon counts as torn; below 0
    /// cracked, -1 where the light around has all gone. None before the frame is known, and when cancelled.
    pub(super) fn map(&mut self, request: &Request, progress: &Progress) -> Option<HeatMap> {
        let Request { preview, frame, .. } = request;
        let rows = chosen_rows(preview.photons());
        let chosen = |all: &[Vec2]| rows.iter().map(|&row| all[row]).collect::<Vec<_>>();
        let positions = chosen(preview.positions(*frame)?);
        let key = preview.seen_key(*frame);
        if self.last.as_ref().is_none_or(|(of, at, _)| !Arc::ptr_eq(of, preview) || *at != key) {
            let all: Vec<usize> = (0..rows.len()).collect();
            let neighbourhoods = Neighbourhoods::new(&chosen(preview.at_key(key)), &all);
            self.last = Some((preview.clone(), key, neighbourhoods));
        }
        progress.check().ok()?;
        let residuals = self.last.as_ref()?.2.residuals(&positions);
        let mut map = torn(&positions, &residuals, preview.extent());
        progress.check().ok()?;
        crack(&mut map, &Seams::new(&positions, preview.extent()), preview.extent());
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

/// Draws the cracks of `seams` into a map.
fn crack(map: &mut HeatMap, seams: &Seams, extent: Vec2) {
    let [columns, rows] = seams.cells();
    let last = vec2(map.cells[0] as f32, map.cells[1] as f32);
    let plane = extent.max_element() / columns.max(rows) as f32;
    for (i, dark) in seams.darkness().enumerate() {
        let strength = (dark - DARK[0]) / (DARK[1] - DARK[0]);
        if strength > 0.0 {
            let centre = vec2((i % columns) as f32 + 0.5, (i / columns) as f32 + 0.5) * plane;
            let node = (centre / extent * last).round().clamp(Vec2::ZERO, last);
            let value = &mut map.values[node.y as usize * (map.cells[0] + 1) + node.x as usize];
            *value = value.min(-strength.min(1.0));
        }
    }
}
