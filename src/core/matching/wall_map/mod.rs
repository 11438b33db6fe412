//! The continuous map where walls stand: the cost of a pair is the squared length of its path around them.
//!
//! The back-and-forth method knows straight paths only. Here both sets are cut into a thousand cells of equal numbers;
//! the cells are assigned to each other exactly, by the paths around the walls; and the map interpolates that
//! assignment: near each anchor (the representative point of a cell) it is affine, fitted to the neighbours whose targets
//! stay together, and it is discontinuous only where neighbours separate. The discontinuities follow from the
//! assignment's dual prices (a Laguerre diagram with path lengths as distances), so that they are as smooth as the walls
//! and not as ragged as the cells.

mod assignment;
mod cells;

use glam::{Mat2, Vec2};
use rayon::prelude::*;

use super::transport_map::require_points;
use crate::constraint::visibility::{PathsToTarget, VisibleCorners};
use crate::constraint::{Barriers, VisibilityGraph};
use crate::{Progress, Result};
use assignment::Assignment;

/// Default limit of anchors; the time grows with their third power.
pub const ANCHORS: usize = 1024;
/// Least number of photons per anchor.
const PER_ANCHOR: usize = 4;
/// Nearest anchors that are considered as neighbours of an anchor.
const NEIGHBOURS: usize = 10;
/// Largest ratio of the distances after and before the map at which two anchors count as neighbours.
const STRETCH: f32 = 4.0;
/// Nearest anchors among which a point finds its own.
const CANDIDATES: usize = 12;
/// Weight of the squared straight distance in the cost. Among paths around one corner every permutation costs the same;
/// this term keeps neighbours together beyond it.
const ORDER: f64 = 0.03;
/// Cost of a pair that no path connects: more than that of any path, so that as few as possible remain.
const SHUT_OFF: f64 = 100.0;

/// The continuous map around walls.
#[derive(Clone, Debug, serde::Deserialize, serde::Serialize)]
pub struct WallMap {
    anchors: Vec<Anchor>,
    /// Anchors sorted into square cells along rows, to find those near a point.
    buckets: Buckets,
}

/// A point where the map is known, with its affine extension.
#[derive(Clone, Debug, serde::Deserialize, serde::Serialize)]
struct Anchor {
    from: Vec2,
    to: Vec2,
    slope: Mat2,
    /// Root mean square distance to its neighbours.
    spacing: f32,
    /// Anchors near it whose targets stay together with its own.
    neighbours: Vec<u32>,
    /// Paths to its target, and the target's dual price.
    paths: PathsToTarget,
    price: f64,
}

/// A uniform grid over points.
#[derive(Clone, Debug, serde::Deserialize, serde::Serialize)]
struct Buckets {
    low: Vec2,
    per_plane: f32,
    size: [usize; 2],
    items: Vec<Vec<u32>>,
}

impl WallMap {
    /// The map from the points `source` to the points `target`, plane units, around the walls of `graph`.
    /// Deterministic.
    ///
    /// # Errors
    /// `Value` when a set is empty or holds a point that is not finite; `Cancelled`.
    pub fn new(
        source: &[Vec2],
        target: &[Vec2],
        graph: &VisibilityGraph,
        progress: &Progress,
    ) -> Result<Self> {
        Self::with_anchors(ANCHORS, source, target, graph, progress)
    }

