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
    *pairs = ordered(pairs, t, shift);
    progress.check()?;
    Ok(pairs.par_chunks_mut(BLOCK).map(|block| exchange(block, window)).sum())
}

fn ordered(pairs: &[Pair], t: f32, shift: Vec2) -> Vec<Pair> {
    let place = |pair: &Pair| pair.source.lerp(pair.target, t);
    let (low, high) = pairs.iter().fold((Vec2::INFINITY, Vec2::NEG_INFINITY), |(low, high), pair| {
        (low.min(place(pair)), high.max(place(pair)))
    });
    let side = (high - low).max_element().max(f32::MIN_POSITIVE);
    // The curve's square is twice as large as the points' box, which leaves room to shift it.
    let scale = 65535.0 / (2.0 * side);
    let mut keys: Vec<u64> = pairs
        .par_iter()
        .enumerate()
        .with_min_len(4096)
        .map(|(i, pair)| {
            let p = (place(pair) - low + shift * side) * scale;
            (hilbert::index(p.x as u32, p.y as u32) as u64) << 32 | i as u64
        })
        .collect();
    keys.par_sort_unstable();
    keys.par_iter().with_min_len(4096).map(|key| pairs[*key as u32 as usize]).collect()
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
