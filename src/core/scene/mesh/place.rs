//! The placement of a mesh in the scene, in f64: files of maps have coordinates of which f32 would keep but metres.

use std::path::Path;

use glam::{DMat3, DVec3, EulerRot, Vec3};

use super::desc::{MeshDesc, Transform};
use super::obj::{Group, Placement};
use crate::{Error, Result};

/// Farthest from the origin (m): squares of lengths must stay within f32.
const FARTHEST: f32 = 1e9;
/// Rounding of positions that is seen in the light, share of the mesh's size.
const COARSE: f32 = 1e-4;

/// A [`Transform`], ready to be applied.
pub(super) struct Placed {
    turn: DMat3,
    scaled: DMat3,
    offset: DVec3,
}

impl Placed {
    pub(super) fn new(transform: &Transform) -> Self {
        let [x, y, z] = transform.rotate.map(|degrees| f64::from(degrees).to_radians());
        let turn = DMat3::from_euler(EulerRot::ZYX, z, y, x);
        Self { turn, scaled: turn * f64::from(transform.scale), offset: transform.translate.into() }
    }
}

impl Placement for Placed {
    fn position(&self, position: DVec3) -> DVec3 {
        self.scaled * position + self.offset
    }

    fn normal(&self, normal: DVec3) -> DVec3 {
        self.turn * normal
    }
}

/// Refuses a mesh beyond [`FARTHEST`]; what to do about one so far away that its shape suffers.
pub(super) fn check<'a>(
    groups: impl Iterator<Item = &'a Group> + Clone,
    desc: &MeshDesc,
    path: &Path,
) -> Result<Option<String>> {
    let positions = || groups.clone().flat_map(|group| &group.positions);
    let far = positions().fold(0.0_f32, |far, p| far.max(p.abs().max_element()));
    if far.is_nan() || far > FARTHEST {
        let what = format!("reaches {far:e} m from the origin; the limit is {FARTHEST:e}: lower its scale");
        return Err(Error::format(path, "", what));
    }
    let lower = positions().copied().fold(Vec3::INFINITY, Vec3::min);
    let upper = positions().copied().fold(Vec3::NEG_INFINITY, Vec3::max);
    let step = far * f32::EPSILON;
    if step <= COARSE * (upper - lower).max_element() {
        return Ok(None);
    }
    let middle = ((lower + upper) / 2.0).as_dvec3();
    let [x, y, z] = (DVec3::from(desc.transform.translate) - middle).to_array();
    Ok(Some(format!(
        "stands {far:.3e} m from the origin, where positions are only kept to {step:.1e} m; move it there: \
         transform.translate [{x:.2}, {y:.2}, {z:.2}]"
    )))
}
