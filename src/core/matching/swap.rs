//! Local improvement of a bijection: neighbours whose straight paths cross exchange their targets.
//!
//! Exchanging the targets of two pairs lowers the sum of squared distances iff (a - a').(b - b') < 0. Where walls stand,
//! that holds for pairs that see each other's targets; pairs that ended on the wrong side of a wall are compared by
//! their ways around it.

use glam::Vec2;
use rayon::prelude::*;

use crate::constraint::Detour;
use crate::constraint::detour::Sight;
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
    /// Whether its target may lie on the wrong side of a wall: a wall stands between that and where the map sends it, or
    /// it was exchanged and has to go around a wall now.
    pub(super) astray: bool,
}

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
    walls: Option<&Detour>,
    progress: &Progress,
) -> Result<usize> {
    progress.check()?;
    let places: Vec<Vec2> = pairs.iter().map(|pair| pair.source.lerp(pair.target, t)).collect();
    let order = hilbert::order(&places, shift);
    *pairs = order.par_iter().with_min_len(4096).map(|&row| pairs[row as usize]).collect();
    progress.check()?;
    let run = |block: &mut [Pair]| match walls {
        None => exchange(block, window, closer, |_| false),
        Some(detour) => {
            let mut sight = Sight::default();
            let bent = |pair: &Pair| detour.barriers().blocks(pair.source, pair.target);
            exchange(block, window, |a, b| closer_around(a, b, detour, &mut sight), bent)
        }
    };
    Ok(pairs.par_chunks_mut(BLOCK).map(run).sum())
}

/// `gains` tells whether two pairs should exchange their targets, `astray` what they are afterwards: a far target is handed on
/// from neighbour to neighbour, so that each of them goes a little farther instead of one of them all the way.
fn exchange(
    block: &mut [Pair],
    window: usize,
    mut gains: impl FnMut(&Pair, &Pair) -> bool,
    astray: impl Fn(&Pair) -> bool,
) -> usize {
    let mut exchanges = 0;
    for i in 1..block.len() {
        let (before, rest) = block.split_at_mut(i);
        let pair = &mut before[i - 1];
        for other in rest.iter_mut().take(window) {
            if gains(pair, other) {
                pair.exchange(other);
                (pair.astray, other.astray) = (astray(pair), astray(other));
                exchanges += 1;
            }
        }
    }
    exchanges
}

/// Whether straight ways become shorter by an exchange.
#[inline(always)]
fn closer(a: &Pair, b: &Pair) -> bool {
    (a.source - b.source).dot(a.target - b.target) < 0.0
}

/// The same around walls. Pairs that follow the same detour are left as the map has them.
fn closer_around(a: &Pair, b: &Pair, detour: &Detour, sight: &mut Sight) -> bool {
    if a.astray || b.astray {
        let mut cost = |source: Vec2, target: Vec2| detour.distance(source, target, sight).powi(2);
        let (now, then) = (
            cost(a.source, a.target) + cost(b.source, b.target),
            cost(a.source, b.target) + cost(b.source, a.target),
        );
        return then < now;
    }
    let blocks = |source, target| detour.barriers().blocks(source, target);
    closer(a, b)
        && !blocks(a.source, b.target)
        && !blocks(b.source, a.target)
        && !blocks(a.source, a.target)
        && !blocks(b.source, b.target)
}
