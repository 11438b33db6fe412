//! Range checks shared by the saved types; each names `place.field`.

use glam::Vec3;

use crate::{Error, Result};

/// All components finite.
pub(super) fn finite(place: &str, field: &str, values: &[f32]) -> Result<()> {
    if values.iter().all(|v| v.is_finite()) {
        return Ok(());
    }
    Err(Error::value(format!("{place}.{field}"), "must be a finite number"))
}

/// Finite and within `low..=high`.
pub(super) fn within(place: &str, field: &str, values: &[f32], low: f32, high: f32) -> Result<()> {
    finite(place, field, values)?;
    match values.iter().find(|v| **v < low || **v > high) {
        None => Ok(()),
        Some(v) => {
            Err(Error::value(format!("{place}.{field}"), format!("is {v}, must be between {low} and {high}")))
        }
    }
}

/// A direction: finite and not of length zero; normalized.
pub(super) fn direction(place: &str, field: &str, value: [f32; 3]) -> Result<Vec3> {
    finite(place, field, &value)?;
    let v = glam::DVec3::new(value[0].into(), value[1].into(), value[2].into()).normalize_or_zero().as_vec3();
    if v == Vec3::ZERO {
        return Err(Error::value(format!("{place}.{field}"), "has length zero, so it points nowhere"));
    }
    Ok(v)
}
