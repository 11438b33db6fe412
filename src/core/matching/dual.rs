//! A lower bound of the cost of any bijection.

use std::ops::Range;

use glam::{DVec2, Vec2};
use rayon::prelude::*;

use super::transport_map::TransportMap;
use crate::math::hilbert;
use crate::{Progress, Result};

/// Limit of points in a leaf of the tree.
const LEAF: usize = 8;
/// Rows per parallel task; fixed, so that the sum comes out the same on any number of threads.
const CHUNK: usize = 4096;

/// A lower bound of [`super::Matching::cost`] over *all* bijections between these very points.
///
/// Kantorovich duality: for any numbers psi(b), the mean of psi over the targets plus the mean over the sources a of
/// min_b (|a - b|^2 - psi(b)) is at most every bijection's mean cost. The map's potential supplies psi, and the minimum
/// runs over all points.
///
/// # Errors
/// `Cancelled`.
pub fn dual_bound(map: &TransportMap, source: &[Vec2], target: &[Vec2], progress: &Progress) -> Result<f64> {
    if source.is_empty() || target.is_empty() {
        return Ok(0.0);
    }
    let potentials: Vec<f64> =
        target.par_iter().with_min_len(4096).map(|&point| map.target_potential(point)).collect();
    let mean_potential = potentials.iter().sum::<f64>() / target.len() as f64;
    let tree = Tree::new(map, target, &potentials);
    // Followers on the curve look into the same branches.
    let parts: Vec<f64> = hilbert::order(source, Vec2::ZERO)
        .par_chunks(CHUNK)
        .map(|rows| {
            progress.check()?;
            Ok(rows.iter().map(|&row| tree.least(source[row as usize].as_dvec2())).sum())
        })
        .collect::<Result<_>>()?;
    Ok(mean_potential + parts.iter().sum::<f64>() / source.len() as f64)
}

/// A target point b with h = |b|^2 - psi(b): then |a - b|^2 - psi(b) = |a|^2 - 2 a.b + h.
#[derive(Clone, Copy, Debug)]
struct Site {
    position: DVec2,
    h: f64,
}

/// A balanced tree over the sites, nodes in heap order from 1.
struct Tree {
    sites: Vec<Site>,
    nodes: Vec<Node>,
}

/// A box of sites with an affine function below all their h. As h is nearly convex, and the slope its gradient, the
/// gap is of second order in the box's size; a bound without the slope would prune far less.
#[derive(Clone, Copy, Debug, Default)]
struct Node {
    centre: DVec2,
    half: DVec2,
    slope: DVec2,
    base: f64,
}

impl Node {
    fn around(sites: &[Site], map: &TransportMap) -> Self {
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for site in sites {
            low = low.min(site.position);
            high = high.max(site.position);
        }
        let (centre, half) = ((low + high) / 2.0, (high - low) / 2.0);
        let slope = 2.0 * centre - map.target_potential_slope(centre, half.max_element());
        let residual = |site: &Site| site.h - slope.dot(site.position - centre);
        let base = sites.iter().map(residual).fold(f64::INFINITY, f64::min);
        Self { centre, half, slope, base }
    }

    /// At most h - 2 a.b for every site b of the node.
    fn bound(&self, a: DVec2) -> f64 {
        self.base - 2.0 * a.dot(self.centre) - (self.slope - 2.0 * a).abs().dot(self.half)
    }
}

impl Tree {
    fn new(map: &TransportMap, target: &[Vec2], potentials: &[f64]) -> Self {
        let site = |(point, psi): (&Vec2, &f64)| {
            let position = point.as_dvec2();
            Site { position, h: position.length_squared() - psi }
        };
        let mut sites: Vec<Site> = target.iter().zip(potentials).map(site).collect();
        let leaves = sites.len().div_ceil(LEAF).next_power_of_two();
        let mut nodes = vec![Node::default(); 2 * leaves];
        build(&mut sites, &mut nodes, 1, map);
        Self { sites, nodes }
    }

    /// min over sites of |a - b|^2 - psi(b).
    fn least(&self, a: DVec2) -> f64 {
        let mut best = f64::INFINITY;
        self.visit(1, self.nodes[1].bound(a), 0..self.sites.len(), a, &mut best);
        a.length_squared() + best
    }

    fn visit(&self, number: usize, bound: f64, range: Range<usize>, a: DVec2, best: &mut f64) {
        if bound >= *best {
            return;
        }
        if is_leaf(number, &self.nodes, range.len()) {
            for site in &self.sites[range] {
                *best = best.min(site.h - 2.0 * a.dot(site.position));
            }
            return;
        }
        let middle = range.start + range.len() / 2;
        let low = (2 * number, self.nodes[2 * number].bound(a), range.start..middle);
        let high = (2 * number + 1, self.nodes[2 * number + 1].bound(a), middle..range.end);
        let (near, far) = if low.1 <= high.1 { (low, high) } else { (high, low) };
        self.visit(near.0, near.1, near.2, a, best);
        self.visit(far.0, far.1, far.2, a, best);
    }
}

fn is_leaf(number: usize, nodes: &[Node], sites: usize) -> bool {
    2 * number >= nodes.len() || sites < 2
}

/// Splits at the median of the longer side of the box; as deep as the logarithm of the count.
fn build(sites: &mut [Site], nodes: &mut [Node], number: usize, map: &TransportMap) {
    let node = Node::around(sites, map);
    nodes[number] = node;
    if is_leaf(number, nodes, sites.len()) {
        return;
    }
    let middle = sites.len() / 2;
    if node.half.x > node.half.y {
        sites.select_nth_unstable_by(middle, |a, b| a.position.x.total_cmp(&b.position.x));
    } else {
        sites.select_nth_unstable_by(middle, |a, b| a.position.y.total_cmp(&b.position.y));
    }
    let (low, high) = sites.split_at_mut(middle);
    build(low, nodes, 2 * number, map);
    build(high, nodes, 2 * number + 1, map);
}
