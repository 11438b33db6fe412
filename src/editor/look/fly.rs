//! Flying a camera: orbit, pan, dolly; and views of an object.

use glam::{Quat, Vec2, Vec3};
use lightloom_core::scene::CameraDesc;

/// Rotation per point of a drag, radians.
const TURN: f32 = 0.006;
/// Least angle between the view and the upright, radians: along it "up" is undefined.
const LEAST: f32 = 0.02;
/// Range of the distance to what the camera looks at (m).
const DISTANCE: [f32; 2] = [0.01, 1e5];

/// The free camera that begins at the shot's: upright, without lens shift.
pub fn free(shot: &CameraDesc) -> CameraDesc {
    let level = CameraDesc { up: [0.0, 1.0, 0.0], shift: [0.0; 2], ..shot.clone() };
    orbited(&level, Vec2::ZERO)
}

/// Orbited about what it looks at by a drag of `by` points, y downwards.
pub fn orbited(camera: &CameraDesc, by: Vec2) -> CameraDesc {
    let target = Vec3::from(camera.look_at);
    let up = Vec3::from(camera.up).normalize_or(Vec3::Y);
    let offset = Vec3::from(camera.position) - target;
    let distance = offset.length().clamp(DISTANCE[0], DISTANCE[1]);
    let outward = offset.normalize_or(Vec3::Z);
    let right = up.cross(outward).try_normalize().unwrap_or_else(|| up.any_orthonormal_vector());
    let ahead = right.cross(up);
    // From the upright downwards.
    let polar = outward.dot(up).clamp(-1.0, 1.0).acos() - by.y * TURN;
    let polar = polar.clamp(LEAST, std::f32::consts::PI - LEAST);
    let tilted = up * polar.cos() + ahead * polar.sin();
    let outward = Quat::from_axis_angle(up, -by.x * TURN) * tilted;
    CameraDesc { position: (target + outward * distance).to_array(), ..camera.clone() }
}

/// Panned by a drag of `by` points in a view `height` points high: what it looks at stays under the pointer.
pub fn panned(camera: &CameraDesc, by: Vec2, height: f32) -> CameraDesc {
    let (position, target) = (Vec3::from(camera.position), Vec3::from(camera.look_at));
    let outward = position - target;
    let metres = 2.0 * outward.length() * (camera.fov_deg.to_radians() / 2.0).tan() / height.max(1.0);
    let right = Vec3::from(camera.up).cross(outward).normalize_or_zero();
    let up = outward.cross(right).normalize_or_zero();
    let by = (up * by.y - right * by.x) * metres;
    CameraDesc { position: (position + by).to_array(), look_at: (target + by).to_array(), ..camera.clone() }
}

/// Nearer by a factor to what it looks at.
pub fn dollied(camera: &CameraDesc, factor: f32) -> CameraDesc {
    let target = Vec3::from(camera.look_at);
    let offset = Vec3::from(camera.position) - target;
    let distance = (offset.length() / factor.max(1e-3)).clamp(DISTANCE[0], DISTANCE[1]);
    let position = target + offset.normalize_or(Vec3::Z) * distance;
    CameraDesc { position: position.to_array(), ..camera.clone() }
}

/// From the same side, so that a sphere around `centre` fills most of the view.
pub fn framed(camera: &CameraDesc, centre: Vec3, radius: f32) -> CameraDesc {
    let outward = Vec3::from(camera.position) - Vec3::from(camera.look_at);
    let distance = 1.3 * radius / (camera.fov_deg.to_radians() / 2.0).sin();
    let position = centre + outward.normalize_or(Vec3::Z) * distance.clamp(DISTANCE[0], DISTANCE[1]);
    CameraDesc { position: position.to_array(), look_at: centre.to_array(), ..camera.clone() }
}

/// The shot's camera moved to a free one; its lens stays.
pub fn aligned(shot: &CameraDesc, free: &CameraDesc) -> CameraDesc {
    CameraDesc { position: free.position, look_at: free.look_at, up: free.up, ..shot.clone() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shot() -> CameraDesc {
        CameraDesc { position: [0.3, 0.9, -1.2], look_at: [0.1, 0.0, 0.2], ..Default::default() }
    }

    fn distance(camera: &CameraDesc) -> f32 {
        Vec3::from(camera.position).distance(camera.look_at.into())
    }

    #[test]
    fn a_free_camera_begins_where_the_shot_is_taken() {
        let off = Vec3::from(free(&shot()).position).distance(shot().position.into());
        // f32 through two angles.
        assert!(off < 1e-5, "{off} m off");
    }

    #[test]
    fn no_camera_turns_over_the_pole_and_none_leaves_its_circle() {
        for up in [[0.0, 1.0, 0.0], [0.0, 0.0, -1.0], [0.2, 1.0, 0.1]] {
            let camera = CameraDesc { up, ..shot() };
            for by in [Vec2::new(10.0, 1e6), Vec2::new(-1e4, -1e6), Vec2::new(31.0, -20.0)] {
                let turned = orbited(&camera, by);
                assert!(turned.check("camera").is_ok(), "{up:?} {by}");
                assert!((distance(&turned) - distance(&camera)).abs() < 1e-5);
            }
        }
        let below = CameraDesc { position: [0.0, 2.0, 0.0], up: [0.0, 0.0, -1.0], ..CameraDesc::default() };
        assert!(free(&below).check("camera").is_ok(), "straight down");
    }

    #[test]
    fn panning_keeps_the_distance_and_moves_by_what_is_under_the_pointer() {
        let camera = CameraDesc { position: [0.0, 1.2, 1.6], look_at: [0.0; 3], ..Default::default() };
        let moved = panned(&camera, Vec2::new(40.0, -25.0), 600.0);
        assert!((distance(&moved) - distance(&camera)).abs() < 1e-6);
        // 47.2 points of 600, at 2 m: 40 degrees show 1.456 m there.
        let by = Vec3::from(moved.look_at).length();
        assert!((by - 47.17 / 600.0 * 1.456).abs() < 1e-3, "{by}");
    }
}
