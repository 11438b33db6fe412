//! The overlay of constraints on the pictures of a sheet: antialiased polylines of the plane in the camera's perspective.

use glam::{Vec2, Vec3};
use tiny_skia::{FillRule, Paint, Path, PathBuilder, Pixmap, Stroke, Transform};

use crate::render::image::Image;

/// Screen values of directed lines.
pub const ORANGE: Vec3 = Vec3::new(1.0, 0.58, 0.08);
/// Screen values of walls.
pub const MAGENTA: Vec3 = Vec3::new(0.93, 0.16, 0.78);

/// Least width of a line in the picture, pixels.
const LEAST_WIDTH: f32 = 2.0;
/// Length of an arrow head, relative to the width of its line, and at least in pixels.
const HEAD: (f32, f32) = (4.0, 11.0);
/// Corners of the round cap of a line.
const CORNERS: u32 = 16;
/// Width of the dark rim that sets a line off from bright light, pixels, and its opacity.
const RIM: (f32, f32) = (1.6, 0.55);

/// One polyline on the plane.
#[derive(Clone, Debug, PartialEq)]
pub struct OverlayLine {
    /// Plane coordinates.
    pub points: Vec<Vec2>,
    /// Screen values, such as [`ORANGE`] or [`MAGENTA`].
    pub colour: Vec3,
    /// Thickness in plane units; thin lines are drawn two pixels wide.
    pub width: f32,
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
        let paths: Vec<(&OverlayLine, Path)> =
            self.lines.iter().filter_map(|line| Some((line, self.outline(line)?))).collect();
        if paths.is_empty() {
            return;
        }
        let Some(mut layer) = Pixmap::new(picture.width as u32, picture.height as u32) else { return };
        let mut paint = Paint { anti_alias: true, ..Paint::default() };
        let rim = Stroke { width: 2.0 * RIM.0, ..Stroke::default() };
        for (line, path) in &paths {
            paint.set_color(colour(Vec3::ZERO, RIM.1));
            layer.stroke_path(path, &paint, &rim, Transform::identity(), None);
            paint.set_color(colour(line.colour, 1.0));
            layer.fill_path(path, &paint, FillRule::Winding, Transform::identity(), None);
        }
        for (pixel, over) in picture.pixels.iter_mut().zip(layer.pixels()) {
            let [r, g, b, a] =
                [over.red(), over.green(), over.blue(), over.alpha()].map(|v| f32::from(v) / 255.0);
            // The layer's colours are premultiplied.
            *pixel = *pixel * (1.0 - a) + Vec3::new(r, g, b);
        }
    }

    /// The outline of a line in pixels: a quad for each piece, a disc for each point, a triangle for the head.
    fn outline(&self, line: &OverlayLine) -> Option<Path> {
        let mut path = PathBuilder::new();
        let see = |p: Vec2| (self.pixel_from_plane)(p).filter(|pixel| pixel.is_finite());
        for piece in line.points.windows(2) {
            let Some(across) = (piece[1] - piece[0]).perp().try_normalize() else { continue };
            let (Some(a), Some(b)) = (see(piece[0]), see(piece[1])) else { continue };
            let side = |p: Vec2, pixel: Vec2| self.reach(p, pixel, across, line.width);
            let (at_a, at_b) = (side(piece[0], a), side(piece[1], b));
            polygon(&mut path, &[a + at_a, b + at_b, b - at_b, a - at_a]);
        }
        for &p in &line.points {
            let Some(pixel) = see(p) else { continue };
            let corner = |i: u32| {
                let angle = std::f32::consts::TAU * i as f32 / CORNERS as f32;
                pixel + self.reach(p, pixel, Vec2::from_angle(angle), line.width)
            };
            polygon(&mut path, &(0..CORNERS).map(corner).collect::<Vec<_>>());
        }
        if let (true, [.., before, last]) = (line.arrow, &line.points[..])
            && let (Some(a), Some(b)) = (see(*before), see(*last))
            && let Some(along) = (b - a).try_normalize()
        {
            let half = self.reach(*last, b, (*last - *before).perp(), line.width).length();
            let length = (2.0 * half * HEAD.0).max(HEAD.1);
            let (tip, base) = (b + along * (0.6 * length), b - along * (0.4 * length));
            let side = along.perp() * (0.42 * length);
            polygon(&mut path, &[tip, base + side, base - side]);
        }
        path.finish()
    }

    /// The offset in pixels from a point of the line to its edge in the plane direction `towards`.
    fn reach(&self, point: Vec2, pixel: Vec2, towards: Vec2, width: f32) -> Vec2 {
        // For a line of hardly any width, by a small step aside.
        let step = (0.5 * width).max(1e-4);
        let aside = (self.pixel_from_plane)(point + towards.normalize_or_zero() * step);
        let offset = aside.map_or(Vec2::ZERO, |aside| aside - pixel) * (0.5 * width / step);
        let direction = aside.map_or(towards, |aside| aside - pixel).normalize_or(Vec2::X);
        if offset.length() < 0.5 * LEAST_WIDTH { direction * (0.5 * LEAST_WIDTH) } else { offset }
    }
}

