//! The transform between plane and screen in the plane view.

use egui::{Pos2, Rect, pos2};
use glam::{Vec2, vec2};

use crate::editor::session::{PlaneViewport, ZOOM_RANGE};

/// Margin around the plane at zoom 1, points.
const MARGIN: f32 = 14.0;
/// The transform from plane coordinates to screen points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaneTransform {
    middle: Pos2,
    centre: Vec2,
    /// Points per plane unit.
    scale: f32,
}

impl PlaneTransform {
    /// The transform of a plane of `extent` in the rectangle `view`.
    pub fn new(view: Rect, extent: Vec2, viewport: &PlaneViewport) -> Self {
        let room = (view.size() - egui::Vec2::splat(2.0 * MARGIN)).max(egui::Vec2::splat(16.0));
        let fit = (room.x / extent.x).min(room.y / extent.y);
        let zoom = if viewport.zoom > 0.0 { viewport.zoom } else { 1.0 };
        Self { middle: view.center(), centre: viewport.centre.unwrap_or(extent / 2.0), scale: fit * zoom }
    }

    /// Screen position of a plane point; plane y points up.
    pub fn screen_from_plane(&self, p: Vec2) -> Pos2 {
        let offset = (p - self.centre) * self.scale;
        pos2(self.middle.x + offset.x, self.middle.y - offset.y)
    }

    /// Plane point at a screen position.
    pub fn plane_from_screen(&self, p: Pos2) -> Vec2 {
        self.centre + vec2(p.x - self.middle.x, self.middle.y - p.y) / self.scale
    }

    /// Points per plane unit.
    pub fn scale(&self) -> f32 {
        self.scale
    }

    /// The plane's rectangle on the screen.
    pub fn rect(&self, extent: Vec2) -> Rect {
        Rect::from_two_pos(self.screen_from_plane(Vec2::ZERO), self.screen_from_plane(extent))
    }

    /// The viewport zoomed by `factor` about a fixed screen position.
    pub fn zoomed(&self, viewport: &PlaneViewport, factor: f32, about: Pos2) -> PlaneViewport {
        let old = if viewport.zoom > 0.0 { viewport.zoom } else { 1.0 };
        let zoom = (old * factor).clamp(*ZOOM_RANGE.start(), *ZOOM_RANGE.end());
        let fixed = self.plane_from_screen(about);
        PlaneViewport { centre: Some(fixed + (self.centre - fixed) * (old / zoom)), zoom }
    }

    /// The viewport panned by `by` screen points.
    pub fn panned(&self, viewport: &PlaneViewport, by: egui::Vec2) -> PlaneViewport {
        PlaneViewport { centre: Some(self.centre - vec2(by.x, -by.y) / self.scale), zoom: viewport.zoom }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn view() -> Rect {
        Rect::from_min_size(pos2(100.0, 50.0), egui::vec2(800.0, 600.0))
    }

    #[test]
    fn screen_and_plane_lead_back_to_each_other() {
        let viewport = PlaneViewport { centre: Some(vec2(0.2, 0.7)), zoom: 3.0 };
        let transform = PlaneTransform::new(view(), vec2(1.0, 0.75), &viewport);
        for p in [vec2(0.0, 0.0), vec2(0.3, 0.9), vec2(-2.0, 4.0)] {
            // f32 on a screen of a thousand points.
            assert!(transform.plane_from_screen(transform.screen_from_plane(p)).distance(p) < 1e-5);
        }
    }

    #[test]
    fn zooming_keeps_the_point_under_the_pointer() {
        let viewport = PlaneViewport::default();
        let (extent, at) = (vec2(1.0, 0.5), pos2(320.0, 410.0));
        let transform = PlaneTransform::new(view(), extent, &viewport);
        let closer = PlaneTransform::new(view(), extent, &transform.zoomed(&viewport, 2.5, at));
        assert!(closer.plane_from_screen(at).distance(transform.plane_from_screen(at)) < 1e-5);
        assert!((closer.scale() / transform.scale() - 2.5).abs() < 1e-4);
    }
}
