//! Flux of the photons on their way (end of Sec. 3): phi(t) = (1-t) phi_a + t phi_b.

use glam::{DVec3, Vec3};
use rayon::prelude::*;

/// Flux at the targets, linear RGB watts.
#[derive(Clone, Debug, PartialEq)]
pub enum TargetFlux {
    /// The same for every photon.
    Uniform(Vec3),
    /// One for each photon.
    Each(Vec<Vec3>),
}

impl TargetFlux {
    /// The total of the source, `rho` times, spread evenly: phi_b = rho/|A| sum of phi_a, in each colour channel.
    pub fn uniform(source: &[Vec3], rho: f32) -> Self {
        Self::Uniform((total(source) * f64::from(rho) / source.len().max(1) as f64).as_vec3())
    }

    /// The same light in the colours of a target picture: `colours` are relative, one for each photon, and multiply
    /// [`Self::uniform`]. The total in watts, over all photons and channels, stays rho times that of the source; colours that
    /// let none of the light through leave it as it is.
    ///
    /// # Panics
    /// When the columns differ in length.
    pub fn coloured(source: &[Vec3], rho: f32, colours: &[Vec3]) -> Self {
        assert_eq!(source.len(), colours.len(), "one colour for each photon");
        let mean = total(source) * f64::from(rho) / source.len().max(1) as f64;
        let unscaled = (total(colours) * mean).element_sum();
        let scale = mean.element_sum() * source.len() as f64 / unscaled;
        if !scale.is_finite() || scale <= 0.0 {
            return Self::Uniform(mean.as_vec3());
        }
        Self::Each(colours.par_iter().map(|colour| (colour.as_dvec3() * mean * scale).as_vec3()).collect())
    }
}

/// The flux of each photon at time `t` of its way.
///
/// # Panics
/// When the columns differ in length.
pub fn blend(source: &[Vec3], target: &TargetFlux, t: f32, out: &mut [Vec3]) {
    assert_eq!(source.len(), out.len(), "one flux for each photon");
    let mix = |a: Vec3, b: Vec3| a * (1.0 - t) + b * t;
    match target {
        TargetFlux::Uniform(b) => {
            out.par_iter_mut().zip(source).for_each(|(out, &a)| *out = mix(a, *b));
        }
        TargetFlux::Each(target) => {
            assert_eq!(source.len(), target.len(), "one target flux for each photon");
            let ends = source.par_iter().zip(target);
            out.par_iter_mut().zip(ends).for_each(|(out, (&a, &b))| *out = mix(a, b));
        }
    }
}

/// Sum in f64, in the order of the rows.
pub fn total(flux: &[Vec3]) -> DVec3 {
    flux.iter().map(|f| f.as_dvec3()).sum()
}
