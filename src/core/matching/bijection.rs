//! The bijection between the points of one pass.

use glam::Vec2;
use rayon::prelude::*;

use super::bisection::{Item, bisect};
use super::transport_map::{TransportMap, require_points};
use super::two_opt::{Pair, UNKNOWN, sweep};
use super::wall_map::WallMap;
use crate::constraint::VisibilityGraph;
use crate::math::rng::{Purpose, Stream};
use crate::{Error, Progress, Result};

/// Times at which pairs are compared with their neighbours, one sweep each, cyclically.
const TIMES: [f32; 6] = [1.0, 0.0, 0.5, 0.25, 0.75, 0.5];
/// Default number of 2-opt sweeps.
pub const SWEEPS: usize = 6;
/// Following pairs that each pair is compared with in a sweep.
const WINDOW: usize = 16;

/// Which target each source point goes to: a permutation.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Matching {
    /// Source row -> target row.
    pub target_of: Vec<u32>,
}

impl Matching {
    /// Pairs `source` with `target`, as many points, near `map` and with (nearly) least total squared distance.
    ///
    /// Different passes over one map are coherent. Deterministic in (seed, pass).
    ///
    /// # Errors
    /// `Value` when the counts differ, a set is empty or a point is not finite; `Cancelled`.
    pub fn new(
        source: &[Vec2],
        target: &[Vec2],
        map: &TransportMap,
        seed: u64,
        pass: u64,
        progress: &Progress,
    ) -> Result<Self> {
        Self::swept(source, target, Some(map), SWEEPS, (seed, pass), progress)
    }

    /// As [`Self::new`] with this number of 2-opt sweeps; without a map, points are bisected where they are.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn swept(
        source: &[Vec2],
        target: &[Vec2],
        map: Option<&TransportMap>,
        sweeps: usize,
        random: (u64, u64),
        progress: &Progress,
    ) -> Result<Self> {
        let apply = |point| map.map_or(point, |map| map.apply(point));
        Self::near(source, target, apply, None, sweeps, random, progress)
    }

    /// As [`Self::new`] around walls: near `map`, with little total squared path length.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn around_walls(
        source: &[Vec2],
        target: &[Vec2],
        (map, graph): (&WallMap, &VisibilityGraph),
        seed: u64,
        pass: u64,
        progress: &Progress,
    ) -> Result<Self> {
        let apply = |point| map.apply(point, graph);
        Self::near(source, target, apply, Some((graph, Sight::FromMap)), SWEEPS, (seed, pass), progress)
    }

    /// As [`Self::new`] for points that are near each other, so that few pairs need a path around the walls of `graph`.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn beside_walls(
        source: &[Vec2],
        target: &[Vec2],
        (map, graph): (&TransportMap, &VisibilityGraph),
        seed: u64,
        pass: u64,
        progress: &Progress,
    ) -> Result<Self> {
        let apply = |point| map.apply(point);
        Self::near(source, target, apply, Some((graph, Sight::FromSource)), SWEEPS, (seed, pass), progress)
    }

    fn near(
        source: &[Vec2],
        target: &[Vec2],
        map: impl Fn(Vec2) -> Vec2 + Sync,
        walls: Option<(&VisibilityGraph, Sight)>,
        sweeps: usize,
        (seed, pass): (u64, u64),
        progress: &Progress,
    ) -> Result<Self> {
        require_points("source", source)?;
        require_points("target", target)?;
        require_equal_counts(source.len(), target.len())?;
        progress.begin("match", 1 + sweeps as u64);
        let mut pairs = bisected(source, target, map, walls, (seed, pass), progress);
        progress.check()?;
        progress.advance(1);
        let mut stream = Stream::new(seed, Purpose::Match, pass, 0);
        for &t in TIMES.iter().cycle().take(sweeps) {
            let shift = Vec2::new(stream.f32(), stream.f32());
            sweep(&mut pairs, t, shift, WINDOW, walls.map(|(graph, _)| graph), progress)?;
            progress.advance(1);
        }
        let mut target_of = vec![0; pairs.len()];
        pairs.iter().for_each(|pair| target_of[pair.source_row as usize] = pair.target_row);
        Ok(Self { target_of })
    }

    /// Row i to row i.
    ///
    /// # Errors
    /// `Value` when the counts differ.
    pub fn given(source_count: usize, target_count: usize) -> Result<Self> {
        require_equal_counts(source_count, target_count)?;
        Ok(Self { target_of: (0..source_count as u32).collect() })
    }

    /// The targets arranged by source row: row k of the result is where photon k goes.
    ///
    /// # Panics
    /// When a target row is out of range.
    pub fn apply<T: Copy>(&self, target: &[T]) -> Vec<T> {
        self.target_of.iter().map(|&row| target[row as usize]).collect()
    }

    /// Mean squared distance between source points and their targets, plane units squared.
    pub fn cost(&self, source: &[Vec2], target: &[Vec2]) -> f64 {
        mean_square_distance(source, self.target_of.iter().map(|&row| target[row as usize]))
    }

    /// Whether every target is taken exactly once.
    pub fn is_bijection(&self) -> bool {
        let mut taken = vec![false; self.target_of.len()];
        self.target_of
            .iter()
            .all(|&row| taken.get_mut(row as usize).is_some_and(|taken| !std::mem::replace(taken, true)))
    }
}

