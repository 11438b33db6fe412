//! The search for triangles that lie in one another.

use glam::{DVec2, DVec3, Vec3};
use rayon::prelude::*;
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};

use super::super::accel::Triangle;
use crate::{Progress, Result};

/// Distance (m) within which two planes are told apart by rounding alone, for coordinates up to `largest` (m): a coordinate
/// is rounded to f32 in its file and once more when it is placed, each time by up to 6e-8 of it; twice that for two surfaces,
/// a quarter more for the share of all three axes.
pub(super) fn rounding(largest: f32) -> f64 {
    3e-7 * f64::from(largest)
}

/// Largest coordinate of a triangle (m).
pub(super) fn largest(corners: &[Vec3; 3]) -> f32 {
    corners.iter().map(|corner| corner.abs().max_element()).fold(0.0, f32::max)
}

/// Distance, in roundings, within which two surfaces nearly touch: their authors meant contact, and coordinates of a few
/// digits keep them apart, here a film of air and there an overlap.
pub(super) const NEARLY: f64 = 100.0;

/// Lower and upper corner, enlarged so that boxes of surfaces that nearly touch overlap.
fn bounds(corners: &[Vec3; 3]) -> (Vec3, Vec3) {
    let [a, b, c] = *corners;
    let margin = Vec3::splat((NEARLY * rounding(largest(corners))) as f32);
    (a.min(b).min(c) - margin, a.max(b).max(c) + margin)
}

/// A plane with two axes in it.
#[derive(Clone, Copy)]
pub(super) struct Frame {
    origin: DVec3,
    x: DVec3,
    y: DVec3,
    normal: DVec3,
}

impl Frame {
    /// That of a triangle, by its winding.
    pub(super) fn of(corners: &[Vec3; 3]) -> Self {
        let [a, b, c] = corners.map(|corner| corner.as_dvec3());
        let normal = (b - a).cross(c - a).normalize_or(DVec3::Y);
        let (x, y) = normal.any_orthonormal_pair();
        // Right-handed: a triangle of the plane's winding is counter-clockwise in it.
        let y = if x.cross(y).dot(normal) < 0.0 { -y } else { y };
        Self { origin: a, x, y, normal }
    }

    pub(super) fn flat(&self, point: DVec3) -> DVec2 {
        let offset = point - self.origin;
        DVec2::new(offset.dot(self.x), offset.dot(self.y))
    }

    pub(super) fn height(&self, point: DVec3) -> f64 {
        (point - self.origin).dot(self.normal)
    }

    pub(super) fn point(&self, flat: DVec2) -> DVec3 {
        self.origin + self.x * flat.x + self.y * flat.y
    }
}

/// Twice the signed area.
pub(super) fn area2(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - a)
}

/// How far two triangles are apart that nearly lie in one another (m), the most over their common part, which is wider than
/// that; and whether it is rounding alone.
fn apart(a: &[Vec3; 3], b: &[Vec3; 3]) -> Option<(f64, bool)> {
    let size = |c: &[Vec3; 3]| (c[1] - c[0]).cross(c[2] - c[0]).length_squared();
    let (large, small) = if size(a) >= size(b) { (a, b) } else { (b, a) };
    let tolerance = rounding(largest(a).max(largest(b)));
    let near = NEARLY * tolerance;
    let frame = Frame::of(large);
    let mut part: Vec<DVec3> = small.map(|corner| corner.as_dvec3()).to_vec();
    let heights = part.iter().map(|point| frame.height(*point));
    let (low, high) = heights.fold((f64::MAX, f64::MIN), |(l, h), z| (l.min(z), h.max(z)));
    if low > near || high < -near {
        return None;
    }
    let corners = large.map(|corner| frame.flat(corner.as_dvec3()));
    for side in 0..3 {
        let (from, to) = (corners[side], corners[(side + 1) % 3]);
        part = clip(&part, |point| area2(from, to, frame.flat(point)));
    }
    let distance = part.iter().map(|point| frame.height(*point).abs()).fold(0.0, f64::max);
    if part.len() < 3 || distance > near {
        return None;
    }
    let flat: Vec<DVec2> = part.iter().map(|point| frame.flat(*point)).collect();
    let area: f64 = (1..flat.len() - 1).map(|i| area2(flat[0], flat[i], flat[i + 1])).sum();
    let longest = flat.iter().flat_map(|a| flat.iter().map(|b| a.distance(*b))).fold(0.0, f64::max);
    let is_touching = distance <= tolerance;
    let width = 8.0 * if is_touching { tolerance } else { near };
    (area.abs() > width * longest).then_some((distance, is_touching))
}