    /// As [`Self::new`] with at most `most` anchors, at least 1.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn with_anchors(
        most: usize,
        source: &[Vec2],
        target: &[Vec2],
        graph: &VisibilityGraph,
        progress: &Progress,
    ) -> Result<Self> {
        require_points("source", source)?;
        require_points("target", target)?;
        let photons = source.len().min(target.len());
        let most = (photons / PER_ANCHOR).min(most).max(1);
        let count = if most.is_power_of_two() { most } else { most.next_power_of_two() / 2 };
        let (from, to) = (cells::representatives(source, count), cells::representatives(target, count));
        let visible = |&a: &Vec2| progress.check().map(|()| graph.visible_corners(a));
        let visible = from.par_iter().map(visible).collect::<Result<Vec<VisibleCorners>>>()?;
        let paths = |&b: &Vec2| progress.check().map(|()| graph.paths_to(b));
        let paths = to.par_iter().map(paths).collect::<Result<Vec<PathsToTarget>>>()?;
        let row = |(visible, a): (&VisibleCorners, &Vec2)| -> Result<Vec<f64>> {
            progress.check()?;
            let pair = |(paths, b): (&PathsToTarget, &Vec2)| {
                cost(graph.distance_between(visible, paths), a.distance(*b))
            };
            Ok(paths.iter().zip(&to).map(pair).collect())
        };
        let costs = visible.par_iter().zip(&from).map(row).collect::<Result<Vec<_>>>()?.concat();
        let Assignment { column_of, price } = assignment::assign(&costs, count, progress)?;
        let to: Vec<Vec2> = column_of.iter().map(|&column| to[column]).collect();
        let buckets = Buckets::new(&from);
        let anchors = (0..count)
            .into_par_iter()
            .map(|i| {
                let column = column_of[i];
                let own = (paths[column].clone(), price[column]);
                progress.check().map(|()| Anchor::new(i, &from, &to, own, &buckets, graph.barriers()))
            })
            .collect::<Result<_>>()?;
        Ok(Self { anchors, buckets })
    }

    /// The anchor that `point` belongs to: among the visible ones near it, that of least cost minus price.
    fn anchor_of(&self, point: Vec2, graph: &VisibilityGraph) -> Option<&Anchor> {
        let near = self.buckets.nearest(point, CANDIDATES, |i| self.anchors[i as usize].from);
        let barriers = graph.barriers();
        // Most points see the targets of all candidates and need no paths.
        let mut visible = None;
        let mut best: (f64, Option<&Anchor>) = (f64::INFINITY, None);
        for anchor in near.iter().map(|&i| &self.anchors[i as usize]) {
            if barriers.blocks(point, anchor.from) {
                continue;
            }
            let straight = point.distance(anchor.paths.target());
            let length = match barriers.blocks(point, anchor.paths.target()) {
                false => straight,
                true => graph.distance_between(
                    visible.get_or_insert_with(|| graph.visible_corners(point)),
                    &anchor.paths,
                ),
            };
            let value = cost(length, straight) - anchor.price;
            if value < best.0 {
                best = (value, Some(anchor));
            }
        }
        best.1.or_else(|| self.anchors.get(*near.first()? as usize))
    }

    /// The image of `point`.
    pub fn apply(&self, point: Vec2, graph: &VisibilityGraph) -> Vec2 {
        let Some(first) = self.anchor_of(point, graph) else { return point };
        let (mut sum, mut weights) = (Vec2::ZERO, 0.0);
        let neighbours = first.neighbours.iter().map(|&i| &self.anchors[i as usize]);
        for anchor in std::iter::once(first).chain(neighbours) {
            let apart = point - anchor.from;
            let weight = (-2.0 * apart.length_squared() / first.spacing.powi(2).max(1e-12)).exp().max(1e-20);
            sum += weight * (anchor.to + anchor.slope * apart);
            weights += weight;
        }
        sum / weights
    }
}