/// Mean squared distance of points that are paired row by row, in plane units squared; 0 without points.
pub fn mean_square_distance(source: &[Vec2], targets: impl Iterator<Item = Vec2>) -> f64 {
    let sum: f64 = source.iter().zip(targets).map(|(a, b)| a.as_dvec2().distance_squared(b.as_dvec2())).sum();
    sum / source.len().max(1) as f64
}

/// Pairs found by bisection of the mapped source points and the targets.
fn bisected(
    source: &[Vec2],
    target: &[Vec2],
    map: impl Fn(Vec2) -> Vec2 + Sync,
    walls: Option<(&VisibilityGraph, Sight)>,
    (seed, pass): (u64, u64),
    progress: &Progress,
) -> Vec<Pair> {
    let mut a: Vec<Item> = source
        .par_iter()
        .enumerate()
        .with_min_len(4096)
        .map(|(row, point)| {
            // A map around walls is slow; a cancelled result is dropped later.
            let position = if progress.is_cancelled() { *point } else { map(*point) };
            Item { position, row: row as u32 }
        })
        .collect();
    let mut b: Vec<Item> =
        target.iter().enumerate().map(|(row, &position)| Item { position, row: row as u32 }).collect();
    bisect(&mut a, &mut b, seed, pass, progress);
    a.par_iter()
        .zip(&b)
        .with_min_len(4096)
        .map(|(a, b)| Pair {
            source: source[a.row as usize],
            target: b.position,
            source_row: a.row,
            target_row: b.row,
            across_wall: walls.is_some_and(|(graph, sight)| {
                let from = match sight {
                    Sight::FromMap => a.position,
                    Sight::FromSource => source[a.row as usize],
                };
                graph.barriers().blocks(from, b.position)
            }),
            square: UNKNOWN,
        })
        .collect()
}

/// The point from which a target must be seen, or it is on the wrong side of a wall.
#[derive(Clone, Copy)]
enum Sight {
    /// The image under a map that goes around walls.
    FromMap,
    /// The source point.
    FromSource,
}

pub(super) fn require_equal_counts(source: usize, target: usize) -> Result<()> {
    if source == target && u32::try_from(source).is_ok() {
        return Ok(());
    }
    Err(Error::value(
        "matching",
        format!(
            "{source} source points cannot be paired one to one with {target} target points; make the counts equal"
        ),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn applying_a_matching_puts_each_target_in_its_photons_row() {
        let matching = Matching { target_of: vec![2, 0, 1] };
        assert_eq!(matching.apply(&["a", "b", "c"]), ["c", "a", "b"]);
    }
}
