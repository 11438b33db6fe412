//! The check of directions.

use glam::Vec3;

use crate::{Error, Result};

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
