//! Exact shortest paths around walls (Sec. 3, "Wall Lines"): a visibility graph over the corners of the thickened walls.
//!
//! The paper searches a graph of grid cells for every photon and step, which turns by 45 degrees and costs hours. Here
//! the paths between corners are found once. A photon takes the best pair of a corner that it sees and a corner that
//! its target sees, then keeps that path, so that it stays on its side of the wall.

mod corner_paths;
mod corners;

use glam::Vec2;

use super::barrier::Barriers;
use super::wall::ActiveWall;
use crate::{Error, Progress, Result};
use corner_paths::{CornerPaths, NONE};
use corners::Corner;

/// Limit of corners: the table of paths between them takes 6 bytes per pair.
const MOST_CORNERS: usize = 8000;

/// The walls at one moment, and the shortest paths around them.
#[derive(serde::Deserialize, serde::Serialize)]
pub struct VisibilityGraph {
    extent: Vec2,
    barriers: Barriers,
    corners: Vec<Corner>,
    between: CornerPaths,
}

/// A path around walls: its first and last corner, joined by the shortest path between them; then on to the target.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WallPath {
    first: u16,
    last: u16,
}

/// Lengths of the shortest paths from all corners to one target, see [`VisibilityGraph::paths_to`].
#[derive(Clone, Debug, serde::Deserialize, serde::Serialize)]
pub struct PathsToTarget {
    target: Vec2,
    lengths: Vec<f32>,
}

impl PathsToTarget {
    /// The target.
    pub fn target(&self) -> Vec2 {
        self.target
    }
}

/// The corners seen from one point, with their distances, see [`VisibilityGraph::visible_corners`].
#[derive(Clone, Debug)]
pub struct VisibleCorners {
    source: Vec2,
    seen: Vec<(u16, f32)>,
}

/// Scratch memory of path searches, reused from one to the next.
#[derive(Default)]
pub struct SearchBuffers {
    from: Vec<(u16, f32)>,
    to: Vec<(u16, f32)>,
}

impl WallPath {
    /// Straight to the target.
    pub const STRAIGHT: Self = Self { first: NONE, last: NONE };

    /// Whether no corner lies ahead.
    #[inline]
    pub fn is_straight(self) -> bool {
        self.first == NONE
    }
}

impl VisibilityGraph {
    /// The graph of these walls on the rectangle `extent`.
    ///
    /// # Errors
    /// `Limit` when the walls have more corners than the table of paths may hold; `Cancelled`.
    pub fn new(walls: &[&ActiveWall], extent: Vec2, progress: &Progress) -> Result<Self> {
        let barriers = Barriers::new(walls, extent);
        let corners = corners::corners(walls, &barriers, extent);
        if corners.len() > MOST_CORNERS {
            let what = format!(
                "the walls have {} corners, the limit is {MOST_CORNERS}; draw them with fewer points",
                corners.len()
            );
            return Err(Error::Limit { place: "constraints".into(), what });
        }
        let between = CornerPaths::new(&corners, &barriers, progress)?;
        Ok(Self { extent, barriers, corners, between })
    }

    /// The rectangle's size, plane units.
    pub fn extent(&self) -> Vec2 {
        self.extent
    }

    /// The walls' geometry.
    pub fn barriers(&self) -> &Barriers {
        &self.barriers
    }

    /// The largest number of corners on any path between two corners.
    pub fn most_corners(&self) -> usize {
        self.between.most_corners
    }

    /// The shortest path from `a` to `b`; none where walls separate them.
    pub fn path(&self, a: Vec2, b: Vec2, buffers: &mut SearchBuffers) -> Option<WallPath> {
        if !self.barriers.blocks(a, b) {
            return Some(WallPath::STRAIGHT);
        }
        // Tangents are all that shortest paths need; close to several walls they may be too strict.
        let search = |all, buffers: &mut _| self.search((a, b), (all, f32::INFINITY), buffers);
        search(false, buffers).or_else(|| search(true, buffers))
    }

