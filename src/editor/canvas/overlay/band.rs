//! Bands of constant width along a polyline.

use egui::{Color32, Mesh};
use glam::Vec2;

use super::Overlay;

/// Miter limit, over half the width.
const MITRE: f32 = 2.0;

/// The miter vector at each point: times half the width it leads to the left border.
pub(super) fn sideways(points: &[Vec2]) -> Vec<Vec2> {
    let last = points.len().saturating_sub(1);
    let normals: Vec<Vec2> = points.windows(2).map(|p| (p[1] - p[0]).perp().normalize_or_zero()).collect();
    let closed = points.len() > 3 && points[0] == points[last];
    let side = |i: usize| {
        let before = if i > 0 { normals.get(i - 1) } else { normals.last().filter(|_| closed) };
        let after = if i < last { normals.get(i) } else { normals.first().filter(|_| closed) };
        match (before, after) {
            (Some(a), Some(b)) => {
                let middle = (*a + *b).normalize_or(*b);
                middle * middle.dot(*b).max(1.0 / MITRE).recip()
            }
            (Some(only), None) | (None, Some(only)) => *only,
            (None, None) => Vec2::ZERO,
        }
    };
    (0..points.len()).map(side).collect()
}

/// The polyline offset by `by` plane units to the left.
pub(super) fn beside(points: &[Vec2], by: f32) -> Vec<Vec2> {
    points.iter().zip(sideways(points)).map(|(&p, side)| p + side * by).collect()
}

impl Overlay<'_> {
    /// Fills a band with a colour at each of several offsets to the left, plane units.
    pub(super) fn band(&self, points: &[Vec2], across: &[(f32, Color32)]) {
        let mut mesh = Mesh::default();
        let mut before: Option<u32> = None;
        for (&p, side) in points.iter().zip(sideways(points)) {
            let row: Option<Vec<_>> =
                across.iter().map(|&(by, colour)| Some(((self.screen)(p + side * by)?, colour))).collect();
            let Some(row) = row else {
                before = None;
                continue;
            };
            let start = mesh.vertices.len() as u32;
            for (place, colour) in row {
                mesh.colored_vertex(place, colour);
            }
            for i in 0..across.len() as u32 - 1 {
                if let Some(before) = before {
                    mesh.add_triangle(before + i, before + i + 1, start + i);
                    mesh.add_triangle(before + i + 1, start + i + 1, start + i);
                }
            }
            before = Some(start);
        }
        self.painter.add(mesh);
    }
}

#[cfg(test)]
mod tests {
    use glam::vec2;

    use super::*;

    #[test]
    fn a_band_is_as_wide_around_a_corner_as_along_the_line() {
        let corner = [vec2(0.0, 0.0), vec2(1.0, 0.0), vec2(1.0, 1.0)];
        let left = beside(&corner, 0.1);
        assert!(left[1].distance(vec2(0.9, 0.1)) < 1e-5);
        assert!(left[0].distance(vec2(0.0, 0.1)) < 1e-5 && left[2].distance(vec2(0.9, 1.0)) < 1e-5);
    }

    #[test]
    fn the_ends_of_a_loop_meet() {
        let square = [vec2(0.0, 0.0), vec2(1.0, 0.0), vec2(1.0, 1.0), vec2(0.0, 1.0), vec2(0.0, 0.0)];
        let left = beside(&square, 0.1);
        assert!(left[0].distance(vec2(0.1, 0.1)) < 1e-5 && left[0].distance(left[4]) < 1e-6);
    }
}
