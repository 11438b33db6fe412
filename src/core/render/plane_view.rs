//! Where points of the plane are seen in the picture, for what is drawn over it.

use glam::{Vec2, vec2};

use super::visible::flat_pixel;
use crate::scene::camera::Camera;
use crate::scene::{Receiver, Scene};

/// Looks at the plane through a scene's camera, or straight on where there is no scene.
#[derive(Clone, Debug)]
pub struct PlaneView(Eye);

#[derive(Clone, Debug)]
enum Eye {
    Camera { camera: Camera, receiver: Receiver },
    Flat { extent: Vec2 },
}

impl PlaneView {
    /// The view of the rendered pictures of a scene, or of a plane of this extent without one.
    pub fn new(scene: Option<&Scene>, extent: Vec2) -> Self {
        Self(match scene {
            Some(scene) => Eye::Camera { camera: *scene.camera(), receiver: scene.receiver().clone() },
            None => Eye::Flat { extent },
        })
    }

    /// The place of a plane point in a picture of `width` x `height` pixels, from its upper left corner; none behind the
    /// camera. Glass and mirrors in between are not seen.
    pub fn pixel_from_plane(&self, point: Vec2, [width, height]: [usize; 2]) -> Option<Vec2> {
        let size = vec2(width as f32, height as f32);
        match &self.0 {
            Eye::Camera { camera, receiver } => {
                let place = camera.project(receiver.world_from_plane(point), size.x / size.y)?;
                Some((vec2(place.x, -place.y) + 1.0) * 0.5 * size)
            }
            Eye::Flat { extent } => {
                let from_centre = (point - *extent * 0.5) / flat_pixel(*extent, size);
                Some(size * 0.5 + vec2(from_centre.x, -from_centre.y))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_flat_view_shows_the_whole_plane_upright_in_the_middle() {
        let view = PlaneView::new(None, vec2(1.0, 0.5));
        // 200 pixels for the longer side, 50 left above and below.
        let at = |x, y| view.pixel_from_plane(vec2(x, y), [200, 200]);
        assert_eq!(at(0.0, 0.5), Some(vec2(0.0, 50.0)));
        assert_eq!(at(1.0, 0.0), Some(vec2(200.0, 150.0)));
    }
}
