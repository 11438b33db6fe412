//! Sizes of the pictures of the views: on the screen and in pixels.

use egui::{Pos2, Rect, Ui, Vec2, pos2, vec2};
use glam::Vec3;
use lightloom_core::project::Project;
use lightloom_core::render::Image;

/// Texture coordinates of a whole texture.
pub(super) const WHOLE: Rect = Rect { min: pos2(0.0, 0.0), max: pos2(1.0, 1.0) };

/// Margin around the picture, points.
const MARGIN: f32 = 14.0;
/// Maximum pixels along the longer side: what the processor composites in real time.
const MOST: f32 = 640.0;
/// Pixels by which the longer side grows, so that resizing the window does not restart the work with every pixel.
const STEP: f32 = 16.0;

/// Rectangle of the picture fitted in a view, with the aspect of the rendered frames.
pub(super) fn fitted(view: Rect, project: &Project) -> Rect {
    let (width, height) = (project.render.width.max(1) as f32, project.render.height.max(1) as f32);
    let room = (view.size() - vec2(2.0 * MARGIN, 2.0 * MARGIN)).max(vec2(16.0, 16.0));
    let scale = (room.x / width).min(room.y / height);
    Rect::from_center_size(view.center(), vec2(width, height) * scale)
}

/// Size in pixels of the picture that the workers make for a view.
pub(super) fn size(ui: &Ui, view: Rect, project: &Project) -> [u32; 2] {
    in_steps(fitted(view, project).size() * ui.pixels_per_point())
}

/// A size of at most the most pixels and of the same shape, whose longer side is a multiple of [`STEP`].
fn in_steps(size: Vec2) -> [u32; 2] {
    let longer = size.max_elem();
    let pixels = ((longer.min(MOST) / STEP).round() * STEP).max(STEP);
    // The shape stays: what is drawn over the picture must lie where its light does.
    [size.x, size.y].map(|side| (side / longer * pixels).round().max(1.0) as u32)
}

/// The colour of a picture that is shown in `frame`, under a screen position; none beside it.
pub(super) fn under(at: Pos2, frame: Rect, image: &Image) -> Option<Vec3> {
    let share = (at - frame.min) / frame.size();
    let inside = |share: f32| (0.0..1.0).contains(&share);
    (inside(share.x) && inside(share.y)).then(|| {
        let cell = |share: f32, count: usize| ((share * count as f32) as usize).min(count.saturating_sub(1));
        image.at(cell(share.x, image.width), cell(share.y, image.height))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_has_the_shape_of_its_frame() {
        for (width, height) in
            [(503.0, 283.0), (410.0, 230.0), (300.0, 600.0), (1999.0, 1124.0), (90.0, 30.0)]
        {
            let [x, y] = in_steps(vec2(width, height)).map(|side| side as f32);
            // The shorter side is rounded to a pixel.
            let shorter = x.max(y) * (width.min(height) / width.max(height));
            assert!((x.min(y) - shorter).abs() <= 0.5, "{width} x {height} is shown as {x} x {y}");
            assert!(x.max(y) <= MOST && x.max(y) % STEP == 0.0);
        }
    }

    #[test]
    fn the_pixel_under_the_pointer_is_that_of_the_picture_wherever_it_is_shown() {
        let mut image = Image::new(4, 2);
        image.pixels[5] = Vec3::ONE;
        let frame = Rect::from_min_size(pos2(100.0, 50.0), vec2(400.0, 200.0));
        assert_eq!(under(pos2(210.0, 160.0), frame, &image), Some(Vec3::ONE));
        assert_eq!(under(pos2(310.0, 160.0), frame, &image), Some(Vec3::ZERO));
        assert_eq!(under(pos2(99.0, 160.0), frame, &image), None);
        assert_eq!(under(pos2(500.0, 160.0), frame, &image), None);
    }
}