/// The part of a convex polygon where `inside` is not negative (Sutherland & Hodgman 1974).
fn clip(polygon: &[DVec3], inside: impl Fn(DVec3) -> f64) -> Vec<DVec3> {
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (i, &to) in polygon.iter().enumerate() {
        let from = polygon[(i + polygon.len() - 1) % polygon.len()];
        let (before, after) = (inside(from), inside(to));
        if (before < 0.0) != (after < 0.0) {
            kept.push(from.lerp(to, before / (before - after)));
        }
        if after >= 0.0 {
            kept.push(to);
        }
    }
    kept
}

/// Pairs of triangles of different shells, each as (lower, higher) index.
pub(super) struct Pairs {
    /// Those that lie in one another, sorted.
    pub touching: Vec<(u32, u32)>,
    /// Those that nearly do, with their distance (m).
    pub near: Vec<(u32, u32, f64)>,
}

/// The pairs of triangles that lie in one another, or nearly.
pub(super) fn touching(triangles: &[Triangle], shells: &[u32], progress: &Progress) -> Result<Pairs> {
    let near = near_other_shells(triangles, shells);
    let item = |index: &u32| {
        let (lower, upper) = bounds(&triangles[*index as usize].corners);
        let aabb = AABB::from_corners(lower.to_array(), upper.to_array());
        GeomWithData::new(Rectangle::from_aabb(aabb), *index)
    };
    let tree = RTree::bulk_load(near.iter().map(item).collect());
    progress.check()?;
    let pairs_of = |&index: &u32| -> Result<Vec<(u32, u32, f64, bool)>> {
        progress.check()?;
        let own = &triangles[index as usize].corners;
        let (lower, upper) = bounds(own);
        let met = tree
            .locate_in_envelope_intersecting(AABB::from_corners(lower.to_array(), upper.to_array()))
            .map(|item| item.data)
            .filter(|other| *other > index && shells[*other as usize] != shells[index as usize]);
        let pair = |other: u32| {
            let (distance, is_touching) = apart(own, &triangles[other as usize].corners)?;
            Some((index, other, distance, is_touching))
        };
        Ok(met.filter_map(pair).collect())
    };
    let pairs = near.par_iter().map(pairs_of).collect::<Result<Vec<_>>>()?.concat();
    let mut touching: Vec<_> = pairs.iter().filter(|pair| pair.3).map(|pair| (pair.0, pair.1)).collect();
    touching.sort_unstable();
    let near = pairs.into_iter().filter(|pair| !pair.3).map(|pair| (pair.0, pair.1, pair.2)).collect();
    Ok(Pairs { touching, near })
}

/// The triangles within the bounds of another shell than their own.
fn near_other_shells(triangles: &[Triangle], shells: &[u32]) -> Vec<u32> {
    let count = shells.iter().max().map_or(0, |last| *last as usize + 1);
    let mut boxes = vec![(Vec3::INFINITY, Vec3::NEG_INFINITY); count];
    for (triangle, shell) in triangles.iter().zip(shells) {
        let (lower, upper) = bounds(&triangle.corners);
        let of = &mut boxes[*shell as usize];
        *of = (of.0.min(lower), of.1.max(upper));
    }
    let item = |(shell, (lower, upper)): (usize, &(Vec3, Vec3))| {
        let aabb = AABB::from_corners(lower.to_array(), upper.to_array());
        GeomWithData::new(Rectangle::from_aabb(aabb), shell as u32)
    };
    let tree = RTree::bulk_load(boxes.iter().enumerate().map(item).collect());
    let is_near = |index: &u32| {
        let (lower, upper) = bounds(&triangles[*index as usize].corners);
        let envelope = AABB::from_corners(lower.to_array(), upper.to_array());
        let own = shells[*index as usize];
        tree.locate_in_envelope_intersecting(envelope).any(|item| item.data != own)
    };
    if count < 2 {
        return Vec::new();
    }
    (0..triangles.len() as u32).into_par_iter().filter(is_near).collect()
}
