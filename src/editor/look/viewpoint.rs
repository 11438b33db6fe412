//! A camera and the rectangle of the screen that shows what it sees.

use egui::{Pos2, Rect, pos2, vec2};
use glam::Vec3;
use lightloom_core::scene::camera::Camera;
use lightloom_core::scene::{CameraDesc, Ray};

/// What is nearer to the camera than this is not drawn (m).
const NEAR: f32 = 1e-3;

/// A camera, and where on the screen its picture is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Viewpoint {
    /// The camera.
    pub camera: Camera,
    /// Its picture on the screen.
    pub place: Rect,
}

impl Viewpoint {
    /// The view of a camera; none where it has no direction.
    pub fn new(camera: &CameraDesc, place: Rect) -> Option<Self> {
        Some(Self { camera: camera.resolve("camera").ok()?, place })
    }

    fn aspect(&self) -> f32 {
        self.place.width() / self.place.height().max(1.0)
    }

    /// The ray through a point of the screen.
    pub fn ray(&self, at: Pos2) -> Ray {
        let at = (at - self.place.center()) / (self.place.size() / 2.0);
        self.camera.ray(at.x, -at.y, self.aspect())
    }

    /// The point of the screen at which a point of the scene is seen; none behind the camera.
    pub fn screen(&self, point: Vec3) -> Option<Pos2> {
        let at = self.camera.project(point, self.aspect())?;
        let half = self.place.size() / 2.0;
        Some(self.place.center() + vec2(at.x * half.x, -at.y * half.y))
    }

    /// A line of the scene on the screen, without what lies behind the camera.
    pub fn segment(&self, a: Vec3, b: Vec3) -> Option<[Pos2; 2]> {
        let depth = |point: Vec3| (point - self.camera.position).dot(self.camera.forward) - NEAR;
        let (from, to) = (depth(a), depth(b));
        if from < 0.0 && to < 0.0 {
            return None;
        }
        let middle = || a + (b - a) * (from / (from - to));
        let (a, b) = (if from < 0.0 { middle() } else { a }, if to < 0.0 { middle() } else { b });
        Some([self.screen(a)?, self.screen(b)?])
    }

    /// Metres that one point of the screen covers at a point of the scene.
    pub fn metres_per_point(&self, point: Vec3) -> f32 {
        let depth = (point - self.camera.position).dot(self.camera.forward).max(NEAR);
        2.0 * depth * self.camera.half_height / self.place.height().max(1.0)
    }

    /// Where the ray through a point of the screen meets a plane; none where it does not.
    pub fn on_plane(&self, at: Pos2, through: Vec3, normal: Vec3) -> Option<Vec3> {
        let ray = self.ray(at);
        let t = (through - ray.origin).dot(normal) / ray.direction.dot(normal);
        (t > 0.0 && t.is_finite()).then(|| ray.origin + ray.direction * t)
    }

    /// Place along a line, from `through` in units of the unit vector `axis`, that is nearest to the ray through a point of
    /// the screen; none where the two are nearly parallel.
    pub fn along(&self, at: Pos2, through: Vec3, axis: Vec3) -> Option<f32> {
        let ray = self.ray(at);
        let from = through - ray.origin;
        let cosine = axis.dot(ray.direction);
        let sine2 = 1.0 - cosine * cosine;
        (sine2 > 0.01).then(|| (cosine * ray.direction.dot(from) - axis.dot(from)) / sine2)
    }
}

/// The largest rectangle of an aspect in the middle of another.
pub fn fitted(view: Rect, [width, height]: [f32; 2]) -> Rect {
    let scale = (view.width() / width.max(1.0)).min(view.height() / height.max(1.0));
    let size = vec2(width * scale, height * scale);
    let corner = view.center() - size / 2.0;
    Rect::from_min_size(pos2(corner.x, corner.y), size)
}
