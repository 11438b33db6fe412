//! The matrices of a camera as OpenEXR defines them: row vectors, left-handed, x right, y up, z along the view.

use glam::{Mat4, Vec4};

use crate::scene::camera::Camera;

/// From the world (m) to the camera's space; row by row, for row vectors.
pub(super) fn world_to_camera(camera: &Camera) -> [f32; 16] {
    // A matrix for column vectors, read column by column, is that for row vectors, read row by row.
    to_camera(camera).to_cols_array()
}

/// From the world (m) to the picture after division by w: (0, 0) is its upper left corner, (1, 1) the lower right one.
pub(super) fn world_to_ndc(camera: &Camera, aspect: f32) -> [f32; 16] {
    let scale = 0.5 / camera.half_height;
    let ndc = Mat4::from_cols(
        Vec4::new(scale / aspect, 0.0, 0.0, 0.0),
        Vec4::new(0.0, -scale, 0.0, 0.0),
        Vec4::new(0.5 - camera.shift.x, 0.5 + camera.shift.y, 1.0, 1.0),
        Vec4::ZERO,
    );
    (ndc * to_camera(camera)).to_cols_array()
}

fn to_camera(camera: &Camera) -> Mat4 {
    let Camera { position, forward, right, up, .. } = *camera;
    let origin = -Vec4::new(position.dot(right), position.dot(up), position.dot(forward), -1.0);
    let axis = |i: usize| Vec4::new(right[i], up[i], forward[i], 0.0);
    Mat4::from_cols(axis(0), axis(1), axis(2), origin)
}
