//! Checks of directions and of counts.

use glam::Vec3;

use crate::{Error, Result};

/// Most meshes, and most lights: photons index them by 16 bits.
const MAX_OBJECTS: usize = u16::MAX as usize;

/// A direction: finite and not of length zero; normalized.
pub(super) fn direction(place: &str, field: &str, value: [f32; 3]) -> Result<Vec3> {
    if !value.iter().all(|component| component.is_finite()) {
        return Err(Error::value(format!("{place}.{field}"), "must be a finite number"));
    }
    let v = glam::DVec3::new(value[0].into(), value[1].into(), value[2].into()).normalize_or_zero().as_vec3();
    if v == Vec3::ZERO {
        return Err(Error::value(format!("{place}.{field}"), "has length zero, so it points nowhere"));
    }
    Ok(v)
}

/// At most [`MAX_OBJECTS`].
pub(super) fn count(place: &str, count: usize) -> Result<()> {
    if count <= MAX_OBJECTS {
        return Ok(());
    }
    let what = format!("holds {count} objects, at most {MAX_OBJECTS} can be told apart; join some");
    Err(Error::Limit { place: place.into(), what })
}
