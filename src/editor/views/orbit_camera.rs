//! The camera of the orbit view.

use glam::{Vec2, Vec3, vec3};
use lightloom_core::scene::CameraDesc;

use crate::editor::session::Orbit;

/// Rotation per point of a drag, radians.
const TURN: f32 = 0.006;
/// Maximum elevation, radians: just below vertical, where "up" is undefined.
const STEEPEST: f32 = 1.55;
/// Range of the distance (m).
const DISTANCE: [f32; 2] = [0.01, 1e5];

impl Orbit {
    /// The orbit camera at the shot's camera.
    pub fn of(camera: &CameraDesc) -> Self {
        let target = Vec3::from(camera.look_at);
        let from = Vec3::from(camera.position) - target;
        let distance = from.length().clamp(DISTANCE[0], DISTANCE[1]);
        let elevation = (from.y / distance).clamp(-1.0, 1.0).asin().clamp(-STEEPEST, STEEPEST);
        Self { target, azimuth: from.x.atan2(from.z), elevation, distance }
    }

    /// Unit vector from the target to the camera.
    fn outward(&self) -> Vec3 {
        let (sin, cos) = self.elevation.sin_cos();
        vec3(cos * self.azimuth.sin(), sin, cos * self.azimuth.cos())
    }

    /// The camera, with the field of view of the shot.
    pub fn camera(&self, shot: &CameraDesc) -> CameraDesc {
        CameraDesc {
            position: (self.target + self.outward() * self.distance).to_array(),
            look_at: self.target.to_array(),
            up: [0.0, 1.0, 0.0],
            fov_deg: shot.fov_deg,
            shift: [0.0; 2],
        }
    }

    /// Rotated by a drag of `by` screen points, y downwards.
    pub fn turned(self, by: Vec2) -> Self {
        Self {
            azimuth: self.azimuth - by.x * TURN,
            elevation: (self.elevation + by.y * TURN).clamp(-STEEPEST, STEEPEST),
            ..self
        }
    }

    /// Panned by a drag of `by` points in a view `height` points high; the target stays under the pointer.
    pub fn moved(self, by: Vec2, height: f32, fov_deg: f32) -> Self {
        let metres = 2.0 * self.distance * (fov_deg.to_radians() / 2.0).tan() / height.max(1.0);
        let outward = self.outward();
        let right = Vec3::Y.cross(outward).normalize_or_zero();
        let up = outward.cross(right);
        Self { target: self.target + (up * by.y - right * by.x) * metres, ..self }
    }

    /// Zoomed by `factor`.
    pub fn zoomed(self, factor: f32) -> Self {
        Self { distance: (self.distance / factor.max(1e-3)).clamp(DISTANCE[0], DISTANCE[1]), ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_look_begins_where_the_shot_is_taken() {
        let shot = CameraDesc { position: [0.3, 0.9, -1.2], look_at: [0.1, 0.0, 0.2], ..Default::default() };
        let camera = Orbit::of(&shot).camera(&shot);
        let off = Vec3::from(camera.position).distance(Vec3::from(shot.position));
        // f32 through two angles.
        assert!(off < 1e-5, "{off} m off");
    }

    #[test]
    fn the_look_never_turns_over_the_pole() {
        let orbit = Orbit::of(&CameraDesc::default()).turned(Vec2::new(10.0, 1e6));
        assert!(orbit.camera(&CameraDesc::default()).check("camera").is_ok());
    }

    #[test]
    fn moving_keeps_the_distance() {
        let orbit = Orbit::of(&CameraDesc::default());
        let moved = orbit.moved(Vec2::new(40.0, -25.0), 600.0, 40.0);
        assert_eq!(moved.distance, orbit.distance);
        // 47.2 points of 600, at 2 m: 40 degrees show 1.456 m there.
        assert!((moved.target.distance(orbit.target) - 47.17 / 600.0 * 1.456).abs() < 1e-3);
    }
}
