//! Text on pictures: antialiased outlines of Ubuntu Light, which comes with a crate.

use std::sync::LazyLock;

use ab_glyph::{Font as _, FontRef, PxScale, ScaleFont as _, point};
use glam::Vec3;

use crate::render::image::Image;

static FONT: LazyLock<Option<FontRef<'static>>> =
    LazyLock::new(|| FontRef::try_from_slice(epaint_default_fonts::UBUNTU_LIGHT).ok());

/// Draws `text` in `ink` (screen values) with the upper left corner of its line at (`left`, `top`) pixels, clipped to the
/// picture; `size` is the line height in pixels. Returns the x position after the text.
pub(super) fn draw(picture: &mut Image, text: &str, [left, top]: [f32; 2], size: f32, ink: Vec3) -> f32 {
    let Some(font) = FONT.as_ref() else { return left };
    let scaled = font.as_scaled(PxScale::from(size));
    let (mut x, mut before) = (left, None);
    for letter in text.chars() {
        let id = font.glyph_id(letter);
        x += before.map_or(0.0, |before| scaled.kern(before, id));
        let glyph = id.with_scale_and_position(size, point(x, top + scaled.ascent()));
        if let Some(outline) = font.outline_glyph(glyph) {
            let corner = outline.px_bounds().min;
            outline.draw(|dx, dy, cover| {
                // Negative numbers come out as 0, and `put` leaves out what lies beyond the other sides.
                let (px, py) = (corner.x + dx as f32, corner.y + dy as f32);
                if px >= 0.0 && py >= 0.0 {
                    put(picture, px as usize, py as usize, ink, cover);
                }
            });
        }
        x += scaled.h_advance(id);
        before = Some(id);
    }
    x
}

fn put(picture: &mut Image, x: usize, y: usize, ink: Vec3, cover: f32) {
    if x < picture.width && y < picture.height {
        let pixel = &mut picture.pixels[y * picture.width + x];
        *pixel = pixel.lerp(ink, cover.clamp(0.0, 1.0));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_leaves_ink_inside_its_line_and_goes_on_to_the_right() {
        let mut page = Image::new(120, 40);
        let end = draw(&mut page, "Frame 12", [10.0, 8.0], 24.0, Vec3::ONE);
        let inked: Vec<(usize, usize)> = (0..page.pixels.len())
            .filter(|&i| page.pixels[i].x > 0.5)
            .map(|i| (i % page.width, i / page.width))
            .collect();
        assert!(inked.len() > 60, "{} pixels", inked.len());
        assert!(inked.iter().all(|&(x, y)| x >= 9 && (x as f32) < end && (8..32).contains(&y)));
        assert!(page.pixels.iter().any(|p| p.x > 0.0 && p.x < 1.0), "edges are soft");
    }

    #[test]
    fn text_beside_the_picture_is_left_out() {
        let mut page = Image::new(20, 10);
        draw(&mut page, "long beyond any page", [-30.0, -5.0], 24.0, Vec3::ONE);
        assert!(page.pixels.iter().all(|p| p.is_finite()));
    }
}
