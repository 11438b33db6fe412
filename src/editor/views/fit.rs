//! Sizes of the pictures of the views: on the screen and in pixels.

use egui::{Rect, Ui, pos2, vec2};
use lightloom_core::project::Project;

/// Texture coordinates of a whole texture.
pub(super) const WHOLE: Rect = Rect { min: pos2(0.0, 0.0), max: pos2(1.0, 1.0) };

/// Margin around the picture, points.
const MARGIN: f32 = 14.0;
/// Maximum pixels along the longer side: what the processor composites in real time.
const MOST: f32 = 640.0;

/// Rectangle of the picture fitted in a view, with the aspect of the rendered frames.
pub(super) fn fitted(view: Rect, project: &Project) -> Rect {
    let (width, height) = (project.render.width.max(1) as f32, project.render.height.max(1) as f32);
    let room = (view.size() - vec2(2.0 * MARGIN, 2.0 * MARGIN)).max(vec2(16.0, 16.0));
    let scale = (room.x / width).min(room.y / height);
    Rect::from_center_size(view.center(), vec2(width, height) * scale)
}

/// Size in pixels of the picture that the workers make for a view.
pub(super) fn size(ui: &Ui, view: Rect, project: &Project) -> [u32; 2] {
    let frame = fitted(view, project).size() * ui.pixels_per_point();
    let shrink = (MOST / frame.max_elem()).min(1.0);
    // In steps, so that resizing the window does not restart the work with every pixel.
    [frame.x, frame.y].map(|n| ((n * shrink / 16.0).round() * 16.0).max(16.0) as u32)
}