    /// The shortest path that is shorter than `most`; by tangents alone unless `all`.
    fn search(
        &self,
        (a, b): (Vec2, Vec2),
        (all, most): (bool, f32),
        buffers: &mut SearchBuffers,
    ) -> Option<WallPath> {
        // No path by a corner is shorter than straight to it and on.
        let on_the_way = |corner: Vec2| a.distance(corner) + corner.distance(b) < most;
        self.see_corners(a, all, on_the_way, &mut buffers.from);
        if buffers.from.is_empty() {
            return None;
        }
        self.see_corners(b, all, on_the_way, &mut buffers.to);
        let mut best = (most, None);
        for &(last, after) in &buffers.to {
            let lengths = self.between.lengths_to(last);
            for &(first, before) in &buffers.from {
                let length = before + lengths[usize::from(first)] + after;
                if length < best.0 {
                    best = (length, Some(WallPath { first, last }));
                }
            }
        }
        best.1
    }

    /// The corners that `p` sees of those that `counts`, with their distances.
    fn see_corners(&self, p: Vec2, all: bool, counts: impl Fn(Vec2) -> bool, seen: &mut Vec<(u16, f32)>) {
        seen.clear();
        for (i, corner) in self.corners.iter().enumerate() {
            if counts(corner.at) && (all || corner.turns(p)) && !self.barriers.blocks(p, corner.at) {
                seen.push((i as u16, p.distance(corner.at)));
            }
        }
    }

    /// Length of `path` from `a` to `b`, plane units.
    #[inline]
    pub fn length(&self, path: WallPath, a: Vec2, b: Vec2) -> f32 {
        if path.is_straight() {
            return a.distance(b);
        }
        let [first, last] = [path.first, path.last].map(|corner| self.corners[usize::from(corner)].at);
        a.distance(first) + self.between.length(path.first, path.last) + last.distance(b)
    }

    /// Length of the shortest path from `a` to `b`; infinite where there is none.
    pub fn distance(&self, a: Vec2, b: Vec2, buffers: &mut SearchBuffers) -> f32 {
        self.path(a, b, buffers).map_or(f32::INFINITY, |path| self.length(path, a, b))
    }

    /// As [`Self::distance`], by tangents alone; none where it is not shorter than `most`.
    pub fn distance_below(&self, most: f32, a: Vec2, b: Vec2, buffers: &mut SearchBuffers) -> Option<f32> {
        if !self.barriers.blocks(a, b) {
            return Some(a.distance(b)).filter(|distance| *distance < most);
        }
        let path = self.search((a, b), (false, most), buffers)?;
        Some(self.length(path, a, b))
    }

    /// Lengths of the shortest paths from all corners to `b`, for many queries about one target.
    pub fn paths_to(&self, b: Vec2) -> PathsToTarget {
        let mut seen = Vec::new();
        self.see_corners(b, false, |_| true, &mut seen);
        let mut lengths = vec![f32::INFINITY; self.corners.len()];
        for (last, after) in seen {
            for (shortest, length) in lengths.iter_mut().zip(self.between.lengths_to(last)) {
                *shortest = shortest.min(length + after);
            }
        }
        PathsToTarget { target: b, lengths }
    }

    /// The corners that `a` sees, for many queries about one source.
    pub fn visible_corners(&self, a: Vec2) -> VisibleCorners {
        let mut seen = Vec::new();
        self.see_corners(a, false, |_| true, &mut seen);
        VisibleCorners { source: a, seen }
    }

    /// Length of the shortest path between the two; infinite where there is none.
    pub fn distance_between(&self, from: &VisibleCorners, to: &PathsToTarget) -> f32 {
        if !self.barriers.blocks(from.source, to.target) {
            return from.source.distance(to.target);
        }
        let around = from.seen.iter().map(|&(first, before)| before + to.lengths[usize::from(first)]);
        around.fold(f32::INFINITY, f32::min)
    }

    /// The next point of `path`: its first corner, or `b`.
    #[inline]
    pub fn next_point(&self, path: WallPath, b: Vec2) -> Vec2 {
        if path.is_straight() { b } else { self.corners[usize::from(path.first)].at }
    }

    /// The rest of `path` after its first corner. Paths between corners are those of a shortest-path tree, so that
    /// following one ends at its last corner.
    #[inline]
    pub fn after_corner(&self, path: WallPath) -> WallPath {
        if path.first == path.last {
            return WallPath::STRAIGHT;
        }
        WallPath { first: self.between.next(path.first, path.last), ..path }
    }

    /// Number of corners of `path`.
    pub fn corners_ahead(&self, mut path: WallPath) -> usize {
        let mut count = 0;
        while !path.is_straight() {
            path = self.after_corner(path);
            count += 1;
        }
        count
    }