/// Adds a polygon, oriented like all others, so that overlaps add up instead of cancelling.
fn polygon(path: &mut PathBuilder, corners: &[Vec2]) {
    let next = corners.iter().cycle().skip(1);
    let area: f32 = corners.iter().zip(next).map(|(a, b)| a.perp_dot(*b)).sum();
    let turned: Vec<Vec2> =
        if area < 0.0 { corners.iter().rev().copied().collect() } else { corners.to_vec() };
    for (i, p) in turned.iter().enumerate() {
        if i == 0 { path.move_to(p.x, p.y) } else { path.line_to(p.x, p.y) }
    }
    path.close();
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

    fn drawn(line: OverlayLine) -> Image {
        let mut picture = Image::new(100, 100);
        picture.pixels.fill(Vec3::splat(0.5));
        Overlay { lines: &[line], pixel_from_plane: &flat }.draw(&mut picture);
        picture
    }

    fn share(picture: &Image, ink: Vec3) -> f32 {
        picture.pixels.iter().filter(|p| p.distance(ink) < 0.02).count() as f32 / 1e4
    }

    #[test]
    fn a_wall_covers_what_its_thickness_says() {
        let points = vec![vec2(0.2, 0.5), vec2(0.8, 0.5)];
        let picture = drawn(OverlayLine { points, colour: MAGENTA, width: 0.1, arrow: false });
        assert!(picture.at(50, 50).distance(MAGENTA) < 0.01 && picture.at(50, 46).distance(MAGENTA) < 0.01);
        assert_eq!(picture.at(50, 30), Vec3::splat(0.5));
        assert_eq!(picture.at(90, 50), Vec3::splat(0.5));
        // 0.6 x 0.1 and two half discs; the corners of the discs and the soft edge cost 3 % and a row of pixels.
        let area = 0.06 + std::f32::consts::PI * 0.05 * 0.05;
        assert!((share(&picture, MAGENTA) - area).abs() < 0.1 * area, "{}", share(&picture, MAGENTA));
    }

    #[test]
    fn a_line_that_turns_back_has_no_holes() {
        let points = vec![vec2(0.2, 0.5), vec2(0.8, 0.5), vec2(0.2, 0.5), vec2(0.5, 0.9)];
        let picture = drawn(OverlayLine { points, colour: ORANGE, width: 0.08, arrow: true });
        for x in 20..80 {
            assert!(picture.at(x, 50).distance(ORANGE) < 0.01, "a hole at {x}");
        }
    }

    #[test]
    fn a_thin_arrow_is_seen_and_its_head_is_wider() {
        let points = vec![vec2(0.1, 0.5), vec2(0.7, 0.5)];
        let picture = drawn(OverlayLine { points, colour: ORANGE, width: 0.0, arrow: true });
        let height = |x: usize| (0..100).filter(|&y| picture.at(x, y).distance(ORANGE) < 0.3).count();
        assert!((1..=3).contains(&height(40)), "{}", height(40));
        assert!(height(67) >= 6, "{}", height(67));
    }

    #[test]
    fn nothing_drawn_changes_nothing_and_odd_lines_do_not_fail() {
        let through = |points: Vec<Vec2>| OverlayLine { points, colour: ORANGE, width: 0.1, arrow: true };
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
