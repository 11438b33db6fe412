//! A pinhole camera with a lens that can be shifted.

use glam::{Vec2, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Ray, check};
use crate::setting::schema::Describe;
use crate::setting::{ANY, Setting, settings};
use crate::{Error, Result};

/// From where the picture is taken, world (m). The image size belongs to the export.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(transform = Describe(Self::SETTINGS))]
pub struct CameraDesc {
    /// Its position (m).
    pub position: [f32; 3],
    /// The point in the middle of the picture, where the lens is not shifted (m).
    pub look_at: [f32; 3],
    /// Upwards in the picture; any length but 0, not along the view.
    pub up: [f32; 3],
    /// Vertical field of view, degrees.
    pub fov_deg: f32,
    /// Lens shift ([`Self::SHIFT`]).
    pub shift: [f32; 2],
}

settings! { CameraDesc {
    /// Position of the camera, x y z; y is up.
    POSITION = Setting::vector("scene.camera.position", [-1e6, 1e6], &[0.0, 1.2, 1.6]).unit("m");
    /// The point in the middle of the picture, where the lens is not shifted.
    LOOK_AT = Setting::vector("scene.camera.look_at", [-1e6, 1e6], &[0.0; 3]).unit("m");
    /// Upwards in the picture; any length but 0, not along the view. Change it only to look straight down, or to tilt.
    UP = Setting::vector("scene.camera.up", ANY, &[0.0, 1.0, 0.0]);
    /// Vertical field of view. Narrow flattens, wide exaggerates.
    FOV = Setting::real("scene.camera.fov_deg", [1.0, 170.0], &[40.0]).unit("°");
    /// Lens shift, shares of the picture's width and height by which the picture lies to the right of what the camera looks
    /// at, and above it. It turns no camera: upright edges stay parallel.
    SHIFT = Setting::vector("scene.camera.shift", [-10.0, 10.0], &[0.0, 0.0]);
} }

impl Default for CameraDesc {
    fn default() -> Self {
        Self {
            position: Self::POSITION.value(),
            look_at: Self::LOOK_AT.value(),
            up: Self::UP.value(),
            fov_deg: Self::FOV.value(),
            shift: Self::SHIFT.value(),
        }
    }
}

impl CameraDesc {
    /// Refuses a camera without a direction or upright.
    pub fn check(&self, place: &str) -> Result<()> {
        self.resolve(place).map(|_| ())
    }

    /// The resolved camera.
    ///
    /// # Errors
    /// `Value` names the first value under `place` that cannot be used.
    pub fn resolve(&self, place: &str) -> Result<Camera> {
        Self::POSITION.check(self.position, place)?;
        Self::LOOK_AT.check(self.look_at, place)?;
        Self::FOV.check(self.fov_deg, place)?;
        Self::SHIFT.check(self.shift, place)?;
        let position = Vec3::from(self.position);
        let view = Vec3::from(self.look_at) - position;
        let forward = view.try_normalize().ok_or_else(|| {
            Error::value(format!("{place}.look_at"), "is where the camera stands: move one of them")
        })?;
        let up = check::direction(place, "up", self.up)?;
        let right = forward.cross(up);
        if right.length() < 1e-4 {
            return Err(Error::value(
                format!("{place}.up"),
                "is along the view, so the picture has no upright; choose another direction, such as (0, 0, -1)",
            ));
        }
        let right = right.normalize();
        let half_height = (self.fov_deg.to_radians() / 2.0).tan();
        let shift = Vec2::from(self.shift);
        Ok(Camera { position, forward, right, up: right.cross(forward), half_height, shift })
    }
}

/// A resolved camera: position and an orthonormal frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// World (m).
    pub position: Vec3,
    /// Unit vector along the view.
    pub forward: Vec3,
    /// Unit vector to the right of the picture.
    pub right: Vec3,
    /// Unit vector to the top of the picture.
    pub up: Vec3,
    /// Tangent of half the vertical field of view.
    pub half_height: f32,
    /// Lens shift, shares of the picture's width and height.
    pub shift: Vec2,
}

impl Camera {
    /// The ray through a point of the picture: `x` from -1 (left) to 1, `y` from -1 (bottom) to 1; `aspect` is width over
    /// height.
    pub fn ray(&self, x: f32, y: f32, aspect: f32) -> Ray {
        let (x, y) = (x + 2.0 * self.shift.x, y + 2.0 * self.shift.y);
        let across = self.right * (x * aspect * self.half_height) + self.up * (y * self.half_height);
        Ray::new(self.position, (self.forward + across).normalize())
    }

    /// The projection of a world point to the picture, in the units of [`Self::ray`]; none behind the camera.
    pub fn project(&self, point: Vec3, aspect: f32) -> Option<Vec2> {
        let offset = point - self.position;
        let depth = offset.dot(self.forward);
        let scale = 1.0 / (depth * self.half_height);
        let unshifted = Vec2::new(offset.dot(self.right) * scale / aspect, offset.dot(self.up) * scale);
        (depth > 0.0).then(|| unshifted - 2.0 * self.shift)
    }
}
