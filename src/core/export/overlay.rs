//! The overlay of constraints on the pictures of a sheet: thin antialiased polylines of the plane in the camera's
//! perspective.

use glam::{Vec2, Vec3};
use tiny_skia::{FillRule, LineCap, LineJoin, Paint, Path, PathBuilder, Pixmap, Stroke, Transform};

use crate::render::image::Image;

/// Screen values of directed lines.
pub const ORANGE: Vec3 = Vec3::new(1.0, 0.58, 0.08);
/// Screen values of walls.
pub const MAGENTA: Vec3 = Vec3::new(0.93, 0.16, 0.78);

/// Width of a line in the picture, pixels: it marks the place and leaves the light to be seen.
const WIDTH: f32 = 1.5;
/// Length of an arrow head, and half its width, pixels.
const HEAD: (f32, f32) = (9.0, 3.5);
/// Width of the dark rim that sets a line off from bright light, pixels, and its opacity.
const RIM: (f32, f32) = (1.0, 0.5);

/// One polyline on the plane.
#[derive(Clone, Debug, PartialEq)]
pub struct OverlayLine {
    /// Plane coordinates.
    pub points: Vec<Vec2>,
    /// Screen values, such as [`ORANGE`] or [`MAGENTA`].
    pub colour: Vec3,
    /// Whether its end has an arrow head.
    pub arrow: bool,
}

/// Lines with the projection of plane points to the picture.
#[derive(Clone, Copy)]
pub struct Overlay<'a> {
    /// The lines, in drawing order.
    pub lines: &'a [OverlayLine],
    /// The pixel (from the upper left corner) of a plane point; none behind the camera.
    pub pixel_from_plane: &'a dyn Fn(Vec2) -> Option<Vec2>,
}

impl Overlay<'_> {
    /// No lines.
    pub const NONE: Overlay<'static> = Overlay { lines: &[], pixel_from_plane: &|_| None };

    /// Draws the lines over a picture of screen values.
    pub fn draw(&self, picture: &mut Image) {
        if self.lines.is_empty() {
            return;
        }
        let Some(mut layer) = Pixmap::new(picture.width as u32, picture.height as u32) else { return };
        let mut paint = Paint { anti_alias: true, ..Paint::default() };
        for line in self.lines {
            let (path, head) = self.outline(line);
            let mut stroke = |width: f32, ink: tiny_skia::Color| {
                paint.set_color(ink);
                let (line_cap, line_join) = (LineCap::Round, LineJoin::Round);
                let stroke = Stroke { width, line_cap, line_join, ..Stroke::default() };
                if let Some(path) = &path {
                    layer.stroke_path(path, &paint, &stroke, Transform::identity(), None);
                }
                if let Some(head) = &head {
                    layer.fill_path(head, &paint, FillRule::Winding, Transform::identity(), None);
                }
            };
            stroke(WIDTH + 2.0 * RIM.0, colour(Vec3::ZERO, RIM.1));
            stroke(WIDTH, colour(line.colour, 1.0));
        }
        for (pixel, over) in picture.pixels.iter_mut().zip(layer.pixels()) {
            let [r, g, b, a] =
                [over.red(), over.green(), over.blue(), over.alpha()].map(|v| f32::from(v) / 255.0);
            // The layer's colours are premultiplied.
            *pixel = *pixel * (1.0 - a) + Vec3::new(r, g, b);
        }
    }

    /// The middle of a line in pixels, broken where it is behind the camera, and its arrow head.
    fn outline(&self, line: &OverlayLine) -> (Option<Path>, Option<Path>) {
        let see = |p: &Vec2| (self.pixel_from_plane)(*p).filter(|pixel| pixel.is_finite());
        let seen: Vec<Option<Vec2>> = line.points.iter().map(see).collect();
        let mut path = PathBuilder::new();
        let mut before = None;
        for point in &seen {
            match (before, point) {
                (Some(_), Some(p)) => path.line_to(p.x, p.y),
                (None, Some(p)) => path.move_to(p.x, p.y),
                (_, None) => {}
            }
            before = *point;
        }
        let head = match &seen[..] {
            [.., Some(a), Some(b)] if line.arrow => head(*a, *b),
            _ => None,
        };
        (path.finish(), head)
    }
}

/// The arrow head at `end` of a piece from `start`.
fn head(start: Vec2, end: Vec2) -> Option<Path> {
    let along = (end - start).try_normalize()?;
    let (base, side) = (end - along * HEAD.0, along.perp() * HEAD.1);
    let mut path = PathBuilder::new();
    path.move_to(end.x, end.y);
    [base + side, base - side].iter().for_each(|p| path.line_to(p.x, p.y));
    path.close();
    path.finish()
}

fn colour(screen: Vec3, cover: f32) -> tiny_skia::Color {
    let [r, g, b] = screen.clamp(Vec3::ZERO, Vec3::ONE).to_array();
    tiny_skia::Color::from_rgba(r, g, b, cover).unwrap_or(tiny_skia::Color::BLACK)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::vec2;

    /// A plane of 1 x 1 on 100 x 100 pixels, y up.
    fn flat(p: Vec2) -> Option<Vec2> {
        Some(vec2(p.x, 1.0 - p.y) * 100.0)
    }

    #[test]
    fn a_thin_arrow_is_seen_and_its_head_is_wider() {
        let mut picture = Image::new(100, 100);
        picture.pixels.fill(Vec3::splat(0.5));
        let line = OverlayLine { points: vec![vec2(0.1, 0.5), vec2(0.7, 0.5)], colour: ORANGE, arrow: true };
        Overlay { lines: &[line], pixel_from_plane: &flat }.draw(&mut picture);
        let changed = |x: usize| (0..100).filter(|&y| picture.at(x, y) != Vec3::splat(0.5)).count();
        let orange = |x: usize| (0..100).filter(|&y| picture.at(x, y).distance(ORANGE) < 0.5).count();
        // 1.5 pixels and a rim of one on each side, over the edges of two rows.
        assert!((1..=2).contains(&orange(40)) && changed(40) <= 4, "{} {}", orange(40), changed(40));
        assert!(orange(62) >= 5, "{}", orange(62));
        assert_eq!(changed(90), 0);
    }

    #[test]
    fn nothing_drawn_changes_nothing_and_odd_lines_do_not_fail() {
        let through = |points: Vec<Vec2>| OverlayLine { points, colour: ORANGE, arrow: true };
        let lines = [
            through(Vec::new()),
            through(vec![Vec2::ONE; 3]),
            through(vec![vec2(f32::NAN, 0.0), Vec2::ZERO]),
            through(vec![Vec2::splat(-1e30), Vec2::splat(1e30)]),
        ];
        let mut picture = Image::new(30, 20);
        Overlay::NONE.draw(&mut picture);
        assert_eq!(picture, Image::new(30, 20));
        for line in lines {
            let see = |p: Vec2| (p.x < 0.9).then_some(p);
            Overlay { lines: &[line], pixel_from_plane: &see }.draw(&mut picture);
            assert!(picture.pixels.iter().all(|p| p.is_finite()));
        }
    }
}
