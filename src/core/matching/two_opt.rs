//! Local improvement of a bijection by 2-opt swaps: neighbours whose straight paths cross exchange their targets.
//!
//! Exchanging the targets of two pairs lowers the sum of squared distances iff (a - a').(b - b') < 0. Where walls stand,
//! that holds for pairs that see each other's targets; pairs on the wrong side of a wall are compared by the lengths of
//! their paths around it.

use glam::Vec2;
use rayon::prelude::*;

use crate::constraint::VisibilityGraph;
use crate::constraint::visibility::SearchBuffers;
use crate::math::hilbert;
use crate::{Progress, Result};

/// Pairs per parallel task; only pairs of the same block are compared.
const BLOCK: usize = 1 << 12;

/// A source point and its target.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pair {
    pub(super) source: Vec2,
    pub(super) target: Vec2,
    pub(super) source_row: u32,
    pub(super) target_row: u32,
    /// Whether its target may lie on the wrong side of a wall: a wall stands between the target and the image under the
    /// map, or it took over such a target.
    pub(super) across_wall: bool,
    /// Squared length of its path around the walls; negative until it is asked for.
    pub(super) square: f32,
}

/// A squared length that is not known yet.
pub(super) const UNKNOWN: f32 = -1.0;

impl Pair {
    fn exchange(&mut self, other: &mut Self) {
        std::mem::swap(&mut self.target, &mut other.target);
        std::mem::swap(&mut self.target_row, &mut other.target_row);
    }
}

/// Visits the pairs in the order of a space-filling curve through their places at time `t`, each with its `window`
/// followers. Returns the number of exchanges.
///
/// At its optimum the straight motion is injective at every t, so two pairs that should exchange are neighbours at
/// some t, if not at the start or the end. `shift` moves the curve, which parts other neighbours each time.
pub(super) fn sweep(
    pairs: &mut Vec<Pair>,
    t: f32,
    shift: Vec2,
    window: usize,
    walls: Option<&VisibilityGraph>,
    progress: &Progress,
) -> Result<usize> {
    progress.check()?;
    let places: Vec<Vec2> = pairs.iter().map(|pair| pair.source.lerp(pair.target, t)).collect();
    let order = hilbert::order(&places, shift);
    *pairs = order.par_iter().with_min_len(4096).map(|&row| pairs[row as usize]).collect();
    progress.check()?;
    let run = |block: &mut [Pair]| match walls {
        None => exchange(block, window, |a, b| closer(a, b).then_some([Exchanged::CLEAR; 2])),
        Some(graph) => {
            let mut walls = WallComparison { graph, buffers: SearchBuffers::default() };
            exchange(block, window, |a, b| if progress.is_cancelled() { None } else { walls.closer(a, b) })
        }
    };
    let exchanges = pairs.par_chunks_mut(BLOCK).map(run).sum();
    progress.check()?;
    Ok(exchanges)
}

/// What an exchange makes of a pair.
#[derive(Clone, Copy)]
struct Exchanged {
    across_wall: bool,
    square: f32,
}

impl Exchanged {
    /// A pair that sees its target.
    const CLEAR: Self = Self { across_wall: false, square: UNKNOWN };
}

/// Exchanges the targets of pairs for which `gains` returns what becomes of them. Returns the number of exchanges.
fn exchange(
    block: &mut [Pair],
    window: usize,
    mut gains: impl FnMut(&mut Pair, &mut Pair) -> Option<[Exchanged; 2]>,
) -> usize {
    let mut exchanges = 0;
    for i in 1..block.len() {
        let (before, rest) = block.split_at_mut(i);
        let pair = &mut before[i - 1];
        for other in rest.iter_mut().take(window) {
            if let Some(exchanged) = gains(pair, other) {
                pair.exchange(other);
                for (pair, exchanged) in [&mut *pair, other].into_iter().zip(exchanged) {
                    (pair.across_wall, pair.square) = (exchanged.across_wall, exchanged.square);
                }
                exchanges += 1;
            }
        }
    }
    exchanges
}

/// Whether an exchange lowers the sum of squared straight distances.
#[inline(always)]
fn closer(a: &Pair, b: &Pair) -> bool {
    (a.source - b.source).dot(a.target - b.target) < 0.0
}

/// Comparison of pairs where walls stand.
struct WallComparison<'a> {
    graph: &'a VisibilityGraph,
    buffers: SearchBuffers,
}

impl WallComparison<'_> {
    /// As [`closer`], by the paths around walls where a pair is across a wall; other pairs around the same corner are left
    /// as the map has them. A far target is handed on from neighbour to neighbour, so that each goes a little farther
    /// instead of one of them the whole path.
    fn closer(&mut self, a: &mut Pair, b: &mut Pair) -> Option<[Exchanged; 2]> {
        if a.across_wall || b.across_wall {
            return self.shorter(a, b);
        }
        let clear = |source, target| !self.graph.barriers().blocks(source, target);
        let all_clear = || {
            clear(a.source, b.target)
                && clear(b.source, a.target)
                && clear(a.source, a.target)
                && clear(b.source, b.target)
        };
        (closer(a, b) && all_clear()).then_some([Exchanged::CLEAR; 2])
    }

    fn shorter(&mut self, a: &mut Pair, b: &mut Pair) -> Option<[Exchanged; 2]> {
        let now = [self.now(a), self.now(b)];
        // No path is shorter than the straight one.
        let least = a.source.distance_squared(b.target) + b.source.distance_squared(a.target);
        if least >= now[0] + now[1] {
            return None;
        }
        let first = self.below(now[0] + now[1] - b.source.distance_squared(a.target), a.source, b.target)?;
        let second = self.below(now[0] + now[1] - first, b.source, a.target)?;
        // The pair whose path became longer took over the far target.
        let exchanged = |now: f32, then: f32| Exchanged { across_wall: then > now, square: then };
        Some([exchanged(now[0], first), exchanged(now[1], second)])
    }

    /// Squared length of a pair's path.
    fn now(&mut self, pair: &mut Pair) -> f32 {
        if pair.square < 0.0 {
            pair.square = self.graph.distance(pair.source, pair.target, &mut self.buffers).powi(2);
        }
        pair.square
    }

    /// Squared length of the shortest path; none where it is not below `most`.
    fn below(&mut self, most: f32, source: Vec2, target: Vec2) -> Option<f32> {
        let distance = self.graph.distance_below(most.sqrt(), source, target, &mut self.buffers)?;
        Some(distance.powi(2)).filter(|square| *square < most)
    }
}
