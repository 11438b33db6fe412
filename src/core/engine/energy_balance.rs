//! The conservation of flux from the source to the frames.

use glam::Vec3;

use crate::flow::{WallViolations, flux};
use crate::render::splat::OutsidePhotons;

/// The conservation of flux over all frames and passes.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct EnergyBalance {
    /// Most photons of one frame that flowed beyond the texture.
    pub(super) outside: usize,
    /// Flux of the photons over the requested flux; the frame farthest from 1.
    pub(super) flux_ratio: Option<f64>,
    /// Flux in the texture over flux of the photons on it, the frame farthest from 1.
    pub(super) texture_ratio: Option<f64>,
    /// Photons of all passes that crossed a wall although a path leads around it.
    pub(super) crossings: usize,
    /// Most photons of one pass and segment whose target no path reaches.
    pub(super) unreachable: usize,
}

impl EnergyBalance {
    /// Records the wall violations of one segment.
    pub(super) fn keep_violations(&mut self, violations: WallViolations) {
        self.crossings += violations.crossings;
        self.unreachable = self.unreachable.max(violations.unreachable);
    }

    /// Records one frame: the photons beyond the texture, and the flux of its photons, requested, and in the texture, watts.
    pub(super) fn keep(&mut self, outside: OutsidePhotons, flux: f64, requested: f64, lit: f64) {
        self.outside = self.outside.max(outside.photons);
        self.keep_flux_ratio(flux, requested);
        farther(&mut self.texture_ratio, lit, flux - outside.flux.element_sum());
    }

    /// Records the flux of one frame's photons against the requested flux, watts.
    pub(super) fn keep_flux_ratio(&mut self, flux: f64, requested: f64) {
        farther(&mut self.flux_ratio, flux, requested);
    }
}

/// Keeps the ratio that is farther from 1; none where there is no light.
fn farther(kept: &mut Option<f64>, part: f64, whole: f64) {
    let ratio = part / whole;
    if whole > 0.0 && kept.is_none_or(|k| (ratio - 1.0).abs() > (k - 1.0).abs()) {
        *kept = Some(ratio);
    }
}

/// Linear interpolation between the values at the ends of a segment at time `t`, as flux is blended.
pub(super) fn between([from, to]: [f64; 2], t: f64) -> f64 {
    from * (1.0 - t) + to * t
}

/// Sum over photons and colours, in watts.
pub(super) fn total(flux: &[Vec3]) -> f64 {
    flux::total(flux).element_sum()
}
