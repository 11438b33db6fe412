//! What the camera meets first: the share of each pixel that a surface covers, and its depth.

use glam::{Vec2, vec2};
use rayon::prelude::*;

use super::sampler::{Sampler, tent};
use crate::math::rng::{Purpose, Stream};
use crate::scene::{Ray, Scene};
use crate::{Progress, Result};

/// Samples of a pixel on an edge.
const SAMPLES: u32 = 64;
/// Depth where there is no surface (m): finite, so that filters of a compositing program do not make NaN of it.
pub const NO_DEPTH: f32 = 1e10;

/// Coverage and depth of the first surfaces, pixel by pixel. Glass covers what is behind it; the sky and lamps are no
/// surfaces.
#[derive(Clone, Debug, PartialEq, serde::Deserialize, serde::Serialize)]
pub struct FirstHits {
    /// Share of the pixel's filter that meets a surface, 0..=1. Things thinner than a pixel may be missed.
    pub coverage: Vec<f32>,
    /// Distance along the view at the middle of the pixel (m); [`NO_DEPTH`] where there is no surface.
    pub depth: Vec<f32>,
}

impl FirstHits {
    /// Those of a scene's camera in a picture of `width` x `height`. The same seed gives the same bytes.
    ///
    /// # Errors
    /// `Cancelled`.
    pub fn new(scene: &Scene, [width, height]: [usize; 2], seed: u64, progress: &Progress) -> Result<Self> {
        let size = vec2(width as f32, height as f32);
        let ray = |at: Vec2| -> Ray {
            let place = at / size * 2.0 - 1.0;
            scene.camera().ray(place.x, -place.y, size.x / size.y)
        };
        let camera = scene.camera();
        let depth_at = |i: usize| {
            let ray = ray(vec2((i % width) as f32 + 0.5, (i / width) as f32 + 0.5));
            scene.intersect(&ray).map_or(NO_DEPTH, |hit| hit.t * ray.direction.dot(camera.forward))
        };
        let by_pixel = |value: &(dyn Fn(usize) -> f32 + Sync)| -> Result<Vec<f32>> {
            let row = |y: usize| {
                progress.check()?;
                Ok((y * width..(y + 1) * width).map(value).collect::<Vec<_>>())
            };
            let rows = (0..height).into_par_iter().map(row).collect::<Result<Vec<_>>>()?;
            Ok(rows.concat())
        };
        let depth = by_pixel(&depth_at)?;
        let met = |i: usize| depth[i] < NO_DEPTH;
        let around = |i: usize, count: usize| i.saturating_sub(1)..(i + 2).min(count);
        let coverage = by_pixel(&|i| {
            let (x, y) = (i % width, i / width);
            let mut neighbours = around(y, height).flat_map(|y| around(x, width).map(move |x| y * width + x));
            if neighbours.all(|n| met(n) == met(i)) {
                return f32::from(u8::from(met(i)));
            }
            let sampler = Sampler::new(Stream::new(seed, Purpose::Visible, 1, i as u64).u32());
            let middle = vec2(x as f32 + 0.5, y as f32 + 0.5);
            let hits = (0..SAMPLES)
                .filter(|&index| scene.intersect(&ray(middle + tent(sampler.pair(index, 0)))).is_some());
            hits.count() as f32 / SAMPLES as f32
        })?;
        Ok(Self { coverage, depth })
    }

    /// The same depth in a picture that is covered all over.
    pub fn all_covered(&self) -> Self {
        Self { coverage: vec![1.0; self.coverage.len()], depth: self.depth.clone() }
    }
}
