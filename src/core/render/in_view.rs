//! Whether the camera sees the receiver at all.

use glam::{Vec2, vec2};

use super::camera_sampler::CameraSampler;
use crate::math::rng::{Purpose, Stream};
use crate::scene::{Ray, Scene, SurfaceId};

/// Points along each side of the receiver, and pixels along the longer side of the picture, that are tried.
const POINTS: u32 = 17;
const PIXELS: usize = 96;

/// What the camera sees of the receiver.
#[derive(Clone, Debug, PartialEq)]
pub enum ReceiverView {
    /// Its lit side, perhaps by way of glass or mirrors.
    Seen,
    /// Its back alone, which no light reaches.
    Back,
    /// Nothing: it is beside the picture, or behind the camera.
    Outside,
    /// Nothing: matt meshes stand before it; one of them, by its index.
    Hidden(u16),
}

/// What the camera of a picture of `[width, height]` pixels sees of the receiver: by a few hundred points and, where those are
/// not seen, a few thousand paths.
pub fn receiver_view(scene: &Scene, [width, height]: [usize; 2]) -> ReceiverView {
    let (receiver, camera) = (scene.receiver(), scene.camera());
    let aspect = width as f32 / height.max(1) as f32;
    let (mut is_in_picture, mut before) = (false, None);
    let middle = POINTS / 2;
    let places = (0..POINTS * POINTS).map(|i| {
        // The middle first: it is nearly always in view.
        let [x, y] = [i % POINTS, i / POINTS].map(|k| (k + middle) % POINTS);
        receiver.extent() * (vec2(x as f32, y as f32) + 0.5) / POINTS as f32
    });
    for point in places.map(|place| receiver.world_from_plane(place)) {
        let within = |at: Vec2| at.abs().max_element() <= 1.0;
        let Some(direction) = (point - camera.position).try_normalize() else { continue };
        if !camera.project(point, aspect).is_some_and(within) {
            continue;
        }
        is_in_picture = true;
        match scene.intersect(&Ray::new(camera.position, direction)).map(|hit| hit.surface) {
            Some(SurfaceId::Receiver) if direction.dot(receiver.normal()) < 0.0 => return ReceiverView::Seen,
            Some(surface) => before = scene.mesh_of(surface).or(before),
            None => (),
        }
    }
    if by_any_way(scene, aspect) {
        return ReceiverView::Seen;
    }
    let is_behind = (camera.position - receiver.world_from_plane(Vec2::ZERO)).dot(receiver.normal()) <= 0.0;
    match before {
        _ if !is_in_picture => ReceiverView::Outside,
        _ if is_behind => ReceiverView::Back,
        Some(mesh) => ReceiverView::Hidden(mesh),
        None => ReceiverView::Outside,
    }
}

/// Whether any of a few thousand camera paths reaches the lit side.
fn by_any_way(scene: &Scene, aspect: f32) -> bool {
    let size = (vec2(aspect, 1.0) / aspect.max(1.0) * PIXELS as f32).max(Vec2::ONE);
    let size = [size.x as usize, size.y as usize];
    let sampler = CameraSampler::new(scene, size);
    let mut is_seen = false;
    for pixel in (0..size[0] * size[1]).map(|i| [i % size[0], i / size[0]]) {
        let rng = Stream::new(0, Purpose::Visible, 2, (pixel[1] * size[0] + pixel[0]) as u64);
        sampler.pixel(pixel, 1, rng, &mut |seen| is_seen |= scene.receiver().contains(seen.point));
        if is_seen {
            return true;
        }
    }
    false
}
