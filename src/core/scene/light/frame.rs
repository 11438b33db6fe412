//! Orthonormal frames.

use glam::Vec3;

/// Two unit vectors that complete the unit vector `z` to a right-handed frame (Duff et al. 2017).
pub(super) fn frame(z: Vec3) -> (Vec3, Vec3) {
    z.any_orthonormal_pair()
}
