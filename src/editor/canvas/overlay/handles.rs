//! Handles of the selected constraints.

use egui::{Color32, CornerRadius, Rect, Stroke, StrokeKind, Vec2 as ScreenVec};
use glam::Vec2;

use super::Overlay;
use crate::editor::selection::Selection;
use crate::editor::theme;

/// Side of a handle, points.
const SIDE: f32 = 6.0;
/// Side of a handle with close neighbours, points.
const SMALL: f32 = 3.5;
/// Screen distance below which handles are close, points.
const CLOSE: f32 = 13.0;

impl Overlay<'_> {
    /// A square for each point; individually selected points are filled.
    pub(super) fn handles(&self, points: &[Vec2], constraint: usize, selection: &Selection) {
        let places: Vec<_> = points.iter().map(|&p| (self.screen)(p)).collect();
        let near = |i: usize, other: Option<usize>| {
            let other = other.and_then(|k| *places.get(k)?);
            places[i].zip(other).is_some_and(|(a, b)| a.distance(b) < CLOSE)
        };
        let alone: std::collections::BTreeSet<usize> = selection.points(constraint).collect();
        for (i, place) in places.iter().enumerate() {
            let Some(place) = *place else { continue };
            let chosen = alone.contains(&i);
            let dense = near(i, i.checked_sub(1)) || near(i, Some(i + 1));
            let side = if dense && !chosen { SMALL } else { SIDE };
            let square = Rect::from_center_size(place, ScreenVec::splat(side));
            let (fill, border) =
                if chosen { (theme::ACCENT, Color32::WHITE) } else { (Color32::WHITE, theme::ACCENT) };
            let radius = CornerRadius::same(1);
            self.painter.rect(square, radius, fill, Stroke::new(1.2, border), StrokeKind::Outside);
        }
    }
}
