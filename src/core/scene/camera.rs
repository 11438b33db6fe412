//! A pinhole camera.

use glam::Vec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Ray, check};
use crate::{Error, Result};

/// From where the picture is taken, world [m]. The image size belongs to the export.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct CameraDesc {
    /// Where it stands [m]. Default (0, 1.2, 1.6).
    pub position: [f32; 3],
    /// The point in the middle of the picture [m]. Default the origin.
    pub look_at: [f32; 3],
    /// What is up in the picture; not along the view. Default (0, 1, 0).
    pub up: [f32; 3],
    /// Vertical field of view in degrees, 1 to 170. Default 40.
    pub fov_deg: f32,
}

impl Default for CameraDesc {
    fn default() -> Self {
        Self { position: [0.0, 1.2, 1.6], look_at: [0.0; 3], up: [0.0, 1.0, 0.0], fov_deg: 40.0 }
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
        check::within(place, "position", &self.position, -1e6, 1e6)?;
        check::within(place, "look_at", &self.look_at, -1e6, 1e6)?;
        check::within(place, "fov_deg", &[self.fov_deg], 1.0, 170.0)?;
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
        Ok(Camera { position, forward, right, up: right.cross(forward), half_height })
    }
}

/// A resolved camera: position and an orthonormal frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// World [m].
    pub position: Vec3,
    /// Unit vector along the view.
    pub forward: Vec3,
    /// Unit vector to the right of the picture.
    pub right: Vec3,
    /// Unit vector to the top of the picture.
    pub up: Vec3,
    /// Tangent of half the vertical field of view.
    pub half_height: f32,
}

impl Camera {
    /// The ray through a point of the picture: `x` from -1 (left) to 1, `y` from -1 (bottom) to 1; `aspect` is width over
    /// height.
    pub fn ray(&self, x: f32, y: f32, aspect: f32) -> Ray {
        let across = self.right * (x * aspect * self.half_height) + self.up * (y * self.half_height);
        Ray::new(self.position, (self.forward + across).normalize())
    }

    /// The projection of a world point to the picture, in the units of [`Self::ray`]; none behind the camera.
    pub fn project(&self, point: Vec3, aspect: f32) -> Option<glam::Vec2> {
        let offset = point - self.position;
        let depth = offset.dot(self.forward);
        let scale = 1.0 / (depth * self.half_height);
        (depth > 0.0)
            .then(|| glam::vec2(offset.dot(self.right) * scale / aspect, offset.dot(self.up) * scale))
    }
}
