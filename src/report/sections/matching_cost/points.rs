//! The points that are paired, and a lower bound of the cost of any pairing.

use glam::Vec2;

use lightloom_core::engine::MovingSegment;
use lightloom_core::matching::{MapSettings, Matching, dual_bound, transport_map_with};
use lightloom_core::math::rng::{Purpose, Stream};
use lightloom_core::{Progress, Result};

/// Iterations of the maps that give the lower bound.
const THOROUGH: usize = 40;
/// Pass number of the random numbers that shuffle the rows; no render has it.
const MIXING: u64 = u64::MAX;

/// Points at two key frames, in no common order.
pub(super) struct Points {
    pub(super) source: Vec<Vec2>,
    pub(super) target: Vec<Vec2>,
    /// Row of `target` that the project pairs with each row of `source`.
    pub(super) given: Vec<u32>,
    pub(super) extent: Vec2,
}

impl Points {
    /// At most `most` of the photons, at even distances; the rows of the target are shuffled.
    pub(super) fn new(photons: &MovingSegment, most: usize, seed: u64) -> Self {
        let all = photons.source.len();
        let count = most.min(all);
        let row = |i: usize| i * all / count;
        let mut order: Vec<(u32, usize)> =
            (0..count).map(|i| (Stream::new(seed, Purpose::Match, MIXING, i as u64).u32(), i)).collect();
        order.sort_unstable();
        let mut given = vec![0; count];
        order.iter().zip(0..).for_each(|(&(_, i), mixed)| given[i] = mixed);
        Self {
            source: (0..count).map(|i| photons.source[row(i)]).collect(),
            target: order.iter().map(|&(_, i)| photons.target[row(i)]).collect(),
            given,
            extent: photons.extent,
        }
    }

    /// The pairing of the project.
    pub(super) fn given(&self) -> Matching {
        Matching { target_of: self.given.clone() }
    }

    /// A lower bound of the mean squared distance: the larger of the bounds by the default lattice and by one of `cells` cells.
    pub(super) fn bound(&self, cells: usize, progress: &Progress) -> Result<f64> {
        let Self { source, target, extent, .. } = self;
        [None, Some(cells)].into_iter().try_fold(0.0_f64, |best, cells| {
            let settings = MapSettings { cells, iterations: THOROUGH, tolerance: 0.0 };
            let map = transport_map_with(source, target, *extent, &settings, progress)?;
            Ok(best.max(dual_bound(&map, source, target, progress)?))
        })
    }
}
