//! Flux of moving photons (end of Sec. 3): phi(t) = (1-t) phi_a + t phi_b.

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use crate::math::sum::ordered_sum;

/// The flux of each photon at time `t` on the path from `source` to `target`, linear RGB watts.
///
/// # Panics
/// When the columns differ in length.
pub fn blend(source: &[Vec3], target: &[Vec3], t: f32, out: &mut [Vec3]) {
    assert!(source.len() == out.len() && target.len() == out.len(), "one flux for each photon");
    let ends = source.par_iter().zip(target);
    out.par_iter_mut().zip(ends).for_each(|(out, (&a, &b))| *out = a * (1.0 - t) + b * t);
}

/// `total` watts over `count` photons: evenly (phi_b of Sec. 3), or by relative colours that keep the sum over all
/// photons and channels. Colours that let none of the light through leave it as it is.
pub fn share_out(total: DVec3, colours: &[Vec3], count: usize) -> Vec<Vec3> {
    let mean = total / count.max(1) as f64;
    let unscaled: f64 = colours.iter().map(|colour| (colour.as_dvec3() * mean).element_sum()).sum();
    let scale = total.element_sum() / unscaled;
    if colours.is_empty() || !scale.is_finite() || scale <= 0.0 {
        return vec![mean.as_vec3(); count];
    }
    colours.iter().map(|colour| (colour.as_dvec3() * mean * scale).as_vec3()).collect()
}

/// As many watts as `total`, over photons of these colours through a filter. Where it lets nothing through, all have the
/// same light.
pub fn coloured(total: DVec3, colours: &[Vec3], filter: Vec3) -> Vec<Vec3> {
    let filtered: f64 = colours.iter().map(|colour| (*colour * filter).as_dvec3().element_sum()).sum();
    let scale = total.element_sum() / filtered;
    if !scale.is_finite() {
        return vec![(total / colours.len().max(1) as f64).as_vec3(); colours.len()];
    }
    colours.iter().map(|colour| ((*colour * filter).as_dvec3() * scale).as_vec3()).collect()
}

/// Sum in f64; the same for any number of threads.
pub fn total(flux: &[Vec3]) -> DVec3 {
    ordered_sum(flux, |f| f.as_dvec3())
}
