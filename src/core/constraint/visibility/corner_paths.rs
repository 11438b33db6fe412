//! Shortest paths between all corners, by Dijkstra's algorithm over mutually visible corners.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use rayon::prelude::*;

use super::corners::Corner;
use crate::constraint::barrier::Barriers;
use crate::{Progress, Result};

/// The index of no corner.
pub(super) const NONE: u16 = u16::MAX;

/// All shortest paths between corners.
#[derive(serde::Deserialize, serde::Serialize)]
pub(super) struct CornerPaths {
    count: usize,
    /// Length of the path from corner `a` to corner `b` at `b * count + a`; infinite where there is none.
    lengths: Vec<f32>,
    /// The corner after `a` on the path to `b`, at the same place.
    next: Vec<u16>,
    /// The largest number of corners on a path.
    pub(super) most_corners: usize,
}

/// A corner in the queue with its path length, shortest first.
#[derive(PartialEq)]
struct Reached(f32, u16);

impl Eq for Reached {}
impl PartialOrd for Reached {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
impl Ord for Reached {
    fn cmp(&self, other: &Self) -> Ordering {
        other.0.total_cmp(&self.0).then(other.1.cmp(&self.1))
    }
}

impl CornerPaths {
    pub(super) fn new(corners: &[Corner], barriers: &Barriers, progress: &Progress) -> Result<Self> {
        let count = corners.len();
        let edges: Vec<Vec<(u16, f32)>> = (0..count)
            .into_par_iter()
            .map(|a| {
                progress.check()?;
                let from = corners[a];
                let sees = |b: &usize| {
                    let to = corners[*b];
                    *b != a && from.turns(to.at) && to.turns(from.at) && !barriers.blocks(from.at, to.at)
                };
                Ok((0..count).filter(sees).map(|b| (b as u16, from.at.distance(corners[b].at))).collect())
            })
            .collect::<Result<_>>()?;
        let mut lengths = vec![f32::INFINITY; count * count];
        let mut next = vec![NONE; count * count];
        let most_corners = lengths
            .par_chunks_mut(count.max(1))
            .zip(next.par_chunks_mut(count.max(1)))
            .enumerate()
            .map(|(to, (lengths, next))| {
                progress.check()?;
                Ok(search(to as u16, &edges, lengths, next))
            })
            .try_reduce(|| 0, |a, b| Ok(a.max(b)))?;
        Ok(Self { count, lengths, next, most_corners })
    }

    /// Length of the path from corner `a` to corner `b`, plane units; infinite where there is none.
    #[inline]
    pub(super) fn length(&self, a: u16, b: u16) -> f32 {
        self.lengths[usize::from(b) * self.count + usize::from(a)]
    }

    /// Lengths of the paths to corner `b` from all corners.
    #[inline]
    pub(super) fn lengths_to(&self, b: u16) -> &[f32] {
        &self.lengths[usize::from(b) * self.count..][..self.count]
    }

    /// The corner after `a` on the path to `b`.
    #[inline]
    pub(super) fn next(&self, a: u16, b: u16) -> u16 {
        self.next[usize::from(b) * self.count + usize::from(a)]
    }
}

/// Dijkstra's algorithm towards corner `to`; visibility is mutual. Returns the largest number of corners on a path.
fn search(to: u16, edges: &[Vec<(u16, f32)>], lengths: &mut [f32], next: &mut [u16]) -> usize {
    let mut corners = vec![1; lengths.len()];
    let mut most_corners = 1;
    lengths[usize::from(to)] = 0.0;
    let mut open = BinaryHeap::from([Reached(0.0, to)]);
    while let Some(Reached(length, at)) = open.pop() {
        if length > lengths[usize::from(at)] {
            continue;
        }
        most_corners = most_corners.max(corners[usize::from(at)]);
        for &(other, path) in &edges[usize::from(at)] {
            let through = length + path;
            if through < lengths[usize::from(other)] {
                lengths[usize::from(other)] = through;
                next[usize::from(other)] = at;
                corners[usize::from(other)] = corners[usize::from(at)] + 1;
                open.push(Reached(through, other));
            }
        }
    }
    most_corners
}
