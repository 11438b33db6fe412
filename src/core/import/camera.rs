//! The camera that is made where a file has none: it sees the glass and its light, from the front and above.

use glam::{Vec3, vec3};

use super::draft::Bounds;
use crate::scene::{CameraDesc, ReceiverDesc};

/// From what it looks at to the camera.
const TOWARDS: Vec3 = vec3(0.12, 0.58, 1.0);
/// Vertical field of view, degrees.
const VIEW: f32 = 30.0;
/// Share of the receiver's half diagonal that shall be seen across the height of the picture.
const SEEN: f32 = 0.52;

pub(super) fn framing(glass: &Bounds, receiver: &ReceiverDesc) -> CameraDesc {
    let table = Vec3::from(receiver.centre);
    let reach = SEEN * receiver.size[0].hypot(receiver.size[1]) / 2.0;
    let middle = table.lerp(glass.centre(), 0.4);
    let radius = reach.max(middle.distance(glass.centre()) + glass.radius());
    let distance = radius / (VIEW / 2.0).to_radians().tan();
    let position = middle + TOWARDS.normalize() * distance;
    let clamp = |point: Vec3| point.to_array().map(|n| CameraDesc::POSITION.clamped(n));
    CameraDesc { position: clamp(position), look_at: clamp(middle), fov_deg: VIEW, ..CameraDesc::default() }
}
