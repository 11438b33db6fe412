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

    /// The view of a receiver through any camera.
    pub fn through(camera: Camera, receiver: Receiver) -> Self {
        Self(Eye::Camera { camera, receiver })
    }

    /// The point of the plane that is seen at a place of a picture of `width` x `height` pixels, counted from its upper
    /// left corner; none where the camera looks past the plane. Glass and mirrors in between are not seen.
    pub fn plane_from_pixel(&self, pixel: Vec2, [width, height]: [usize; 2]) -> Option<Vec2> {
        let size = vec2(width as f32, height as f32);
        match &self.0 {
            Eye::Camera { camera, receiver } => {
                let place = pixel / size * 2.0 - 1.0;
                let ray = camera.ray(place.x, -place.y, size.x / size.y);
                let (normal, corner) = (receiver.normal(), receiver.world_from_plane(Vec2::ZERO));
                let t = (corner - ray.origin).dot(normal) / ray.direction.dot(normal);
                // Written so that NaN is nowhere, too.
                let ahead = t > 0.0 && t.is_finite();
                ahead.then(|| receiver.plane_from_world(ray.origin + ray.direction * t))
            }
            Eye::Flat { extent } => {
                let from_centre = (pixel - size * 0.5) * flat_pixel(*extent, size);
                Some(*extent * 0.5 + vec2(from_centre.x, -from_centre.y))
            }
        }
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
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::scene::{CameraDesc, ReceiverDesc, SceneDesc};

    #[test]
    fn the_flat_view_shows_the_whole_plane_upright_in_the_middle() {
        let view = PlaneView::new(None, vec2(1.0, 0.5));
        // 200 pixels for the longer side, 50 left above and below.
        let at = |x, y| view.pixel_from_plane(vec2(x, y), [200, 200]);
        assert_eq!(at(0.0, 0.5), Some(vec2(0.0, 50.0)));
        assert_eq!(at(1.0, 0.0), Some(vec2(200.0, 150.0)));
    }

    #[test]
    fn a_pixel_leads_back_to_its_plane_point() {
        let camera = CameraDesc { position: [0.3, 0.9, 1.1], ..Default::default() };
        let receiver = ReceiverDesc { size: [2.0, 1.0], rotate: [10.0, 20.0, 0.0], ..Default::default() };
        let scene = SceneDesc { camera, receiver, ..Default::default() };
        let nothing = |_: &str, _: &str| Ok(std::path::PathBuf::new());
        let scene = Scene::load(&scene, &nothing).unwrap().0;
        let extent = scene.receiver().extent();
        for view in [PlaneView::new(None, extent), PlaneView::new(Some(&scene), extent)] {
            for point in [vec2(0.1, 0.2), vec2(0.9, 0.4), vec2(0.5, 0.0)] {
                let pixel = view.pixel_from_plane(point, [300, 200]).unwrap();
                let back = view.plane_from_pixel(pixel, [300, 200]).unwrap();
                // Rounding of a few products of numbers about 1.
                assert!(back.distance(point) < 1e-5, "{point} came back as {back}");
            }
        }
    }
}
