//! Maps of the field over the light.

use egui::Mesh;
use glam::Vec2;

use super::{Overlay, colours};
use crate::editor::preview::HeatMap;

impl Overlay<'_> {
    /// Draws a map over the plane of this extent.
    pub(super) fn heat(&self, map: &HeatMap, extent: Vec2) {
        let [columns, rows] = map.cells;
        if map.most <= 0.0 || map.values.len() != (columns + 1) * (rows + 1) {
            return;
        }
        let mut mesh = Mesh::default();
        for (i, value) in map.values.iter().enumerate() {
            let node = glam::vec2((i % (columns + 1)) as f32, (i / (columns + 1)) as f32);
            let p = node / glam::vec2(columns as f32, rows as f32) * extent;
            // A view with a part of the plane behind the camera shows no map.
            let Some(place) = (self.screen)(p) else { return };
            mesh.colored_vertex(place, colours::of_map(map.of, value / map.most));
        }
        let row = columns as u32 + 1;
        for at in (0..rows as u32).flat_map(|y| (0..columns as u32).map(move |x| y * row + x)) {
            mesh.add_triangle(at, at + 1, at + row);
            mesh.add_triangle(at + 1, at + row + 1, at + row);
        }
        self.painter.add(mesh);
    }
}
