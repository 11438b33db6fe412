//! What a good pairing costs: the transport cost over a lower bound of it, over the seconds of the matching.
//!
//! Varied (`ways`) are the lattice and the iterations of the map, and the sweeps in which pairs exchange their targets.
//! Beside them stand the equal halves without a map, the method before, and what the project does.

mod ways;
mod words;

use glam::Vec2;

use super::{Section, nothing_moves};
use crate::chapter::Chapter;
use crate::workbench::Workbench;
use lightloom_core::engine::MovingSegment;
use lightloom_core::matching::{MapSettings, Matching, dual_bound, transport_map_with};
use lightloom_core::math::rng::{Purpose, Stream};
use lightloom_core::{Progress, Result};
use ways::{Matched, Way, Ways};

/// Iterations of the maps by which a lower bound is looked for.
const THOROUGH: usize = 40;
/// Pass of the random numbers that mix the rows: no pass of a render.
const MIXING: u64 = u64::MAX;

pub(crate) const SECTION: Section =
    Section { name: "matching", needless: nothing_moves, measure, seconds: [4.0, 20.0] };

/// Points at two keys, in no common order.
struct Points {
    source: Vec<Vec2>,
    target: Vec<Vec2>,
    /// Row of the target that the project pairs each source row with.
    given: Vec<u32>,
    extent: Vec2,
}

/// All that was measured.
struct Measured {
    project: String,
    /// Points that were paired.
    count: usize,
    /// The project's own way first.
    rows: Vec<Matched>,
    /// A lower bound of the mean squared distance, along straight ways.
    bound: f64,
    walls: bool,
}

fn measure(bench: &mut Workbench, progress: &Progress) -> Result<Chapter> {
    let photons = bench.first_move(progress)?;
    let (seed, most, finest) = (bench.project.seed, bench.pick(10_000, 200_000), bench.pick(256, 512));
    let points = Points::new(&photons, most, seed);
    let walls = !photons.matched_walls().is_empty();
    let list = Way::list(Way::of(&bench.project, walls), walls, finest);
    progress.begin("matching", list.len() as u64 + 2);
    let ways = Ways::new(&points, &photons, seed, progress)?;
    progress.advance(1);
    let mut rows = Vec::new();
    for way in list {
        rows.push(ways.measure(way)?);
        progress.advance(1);
    }
    let bound = points.bound(finest, &progress.inner())?;
    progress.advance(1);
    let (project, count) = (bench.project.name.clone(), points.source.len());
    Ok(Measured { project, count, rows, bound, walls: ways.walls() }.chapter())
}

impl Points {
    /// At most so many of the photons, at even distances; the target's rows are mixed, for they come paired.
    fn new(photons: &MovingSegment, most: usize, seed: u64) -> Self {
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

    /// As the project pairs them.
    fn given(&self) -> Matching {
        Matching { target_of: self.given.clone() }
    }

    /// A lower bound of the mean squared distance: the better of those by the project's lattice and by one of so many cells.
    fn bound(&self, cells: usize, progress: &Progress) -> Result<f64> {
        let Self { source, target, extent, .. } = self;
        [None, Some(cells)].into_iter().try_fold(0.0_f64, |best, cells| {
            let settings = MapSettings { cells, iterations: THOROUGH, tolerance: 0.0 };
            let map = transport_map_with(source, target, *extent, &settings, progress)?;
            Ok(best.max(dual_bound(&map, source, target, progress)?))
        })
    }
}