impl Anchor {
    fn new(
        i: usize,
        from: &[Vec2],
        to: &[Vec2],
        (paths, price): (PathsToTarget, f64),
        buckets: &Buckets,
        barriers: &Barriers,
    ) -> Self {
        let mut near = buckets.nearest(from[i], NEIGHBOURS + 1, |k| from[k as usize]);
        near.retain(|&k| k as usize != i);
        let square = |k: &u32| from[i].distance_squared(from[*k as usize]);
        let spacing = (near.iter().map(square).sum::<f32>() / near.len().max(1) as f32).sqrt();
        let neighbours: Vec<u32> = near
            .into_iter()
            .filter(|&k| {
                let k = k as usize;
                let stretched = to[i].distance(to[k]);
                stretched <= STRETCH * from[i].distance(from[k]).max(0.5 * spacing)
                    && !barriers.blocks(from[i], from[k])
                    && !barriers.blocks(to[i], to[k])
            })
            .collect();
        let slope =
            slope(neighbours.iter().map(|&k| (from[k as usize] - from[i], to[k as usize] - to[i])), spacing);
        Self { from: from[i], to: to[i], slope, spacing, neighbours, paths, price }
    }
}

/// The cost of a path of this length between points at this straight distance.
fn cost(length: f32, straight: f32) -> f64 {
    let ordered = ORDER * f64::from(straight).powi(2);
    if length.is_finite() { f64::from(length).powi(2) + ordered } else { SHUT_OFF }
}

/// The least-squares matrix J of b = J a over all pairs (a, b), regularized towards the identity.
fn slope(pairs: impl Iterator<Item = (Vec2, Vec2)>, spacing: f32) -> Mat2 {
    let ridge = 0.5 * spacing * spacing + 1e-12;
    let outer = |b: Vec2, a: Vec2| Mat2::from_cols(b * a.x, b * a.y);
    let (mut ba, mut aa) = (Mat2::IDENTITY * ridge, Mat2::IDENTITY * ridge);
    for (a, b) in pairs {
        ba += outer(b, a);
        aa += outer(a, a);
    }
    ba * aa.inverse()
}

impl Buckets {
    fn new(points: &[Vec2]) -> Self {
        let (mut low, mut high) = (Vec2::INFINITY, Vec2::NEG_INFINITY);
        for &point in points {
            (low, high) = (low.min(point), high.max(point));
        }
        let side = (points.len() as f32 / 2.0).sqrt().max(1.0);
        let per_plane = side / (high - low).max_element().max(1e-6);
        let size = ((high - low) * per_plane).to_array().map(|cells| cells as usize + 1);
        let mut buckets = Self { low, per_plane, size, items: vec![Vec::new(); size[0] * size[1]] };
        for (&point, i) in points.iter().zip(0..) {
            let [x, y] = buckets.cell(point);
            buckets.items[y * size[0] + x].push(i);
        }
        buckets
    }

    fn cell(&self, p: Vec2) -> [usize; 2] {
        let at = ((p - self.low) * self.per_plane).max(Vec2::ZERO);
        [(at.x as usize).min(self.size[0] - 1), (at.y as usize).min(self.size[1] - 1)]
    }

    /// The `count` nearest points, nearest first, ties by number. `place` returns the position of each.
    fn nearest(&self, p: Vec2, count: usize, place: impl Fn(u32) -> Vec2) -> Vec<u32> {
        let [x, y] = self.cell(p);
        let far = self.size[0].max(self.size[1]);
        let mut found: Vec<(f32, u32)> = Vec::with_capacity(4 * count);
        let (mut ring, mut last) = (0, far);
        while ring <= last.min(far) {
            let rows = y.saturating_sub(ring)..=(y + ring).min(self.size[1] - 1);
            for row in rows {
                let edge = row.abs_diff(y) == ring;
                for column in x.saturating_sub(ring)..=(x + ring).min(self.size[0] - 1) {
                    if edge || column.abs_diff(x) == ring {
                        let items = &self.items[row * self.size[0] + column];
                        found.extend(items.iter().map(|&i| (p.distance_squared(place(i)), i)));
                    }
                }
            }
            // Points in the next ring may still be nearer than the corners of this one.
            if found.len() >= count && last == far {
                last = ring + 2 + ring / 2;
            }
            ring += 1;
        }
        found.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        found.truncate(count);
        found.into_iter().map(|(_, i)| i).collect()
    }
}
