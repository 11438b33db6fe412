//! Rays per second of the bare triangle hierarchy: the limit that tracing is compared with.

use std::hint::black_box;
use std::time::Instant;

use glam::Vec3;
use rayon::prelude::*;

use super::Engine;
use super::meter::Meter;
use crate::math::rng::{Purpose, Stream};
use crate::project::Project;
use crate::scene::{Ray, Scene};
use crate::{Progress, Result};

/// Rays that time the bare hierarchy.
const RAYS: u64 = 400_000;

/// Photons traced and rays followed on all threads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Traced {
    /// Photons that landed.
    pub photons: usize,
    /// Rays followed for them.
    pub rays: u64,
    /// Wall-clock seconds they took.
    pub seconds: f64,
}

impl Engine {
    /// Rays per second between random places around the glass, answered by the bare hierarchy; none where the project has
    /// no scene.
    ///
    /// # Errors
    /// Anything wrong with the project or its files; cancelled.
    pub fn bare_rays_per_second(&self, project: &Project, progress: &Progress) -> Result<Option<f64>> {
        let prepared = self.prepare(project, &Meter::quick(), progress)?;
        Ok(prepared.scene.as_deref().map(bare_rays_per_second))
    }
}

/// Between two random places each, in the box of the meshes made half as large again.
fn bare_rays_per_second(scene: &Scene) -> f64 {
    let meshes = || scene.meshes().iter();
    let low = meshes().map(|mesh| mesh.lower).reduce(Vec3::min).unwrap_or_default();
    let high = meshes().map(|mesh| mesh.upper).reduce(Vec3::max).unwrap_or_default();
    let (centre, half) = (0.5 * (low + high), 0.75 * (high - low));
    let rays: Vec<Ray> = (0..RAYS)
        .map(|i| {
            let mut random = Stream::new(1, Purpose::Trace, 0, i);
            let mut place = || centre + half * (2.0 * Vec3::from_array([(); 3].map(|()| random.f32())) - 1.0);
            let (from, to) = (place(), place());
            Ray::new(from, (to - from).normalize_or(Vec3::Y))
        })
        .collect();
    let start = Instant::now();
    black_box(rays.par_iter().filter(|ray| scene.intersect(ray).is_some()).count());
    rays.len() as f64 / start.elapsed().as_secs_f64().max(1e-9)
}
