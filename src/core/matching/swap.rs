//! Local improvement of a bijection: neighbours whose straight paths cross exchange their targets.
//!
//! Exchanging the targets of two pairs lowers the sum of squared distances iff (a - a').(b - b') < 0.

use glam::Vec2;
use rayon::prelude::*;

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
    progress: &Progress,
) -> Result<usize> {
    progress.check()?;
    let places: Vec<Vec2> = pairs.iter().map(|pair| pair.source.lerp(pair.target, t)).collect();
    let order = hilbert::order(&places, shift);
    *pairs = order.par_iter().with_min_len(4096).map(|&row| pairs[row as usize]).collect();
    progress.check()?;
    Ok(pairs.par_chunks_mut(BLOCK).map(|block| exchange(block, window)).sum())
}

fn exchange(block: &mut [Pair], window: usize) -> usize {
    let mut exchanges = 0;
    for i in 1..block.len() {
        let (before, rest) = block.split_at_mut(i);
        let pair = &mut before[i - 1];
        for other in rest.iter_mut().take(window) {
            if (pair.source - other.source).dot(pair.target - other.target) < 0.0 {
                std::mem::swap(&mut pair.target, &mut other.target);
                std::mem::swap(&mut pair.target_row, &mut other.target_row);
                exchanges += 1;
            }
        }
    }
    exchanges
}
