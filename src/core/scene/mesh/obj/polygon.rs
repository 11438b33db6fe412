//! Polygons split into triangles: convex ones into a fan, concave ones by ear clipping.

use earcut::{Earcut, utils3d::project3d_to_2d};
use glam::{DVec2, DVec3};

/// Most corners of a polygon for which every corner is tried as the tip of a fan.
const MANY: usize = 32;
/// Most corners of a polygon that is split by ear clipping: the time for those that cross themselves grows with the square.
const MOST: usize = 4096;
/// Share of its size squared below which a triangle counts as flat.
const FLAT: f64 = 1e-9;

/// Splits polygons, one after another.
#[derive(Default)]
pub(super) struct Splitter {
    earcut: Earcut<f64>,
    corners: Vec<[f64; 3]>,
    flat: Vec<[f64; 2]>,
    triangles: Vec<u32>,
}

impl Splitter {
    /// Three corners of `polygon` for each triangle, wound as it is, and whether they cover its outline.
    pub(super) fn split(&mut self, polygon: &[DVec3]) -> (&[u32], bool) {
        let count = polygon.len();
        self.triangles.clear();
        if count < 4 {
            self.triangles.extend(0..count as u32);
            return (&self.triangles, true);
        }
        // Relative to a corner, so that no digits are lost far from the origin.
        self.corners.clear();
        self.corners.extend(polygon.iter().map(|corner| (corner - polygon[0]).to_array()));
        if !project3d_to_2d(&self.corners, count, &mut self.flat) {
            self.fan(0);
            return (&self.triangles, true);
        }
        let least = FLAT * self.size().powi(2);
        let tips = if count <= MANY { count } else { 1 };
        if let Some(tip) = (0..tips).find(|tip| self.fan_areas(*tip).all(|area| area > least)) {
            self.fan(tip);
            return (&self.triangles, true);
        }
        if count > MOST {
            self.fan(0);
            return (&self.triangles, false);
        }
        self.earcut.earcut(self.flat.iter().copied(), &[], &mut self.triangles);
        self.restore();
        let outline: f64 = self.fan_areas(0).sum();
        let covered: f64 = self.triangles.as_chunks().0.iter().map(|t: &[u32; 3]| self.area(*t).abs()).sum();
        // Rounding of the areas is far below, a crossing far above.
        let whole = (covered - outline).abs() <= 1e-6 * covered.max(outline.abs());
        if self.triangles.is_empty() {
            self.fan(0);
        }
        (&self.triangles, whole)
    }

    fn size(&self) -> f64 {
        let points = || self.flat.iter().copied().map(DVec2::from);
        let (lower, upper) = (points().reduce(DVec2::min), points().reduce(DVec2::max));
        lower.zip(upper).map_or(0.0, |(lower, upper)| (upper - lower).max_element())
    }

    fn fan(&mut self, tip: usize) {
        let count = self.corners.len();
        let corner = |i: usize| ((tip + i) % count) as u32;
        self.triangles.extend((1..count - 1).flat_map(|i| [corner(0), corner(i), corner(i + 1)]));
    }

    /// Twice the areas of the triangles of a fan.
    fn fan_areas(&self, tip: usize) -> impl Iterator<Item = f64> {
        let count = self.flat.len();
        let corner = move |i: usize| ((tip + i) % count) as u32;
        (1..count - 1).map(move |i| self.area([corner(0), corner(i), corner(i + 1)]))
    }

    /// Twice the area of a triangle, negative if it is wound against the polygon.
    fn area(&self, corners: [u32; 3]) -> f64 {
        let [a, b, c] = corners.map(|corner| DVec2::from(self.flat[corner as usize]));
        (b - a).perp_dot(c - a)
    }

    /// Puts corners back that lie straight between two others: ear clipping leaves them out, the face beyond the edge does
    /// not.
    fn restore(&mut self) {
        let count = self.flat.len();
        let mut used = vec![false; count];
        self.triangles.iter().for_each(|corner| used[*corner as usize] = true);
        let Some(start) = used.iter().position(|used| *used) else { return };
        let mut left = start;
        for step in 1..=count {
            let corner = (start + step) % count;
            if !used[corner] {
                continue;
            }
            let lost = (corner + count - left) % count;
            if lost > 1 {
                self.split_edge(left, lost);
            }
            left = corner;
        }
    }

    /// Splits the triangle over the edge from corner `from` to the one `steps` later at all corners between.
    fn split_edge(&mut self, from: usize, steps: usize) {
        let corner = |i: usize| ((from + i) % self.flat.len()) as u32;
        let (a, b) = (corner(0), corner(steps));
        let (triangles, _) = self.triangles.as_chunks_mut::<3>();
        let Some((triangle, turn)) = triangles.iter_mut().find_map(|triangle| {
            let turn = (0..3).find(|k| triangle[*k] == a && triangle[(k + 1) % 3] == b)?;
            Some((triangle, turn))
        }) else {
            return;
        };
        let tip = triangle[(turn + 2) % 3];
        *triangle = [corner(0), corner(1), tip];
        let more: Vec<u32> = (1..steps).flat_map(|i| [corner(i), corner(i + 1), tip]).collect();
        self.triangles.extend(more);
    }
}
