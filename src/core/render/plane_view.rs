//! The projection of plane points to the picture, for overlays.

use glam::{Vec2, vec2};

use super::gather_matrix::flat_pixel;
use crate::Result;
use crate::scene::camera::Camera;
use crate::scene::{Receiver, Scene, SceneDesc};

/// The projection of the plane through a camera, or straight on without a scene.
#[derive(Clone, Debug)]
pub struct PlaneView(Projection);

#[derive(Clone, Debug)]
enum Projection {
    Camera { camera: Camera, receiver: Receiver },
    Flat { extent: Vec2 },
}

impl PlaneView {
    /// The view of the rendered pictures: through the scene's camera, or straight on at a plane of `extent`.
    pub fn new(scene: Option<&Scene>, extent: Vec2) -> Self {
        Self(match scene {
            Some(scene) => Projection::Camera { camera: *scene.camera(), receiver: scene.receiver().clone() },
            None => Projection::Flat { extent },
        })
    }

    /// As [`Self::new`] from a scene's description, before its files are loaded.
    ///
    /// # Errors
    /// A camera without a direction, a receiver without size.
    pub fn of_desc(scene: Option<&SceneDesc>, extent: Vec2) -> Result<Self> {
        let Some(scene) = scene else { return Ok(Self(Projection::Flat { extent })) };
        let (camera, receiver) = scene.camera_and_receiver()?;
        Ok(Self(Projection::Camera { camera, receiver }))
    }

    /// The view of a receiver through any camera.
    pub fn through(camera: Camera, receiver: Receiver) -> Self {
        Self(Projection::Camera { camera, receiver })
    }

    /// The pixel of a plane point, from the upper left corner of a picture of `width` x `height`; none behind the camera.
    /// Ignores glass and mirrors in between.
    pub fn pixel_from_plane(&self, point: Vec2, [width, height]: [usize; 2]) -> Option<Vec2> {
        let size = vec2(width as f32, height as f32);
        match &self.0 {
            Projection::Camera { camera, receiver } => {
                let place = camera.project(receiver.world_from_plane(point), size.x / size.y)?;
                Some((vec2(place.x, -place.y) + 1.0) * 0.5 * size)
            }
            Projection::Flat { extent } => {
                let from_centre = (point - *extent * 0.5) / flat_pixel(*extent, size);
                Some(size * 0.5 + vec2(from_centre.x, -from_centre.y))
            }
        }
    }

    /// The plane point at `pixel` of a picture of `width` x `height`, also beyond the receiver; none where the ray misses the
    /// plane.
    pub fn plane_from_pixel(&self, pixel: Vec2, [width, height]: [usize; 2]) -> Option<Vec2> {
        let size = vec2(width as f32, height as f32);
        match &self.0 {
            Projection::Camera { camera, receiver } => {
                let place = pixel / size * 2.0 - 1.0;
                receiver.plane_from_ray(&camera.ray(place.x, -place.y, size.x / size.y))
            }
            Projection::Flat { extent } => {
                let from_centre = (pixel - size * 0.5) * flat_pixel(*extent, size);
                Some(*extent * 0.5 + vec2(from_centre.x, -from_centre.y))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::scene::ReceiverDesc;

    #[test]
    fn pixel_and_plane_lead_back_to_each_other() {
        let scene = SceneDesc {
            receiver: ReceiverDesc { size: [1.2, 0.7], rotate: [10.0, 30.0, 0.0], ..Default::default() },
            ..Default::default()
        };
        for view in [
            PlaneView::of_desc(Some(&scene), scene.receiver.extent()).unwrap(),
            PlaneView::new(None, Vec2::ONE),
        ] {
            for point in [vec2(0.1, 0.2), vec2(0.9, 0.5), vec2(0.4, 0.0)] {
                let pixel = view.pixel_from_plane(point, [640, 360]).unwrap();
                let back = view.plane_from_pixel(pixel, [640, 360]).unwrap();
                // f32 in a picture of 640 pixels.
                assert!(back.distance(point) < 1e-5, "{point} became {back}");
            }
        }
    }

    #[test]
    fn the_flat_view_shows_the_whole_plane_upright_in_the_middle() {
        let view = PlaneView::new(None, vec2(1.0, 0.5));
        // 200 pixels for the longer side, 50 left above and below.
        let at = |x, y| view.pixel_from_plane(vec2(x, y), [200, 200]);
        assert_eq!(at(0.0, 0.5), Some(vec2(0.0, 50.0)));
        assert_eq!(at(1.0, 0.0), Some(vec2(200.0, 150.0)));
    }
}
