//! Shortest ways around walls (Sec. 3, "Wall Lines"), exact: over the corners of the thickened walls.
//!
//! The paper searches a graph of grid cells for every photon and step, which turns by 45 degrees and costs hours. Here
//! the ways between corners are found once; a photon asks for the best pair of a corner that it sees and a corner that
//! its target sees, then remembers the way, so that it keeps its side of the wall.

mod corners;
mod graph;

use glam::Vec2;

use super::barrier::Barriers;
use super::wall::ActiveWall;
use crate::{Error, Progress, Result};
use corners::Corner;
use graph::{Graph, NONE};

/// Most corners: the table of ways between them takes 6 bytes for each pair.
const MOST_CORNERS: usize = 8000;

/// The walls that stand at one moment, and the ways around them.
pub struct Detour {
    extent: Vec2,
    barriers: Barriers,
    corners: Vec<Corner>,
    graph: Graph,
}

/// The corners of a way: from the first to the last by the graph, then on to the target.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Way {
    first: u16,
    last: u16,
}

/// What [`Detour::tails`] finds.
#[derive(Clone, Debug)]
pub struct Tails {
    target: Vec2,
    lengths: Vec<f32>,
}

impl Tails {
    /// The target.
    pub fn target(&self) -> Vec2 {
        self.target
    }
}

/// What [`Detour::heads`] finds.
#[derive(Clone, Debug)]
pub struct Heads {
    source: Vec2,
    seen: Vec<(u16, f32)>,
}

/// Room for a search, kept from one to the next.
#[derive(Default)]
pub struct Sight {
    from: Vec<(u16, f32)>,
    to: Vec<(u16, f32)>,
}

impl Way {
    /// Straight to the target.
    pub const STRAIGHT: Self = Self { first: NONE, last: NONE };

    /// Whether no corner lies ahead.
    #[inline]
    pub fn is_straight(self) -> bool {
        self.first == NONE
    }
}