    /// `path` shortened as seen from `c`: corners that need not be passed any more are left out; a path whose first
    /// corner is hidden is searched anew. None where there is none.
    pub fn updated(&self, path: WallPath, c: Vec2, b: Vec2, buffers: &mut SearchBuffers) -> Option<WallPath> {
        if self.barriers.blocks(c, self.next_point(path, b)) {
            return self.path(c, b, buffers);
        }
        let mut path = path;
        while !path.is_straight() {
            let after = self.after_corner(path);
            if self.barriers.blocks(c, self.next_point(after, b)) {
                break;
            }
            path = after;
        }
        Some(path)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::constraint::{Wall, Window, stroke};
    use crate::math::rng::{Purpose, Stream};

    fn wall(points: &[[f32; 2]], thickness: f32) -> ActiveWall {
        Wall { thickness, ..Wall::new(points.to_vec()) }.active(Window::ALWAYS).unwrap()
    }

    fn graph(walls: &[ActiveWall]) -> VisibilityGraph {
        VisibilityGraph::new(&walls.iter().collect::<Vec<_>>(), Vec2::ONE, &Progress::new()).unwrap()
    }

    fn distance(graph: &VisibilityGraph, a: [f32; 2], b: [f32; 2]) -> f64 {
        f64::from(graph.distance(a.into(), b.into(), &mut SearchBuffers::default()))
    }

    /// The polygon around an end has its corners at 22.5 and 67.5 degrees, at clearance / cos 22.5.
    fn around_an_end(a: Vec2, b: Vec2, end: Vec2, outward: f32, clearance: f32) -> f64 {
        let angles = [-67.5f32, -22.5, 22.5, 67.5].map(|degrees| outward + degrees.to_radians());
        let radius = clearance / 22.5f32.to_radians().cos();
        let corners = angles.map(|angle| end + radius * Vec2::from_angle(angle));
        // The shortest of all paths that pass neighbouring corners in order, in either direction.
        let mut best = f64::INFINITY;
        for order in [[0, 1, 2, 3], [3, 2, 1, 0]] {
            for (i, k) in (0..4).flat_map(|i| (i..4).map(move |k| (i, k))) {
                let middle: Vec<Vec2> = order[i..=k].iter().map(|&n| corners[n]).collect();
                let path = [&[a][..], &middle, &[b]].concat();
                // The polygon touches the circle of the clearance from outside: no leg cuts into that circle.
                let clear = |w: &[Vec2]| stroke::distance_to_segment(end, w[0], w[1]) > clearance - 1e-6;
                let crosses = !path.windows(2).all(clear);
                if !crosses {
                    let length = path.windows(2).map(|w| f64::from(w[0].distance(w[1]))).sum();
                    best = best.min(length);
                }
            }
        }
        best
    }

    #[test]
    fn around_one_end_the_way_is_the_shortest_around_its_polygon() {
        let end = Vec2::new(0.5, 0.6);
        let graph = graph(&[wall(&[[0.5, 0.01], [0.5, 0.6]], 0.04)]);
        for (a, b) in [([0.3, 0.4], [0.7, 0.4]), ([0.2, 0.5], [0.9, 0.55]), ([0.45, 0.1], [0.7, 0.59])] {
            let expected = around_an_end(a.into(), b.into(), end, std::f32::consts::FRAC_PI_2, 0.02);
            // Rounding of single precision over a handful of legs.
            assert!((distance(&graph, a, b) - expected).abs() < 1e-6, "{a:?} to {b:?}");
        }
    }

    #[test]
    fn around_a_thin_wall_the_way_touches_its_end() {
        let graph = graph(&[wall(&[[0.5, 0.005], [0.5, 0.6]], 2e-4)]);
        let expected = 2.0 * f64::hypot(0.2, 0.2);
        let found = distance(&graph, [0.3, 0.4], [0.7, 0.4]);
        // The polygon's corners lie at most 1.09 clearances from the end.
        assert!(found >= expected && found < expected + 4.0 * 1.1e-4, "{found}");
        assert_eq!(distance(&graph, [0.3, 0.7], [0.7, 0.7]), f64::from(0.7f32 - 0.3));
    }

    #[test]
    fn out_of_a_labyrinth_the_way_passes_every_turn() {
        // Two walls that leave an S: up through the gap at the top, down again through the gap at the bottom.
        let walls = [wall(&[[0.3, 0.0], [0.3, 0.9]], 2e-4), wall(&[[0.6, 0.1], [0.6, 1.0]], 2e-4)];
        let graph = graph(&walls);
        let legs = [[0.1, 0.1], [0.3, 0.9], [0.6, 0.1], [0.9, 0.9]].map(Vec2::from);
        let expected: f32 = legs.windows(2).map(|w| w[0].distance(w[1])).sum();
        let found = distance(&graph, [0.1, 0.1], [0.9, 0.9]);
        assert!((found - f64::from(expected)).abs() < 1e-3, "{found} against {expected}");
        let path = graph.path(legs[0], legs[3], &mut SearchBuffers::default()).unwrap();
        assert!(graph.corners_ahead(path) >= 2 && graph.most_corners() >= 2);
    }

    #[test]
    fn a_closed_wall_and_one_across_everything_leave_no_way() {
        let square = [[0.4, 0.4], [0.6, 0.4], [0.6, 0.6], [0.4, 0.6], [0.4, 0.4]];
        let almost = [[0.4, 0.4], [0.6, 0.4], [0.6, 0.6], [0.4, 0.6], [0.4, 0.41]];
        for points in [&square, &almost] {
            let graph = graph(&[wall(points, 0.03)]);
            assert_eq!(distance(&graph, [0.5, 0.5], [0.9, 0.5]), f64::INFINITY);
            assert!(distance(&graph, [0.1, 0.5], [0.9, 0.5]).is_finite());
        }
        let across = graph(&[wall(&[[0.0, 0.5], [1.0, 0.5]], 0.03)]);
        assert_eq!(distance(&across, [0.5, 0.2], [0.5, 0.8]), f64::INFINITY);
        assert_eq!(across.barriers().closed().len(), 1);
    }

    #[test]
    fn a_gap_narrower_than_the_walls_is_closed_and_a_wider_one_is_open() {
        let gap = |gap: f32| {
            graph(&[wall(&[[0.0, 0.5], [0.5, 0.5]], 0.02), wall(&[[0.5 + gap, 0.5], [1.0, 0.5]], 0.02)])
        };
        assert_eq!(distance(&gap(0.015), [0.5, 0.2], [0.5, 0.8]), f64::INFINITY);
        assert!(distance(&gap(0.03), [0.5, 0.2], [0.5, 0.8]) < 0.62);
        let touching = graph(&[wall(&[[0.0, 0.5], [1.0, 0.5]], 0.02), wall(&[[0.5, 0.5], [0.5, 1.0]], 0.02)]);
        assert_eq!(distance(&touching, [0.4, 0.8], [0.6, 0.8]), f64::INFINITY);
    }

    /// Reference: Bellman and Ford's algorithm over all corners, tangents or not. The walls are so thin that a path which
    /// cuts a corner's polygon saves at most its size, 2 clearances, at each of at most eight ends.
    #[test]
    fn leaving_out_what_is_no_tangent_loses_no_shortest_way() {
        let mut random = Stream::new(5, Purpose::Trace, 0, 0);
        let mut point = || [0.1 + 0.8 * random.f32(), 0.1 + 0.8 * random.f32()];
        for _ in 0..20 {
            let walls: Vec<_> = (0..4).map(|_| wall(&[point(), point(), point()], 2e-4)).collect();
            let graph = graph(&walls);
            let sites: Vec<Vec2> = graph.corners.iter().map(|c| c.at).collect();
            for _ in 0..20 {
                let (a, b) = (Vec2::from(point()), Vec2::from(point()));
                let found = graph.distance(a, b, &mut SearchBuffers::default());
                let reference = bellman_ford(&graph.barriers, a, b, &sites);
                let good = found >= reference - 1e-5 && found < reference + 8.0 * 2e-4;
                assert!(good || found == reference, "{found} against {reference}");
            }
        }
    }

    fn bellman_ford(barriers: &Barriers, a: Vec2, b: Vec2, sites: &[Vec2]) -> f32 {
        let all: Vec<Vec2> = [&[a, b][..], sites].concat();
        let mut lengths = vec![f32::INFINITY; all.len()];
        lengths[0] = 0.0;
        loop {
            let mut better = false;
            for i in 0..all.len() {
                for k in 0..all.len() {
                    let through = lengths[i] + all[i].distance(all[k]);
                    if through < lengths[k] - 1e-7 && !barriers.blocks(all[i], all[k]) {
                        lengths[k] = through;
                        better = true;
                    }
                }
            }
            if !better {
                return lengths[1];
            }
        }
    }
}
