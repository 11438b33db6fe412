//! Overlays of the flow: arrows, moving streamlines, trails, grid, and the followed photon.

use egui::{Color32, Pos2, Shape, Stroke};
use glam::{Vec2, vec2};

use super::{Overlay, colours};
use crate::editor::preview::{FlowPicture, Followed};
use crate::editor::theme;

/// Maximum length of an arrow over the arrow spacing.
const ARROW: f32 = 0.86;
/// Arrows slower than this fraction of the full colour's speed are dots.
const STILL: f32 = 0.02;
/// The colour of trails.
const TRAIL: Color32 = Color32::from_rgb(190, 235, 205);
/// Number of glowing points of a streamline.
const COMET: f32 = 9.0;
/// The colour of its glow; its length shows the speed.
const STREAM: Color32 = Color32::from_rgb(150, 225, 255);
/// Seconds in which the glow traverses a streamline.
const RUN: f64 = 2.4;

impl Overlay<'_> {
    /// The grid of the field; only every n-th line where cells are small on the screen.
    pub(super) fn grid(&self, cells: [u32; 2], extent: Vec2) {
        let Some(scale) = self.scale(extent / 2.0) else { return };
        let count = vec2(cells[0] as f32, cells[1] as f32);
        let size = (extent / count).min_element() * scale;
        let every =
            if size > 0.0 { (6.0 / size).log2().ceil().clamp(0.0, 10.0).exp2() as u32 } else { return };
        let thin = Stroke::new(1.0, Color32::from_white_alpha(26));
        let thick = Stroke::new(1.0, Color32::from_white_alpha(54));
        let stroke = |i: u32| if i.is_multiple_of(8 * every) { thick } else { thin };
        for i in (0..=cells[0]).step_by(every as usize) {
            let x = i as f32 / count.x * extent.x;
            self.polyline(&[vec2(x, 0.0), vec2(x, extent.y)], stroke(i), false);
        }
        for i in (0..=cells[1]).step_by(every as usize) {
            let y = i as f32 / count.y * extent.y;
            self.polyline(&[vec2(0.0, y), vec2(extent.x, y)], stroke(i), false);
        }
    }

    /// Arrows, streamlines and trails; `time` in seconds moves the streamlines.
    pub(super) fn flow(&self, flow: &FlowPicture, time: f64) {
        self.arrows(&flow.arrows, flow.fast);
        for (i, stream) in flow.streamlines.iter().enumerate() {
            self.comet(stream, (time / RUN + 0.618 * i as f64).fract() as f32);
        }
        for trail in &flow.trails {
            self.polyline(trail, Stroke::new(2.4, Color32::from_black_alpha(70)), false);
            self.polyline(trail, Stroke::new(1.0, TRAIL.gamma_multiply(0.5)), false);
            if let Some(end) = trail.last().and_then(|&p| (self.screen)(p)) {
                self.painter.circle(end, 1.8, TRAIL, Stroke::new(0.8, Color32::from_black_alpha(120)));
            }
        }
    }

    fn arrows(&self, arrows: &[(Vec2, Vec2)], fast: f32) {
        let [(first, _), (second, _), ..] = arrows else { return };
        let spacing = first.distance(*second);
        if fast <= 0.0 {
            return;
        }
        for &(p, u) in arrows {
            let speed = (u.length() / fast).min(1.0);
            let colour = colours::speed(speed);
            if speed < STILL {
                if let Some(at) = (self.screen)(p) {
                    self.painter.circle_filled(at, 1.0, colour);
                }
                continue;
            }
            // Slow ones are drawn longer: their direction matters.
            let half = u.normalize_or_zero() * (0.5 * ARROW * spacing * speed.sqrt());
            if let Some((from, to)) = (self.screen)(p - half).zip((self.screen)(p + half)) {
                self.arrow(from, to, colour);
            }
        }
    }

    fn arrow(&self, from: Pos2, to: Pos2, colour: Color32) {
        let way = (to - from).normalized();
        let head = (0.45 * from.distance(to)).clamp(3.0, 7.0);
        let (back, side) = (to - way * head, way.rot90() * (0.42 * head));
        let rim = Color32::from_black_alpha(110);
        self.painter.line_segment([from, back], Stroke::new(3.0, rim));
        self.painter.line_segment([from, back], Stroke::new(1.6, colour));
        let corners = vec![to, back + side, back - side];
        self.painter.add(Shape::convex_polygon(corners, colour, Stroke::new(0.8, rim)));
    }

    /// A glow along a streamline; 0 and 1 are its start and end.
    fn comet(&self, stream: &[Vec2], share: f32) {
        let head = share * (stream.len() as f32 + COMET);
        for (i, piece) in stream.windows(2).enumerate() {
            let behind = head - i as f32;
            if !(0.0..COMET).contains(&behind) {
                continue;
            }
            let Some((a, b)) = (self.screen)(piece[0]).zip((self.screen)(piece[1])) else { continue };
            let alpha = 1.0 - behind / COMET;
            self.painter.line_segment(
                [a, b],
                Stroke::new(2.2 + alpha, Color32::from_black_alpha(90).gamma_multiply(alpha)),
            );
            self.painter.line_segment([a, b], Stroke::new(0.8 + alpha, STREAM.gamma_multiply(alpha)));
        }
    }

    /// The followed photon: its path over all frames, its target, and the path there around walls.
    pub(super) fn followed(&self, photon: &Followed) {
        let dark = Stroke::new(4.0, Color32::from_black_alpha(130));
        self.polyline(&photon.trajectory, dark, false);
        self.polyline(&photon.trajectory, Stroke::new(1.8, Color32::WHITE), false);
        self.polyline(&photon.path_around_walls, dark, false);
        self.polyline(&photon.path_around_walls, Stroke::new(1.8, theme::TARGET), true);
        let corners = photon.path_around_walls.iter().skip(1).rev().skip(1);
        for corner in corners.filter_map(|&p| (self.screen)(p)) {
            self.painter.circle_filled(corner, 2.5, theme::TARGET);
        }
        if let Some(at) = (self.screen)(photon.target) {
            for (radius, stroke) in [(8.0, dark), (8.0, Stroke::new(1.8, theme::TARGET))] {
                self.painter.circle_stroke(at, radius, stroke);
            }
            self.painter.circle_filled(at, 2.5, theme::TARGET);
        }
        if let Some(at) = (self.screen)(photon.at) {
            self.painter.circle(at, 5.0, Color32::WHITE, Stroke::new(2.0, Color32::BLACK));
        }
    }
}