impl Detour {
    /// The walls that stand on the rectangle `extent`.
    ///
    /// # Errors
    /// `Limit` when the walls have more corners than the table of ways may hold; `Cancelled`.
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
        let graph = Graph::new(&corners, &barriers, progress)?;
        Ok(Self { extent, barriers, corners, graph })
    }

    /// The rectangle, from the origin, plane units.
    pub fn extent(&self) -> Vec2 {
        self.extent
    }

    /// The walls themselves.
    pub fn barriers(&self) -> &Barriers {
        &self.barriers
    }

    /// Most corners on one way.
    pub fn longest(&self) -> usize {
        self.graph.longest
    }

    /// The shortest way from `a` to `b`; none where walls shut them off from each other.
    pub fn way(&self, a: Vec2, b: Vec2, sight: &mut Sight) -> Option<Way> {
        if !self.barriers.blocks(a, b) {
            return Some(Way::STRAIGHT);
        }
        // Tangents are all that shortest ways need; close to several walls they may be too strict.
        self.search(a, b, sight, false).or_else(|| self.search(a, b, sight, true))
    }

    fn search(&self, a: Vec2, b: Vec2, sight: &mut Sight, all: bool) -> Option<Way> {
        self.look(a, all, &mut sight.from);
        if sight.from.is_empty() {
            return None;
        }
        self.look(b, all, &mut sight.to);
        let mut best = (f32::INFINITY, None);
        for &(last, after) in &sight.to {
            let lengths = self.graph.lengths_to(last);
            for &(first, before) in &sight.from {
                let length = before + lengths[usize::from(first)] + after;
                if length < best.0 {
                    best = (length, Some(Way { first, last }));
                }
            }
        }
        best.1
    }

    /// The corners that `p` sees, with their distances.
    fn look(&self, p: Vec2, all: bool, seen: &mut Vec<(u16, f32)>) {
        seen.clear();
        for (i, corner) in self.corners.iter().enumerate() {
            if (all || corner.turns(p)) && !self.barriers.blocks(p, corner.at) {
                seen.push((i as u16, p.distance(corner.at)));
            }
        }
    }

    /// Length of `way` from `a` to `b`, plane units.
    #[inline]
    pub fn length(&self, way: Way, a: Vec2, b: Vec2) -> f32 {
        if way.is_straight() {
            return a.distance(b);
        }
        let [first, last] = [way.first, way.last].map(|corner| self.corners[usize::from(corner)].at);
        a.distance(first) + self.graph.length(way.first, way.last) + last.distance(b)
    }

    /// Length of the shortest way from `a` to `b`; infinite where there is none.
    pub fn distance(&self, a: Vec2, b: Vec2, sight: &mut Sight) -> f32 {
        self.way(a, b, sight).map_or(f32::INFINITY, |way| self.length(way, a, b))
    }

    /// Lengths of the shortest ways from all corners to `b`, for many questions about one target.
    pub fn tails(&self, b: Vec2) -> Tails {
        let mut seen = Vec::new();
        self.look(b, false, &mut seen);
        let mut lengths = vec![f32::INFINITY; self.corners.len()];
        for (last, after) in seen {
            for (tail, length) in lengths.iter_mut().zip(self.graph.lengths_to(last)) {
                *tail = tail.min(length + after);
            }
        }
        Tails { target: b, lengths }
    }

    /// The corners that `a` sees, for many questions about one source.
    pub fn heads(&self, a: Vec2) -> Heads {
        let mut seen = Vec::new();
        self.look(a, false, &mut seen);
        Heads { source: a, seen }
    }

    /// Length of the shortest way between the two; infinite where there is none.
    pub fn between(&self, heads: &Heads, tails: &Tails) -> f32 {
        if !self.barriers.blocks(heads.source, tails.target) {
            return heads.source.distance(tails.target);
        }
        let around = heads.seen.iter().map(|&(first, before)| before + tails.lengths[usize::from(first)]);
        around.fold(f32::INFINITY, f32::min)
    }

    /// Where `way` leads next: its first corner, or `b`.
    #[inline]
    pub fn heading(&self, way: Way, b: Vec2) -> Vec2 {
        if way.is_straight() { b } else { self.corners[usize::from(way.first)].at }
    }

    /// The way once its first corner is passed.
    #[inline]
    pub fn after(&self, way: Way) -> Way {
        if way.first == way.last {
            return Way::STRAIGHT;
        }
        Way { first: self.graph.next(way.first, way.last), ..way }
    }

    /// Corners that lie ahead.
    pub fn corners_ahead(&self, mut way: Way) -> usize {
        let mut count = 0;
        while !way.is_straight() {
            way = self.after(way);
            count += 1;
        }
        count
    }

    /// `way` as seen from `c`, from which it may have been cut short: corners that need not be passed any more are left
    /// out, and a way whose first corner is hidden is looked for anew. None where there is none.
    pub fn renewed(&self, way: Way, c: Vec2, b: Vec2, sight: &mut Sight) -> Option<Way> {
        if self.barriers.blocks(c, self.heading(way, b)) {
            return self.way(c, b, sight);
        }
        let mut way = way;
        while !way.is_straight() {
            let after = self.after(way);
            if self.barriers.blocks(c, self.heading(after, b)) {
                break;
            }
            way = after;
        }
        Some(way)
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

    fn detour(walls: &[ActiveWall]) -> Detour {
        Detour::new(&walls.iter().collect::<Vec<_>>(), Vec2::ONE, &Progress::new()).unwrap()
    }

    fn distance(detour: &Detour, a: [f32; 2], b: [f32; 2]) -> f64 {
        f64::from(detour.distance(a.into(), b.into(), &mut Sight::default()))
    }

    /// The polygon around an end has its corners at 22.5 and 67.5 degrees, at clearance / cos 22.5.
    fn around_an_end(a: Vec2, b: Vec2, end: Vec2, outward: f32, clearance: f32) -> f64 {
        let angles = [-67.5f32, -22.5, 22.5, 67.5].map(|degrees| outward + degrees.to_radians());
        let radius = clearance / 22.5f32.to_radians().cos();
        let corners = angles.map(|angle| end + radius * Vec2::from_angle(angle));
        // The shortest of all ways that pass neighbouring corners in order, in either direction.
        let mut best = f64::INFINITY;
        for order in [[0, 1, 2, 3], [3, 2, 1, 0]] {
            for (i, k) in (0..4).flat_map(|i| (i..4).map(move |k| (i, k))) {
                let middle: Vec<Vec2> = order[i..=k].iter().map(|&n| corners[n]).collect();
                let way = [&[a][..], &middle, &[b]].concat();
                // The polygon touches the circle of the clearance from outside: no leg cuts into that circle.
                let clear = |w: &[Vec2]| stroke::distance_to_segment(end, w[0], w[1]) > clearance - 1e-6;
                let crosses = !way.windows(2).all(clear);
                if !crosses {
                    let length = way.windows(2).map(|w| f64::from(w[0].distance(w[1]))).sum();
                    best = best.min(length);
                }
            }
        }
        best
    }

    #[test]
    fn around_one_end_the_way_is_the_shortest_around_its_polygon() {
        let end = Vec2::new(0.5, 0.6);
        let detour = detour(&[wall(&[[0.5, 0.01], [0.5, 0.6]], 0.04)]);
        for (a, b) in [([0.3, 0.4], [0.7, 0.4]), ([0.2, 0.5], [0.9, 0.55]), ([0.45, 0.1], [0.7, 0.59])] {
            let expected = around_an_end(a.into(), b.into(), end, std::f32::consts::FRAC_PI_2, 0.02);
            // Rounding of single precision over a handful of legs.
            assert!((distance(&detour, a, b) - expected).abs() < 1e-6, "{a:?} to {b:?}");
        }
    }

    #[test]
    fn around_a_thin_wall_the_way_touches_its_end() {
        let detour = detour(&[wall(&[[0.5, 0.005], [0.5, 0.6]], 2e-4)]);
        let expected = 2.0 * f64::hypot(0.2, 0.2);
        let found = distance(&detour, [0.3, 0.4], [0.7, 0.4]);
        // The polygon's corners lie at most 1.09 clearances from the end.
        assert!(found >= expected && found < expected + 4.0 * 1.1e-4, "{found}");
        assert_eq!(distance(&detour, [0.3, 0.7], [0.7, 0.7]), f64::from(0.7f32 - 0.3));
    }

    #[test]
    fn out_of_a_labyrinth_the_way_passes_every_turn() {
        // Two walls that leave an S: up through the gap at the top, down again through the gap at the bottom.
        let walls = [wall(&[[0.3, 0.0], [0.3, 0.9]], 2e-4), wall(&[[0.6, 0.1], [0.6, 1.0]], 2e-4)];
        let detour = detour(&walls);
        let legs = [[0.1, 0.1], [0.3, 0.9], [0.6, 0.1], [0.9, 0.9]].map(Vec2::from);
        let expected: f32 = legs.windows(2).map(|w| w[0].distance(w[1])).sum();
        let found = distance(&detour, [0.1, 0.1], [0.9, 0.9]);
        assert!((found - f64::from(expected)).abs() < 1e-3, "{found} against {expected}");
        let way = detour.way(legs[0], legs[3], &mut Sight::default()).unwrap();
        assert!(detour.corners_ahead(way) >= 2 && detour.longest() >= 2);
    }

    #[test]
    fn a_closed_wall_and_one_across_everything_leave_no_way() {
        let square = [[0.4, 0.4], [0.6, 0.4], [0.6, 0.6], [0.4, 0.6], [0.4, 0.4]];
        let almost = [[0.4, 0.4], [0.6, 0.4], [0.6, 0.6], [0.4, 0.6], [0.4, 0.41]];
        for points in [&square, &almost] {
            let detour = detour(&[wall(points, 0.03)]);
            assert_eq!(distance(&detour, [0.5, 0.5], [0.9, 0.5]), f64::INFINITY);
            assert!(distance(&detour, [0.1, 0.5], [0.9, 0.5]).is_finite());
        }
        let across = detour(&[wall(&[[0.0, 0.5], [1.0, 0.5]], 0.03)]);
        assert_eq!(distance(&across, [0.5, 0.2], [0.5, 0.8]), f64::INFINITY);
        assert_eq!(across.barriers().notes().len(), 1);
    }

    #[test]
    fn a_gap_narrower_than_the_walls_is_closed_and_a_wider_one_is_open() {
        let gap = |gap: f32| {
            detour(&[wall(&[[0.0, 0.5], [0.5, 0.5]], 0.02), wall(&[[0.5 + gap, 0.5], [1.0, 0.5]], 0.02)])
        };
        assert_eq!(distance(&gap(0.015), [0.5, 0.2], [0.5, 0.8]), f64::INFINITY);
        assert!(distance(&gap(0.03), [0.5, 0.2], [0.5, 0.8]) < 0.62);
        let touching =
            detour(&[wall(&[[0.0, 0.5], [1.0, 0.5]], 0.02), wall(&[[0.5, 0.5], [0.5, 1.0]], 0.02)]);
        assert_eq!(distance(&touching, [0.4, 0.8], [0.6, 0.8]), f64::INFINITY);
    }

    /// Reference: Bellman and Ford's algorithm over all corners, tangents or not. The walls are so thin that a way which
    /// cuts a corner's polygon saves at most its size, 2 clearances, at each of at most eight ends.
    #[test]
    fn leaving_out_what_is_no_tangent_loses_no_shortest_way() {
        let mut random = Stream::new(5, Purpose::Trace, 0, 0);
        let mut point = || [0.1 + 0.8 * random.f32(), 0.1 + 0.8 * random.f32()];
        for _ in 0..20 {
            let walls: Vec<_> = (0..4).map(|_| wall(&[point(), point(), point()], 2e-4)).collect();
            let detour = detour(&walls);
            let sites: Vec<Vec2> = detour.corners.iter().map(|c| c.at).collect();
            for _ in 0..20 {
                let (a, b) = (Vec2::from(point()), Vec2::from(point()));
                let found = detour.distance(a, b, &mut Sight::default());
                let reference = bellman_ford(&detour.barriers, a, b, &sites);
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
