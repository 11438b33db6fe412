//! Polylines as drawn: checked, cleaned, thinned, and walked along.

use glam::Vec2;

use crate::{Error, Result};

/// Limit of points of one stroke.
const MOST_POINTS: usize = 10_000;
/// Limit of |x| and |y| of a point, plane units.
const FARTHEST: f32 = 10.0;
/// Distance below which two points count as one, plane units: far below a cell of the finest grid.
const SAME: f32 = 1e-6;

/// Refuses points that are not finite or far off the plane, and too many of them.
pub(super) fn check(points: &[[f32; 2]], place: &str) -> Result<()> {
    if points.len() > MOST_POINTS {
        let what =
            format!("has {} points, the limit is {MOST_POINTS}; draw it with fewer points", points.len());
        return Err(Error::Limit { place: format!("{place}.points"), what });
    }
    let near = |value: &f32| value.abs() <= FARTHEST;
    match points.iter().position(|point| !point.iter().all(near)) {
        Some(i) => {
            let what = format!("is {:?}; give plane coordinates from -10 to 10", points[i]);
            Err(Error::value(format!("{place}.points[{i}]"), what))
        }
        None => Ok(()),
    }
}

/// The points without repetitions; empty where fewer than two are left.
pub fn clean(points: &[[f32; 2]]) -> Vec<Vec2> {
    let mut clean: Vec<Vec2> = Vec::with_capacity(points.len());
    for point in points.iter().map(|&p| Vec2::from(p)) {
        if clean.last().is_none_or(|last| last.distance(point) > SAME) {
            clean.push(point);
        }
    }
    if clean.len() < 2 {
        clean.clear();
    }
    clean
}

/// Length in plane units.
pub fn length(points: &[Vec2]) -> f32 {
    points.windows(2).map(|pair| pair[0].distance(pair[1])).sum()
}

/// Points at even distances of at most `spacing` along the stroke, both ends among them, at most `most` of them; with
/// the direction of the stroke at each, of length 1.
pub fn resample(points: &[Vec2], spacing: f32, most: usize) -> Vec<(Vec2, Vec2)> {
    let total = length(points);
    if points.len() < 2 || total <= 0.0 {
        return Vec::new();
    }
    let steps = ((total / spacing).ceil() as usize).clamp(1, most.max(2) - 1);
    let mut samples = Vec::with_capacity(steps + 1);
    let (mut segment, mut walked) = (0, 0.0);
    for i in 0..=steps {
        let wanted = total * i as f32 / steps as f32;
        let mut length = points[segment].distance(points[segment + 1]);
        while walked + length < wanted && segment + 2 < points.len() {
            walked += length;
            segment += 1;
            length = points[segment].distance(points[segment + 1]);
        }
        let (from, to) = (points[segment], points[segment + 1]);
        let share = ((wanted - walked) / length).clamp(0.0, 1.0);
        samples.push((from.lerp(to, share), (to - from).normalize_or_zero()));
    }
    samples
}

/// The stroke simplified to within `tolerance` (Ramer 1972, Douglas and Peucker 1973).
pub fn simplify(points: &[Vec2], tolerance: f32) -> Vec<Vec2> {
    let mut keep = vec![false; points.len()];
    if let [first, .., last] = &mut keep[..] {
        (*first, *last) = (true, true);
    }
    let mut open = vec![(0, points.len().saturating_sub(1))];
    while let Some((from, to)) = open.pop() {
        let distance = |i: usize| distance_to_segment(points[i], points[from], points[to]);
        let farthest = (from + 1..to).map(|i| (i, distance(i))).max_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((i, far)) = farthest
            && far > tolerance
        {
            keep[i] = true;
            open.extend([(from, i), (i, to)]);
        }
    }
    points.iter().zip(keep).filter_map(|(&point, keep)| keep.then_some(point)).collect()
}

/// The point of the segment from `a` to `b` that is nearest to `p`.
pub fn nearest_on_segment(p: Vec2, a: Vec2, b: Vec2) -> Vec2 {
    let along = b - a;
    let squared = along.length_squared();
    if squared <= 0.0 {
        return a;
    }
    a + along * ((p - a).dot(along) / squared).clamp(0.0, 1.0)
}

/// Distance of `p` from the segment from `a` to `b`.
pub fn distance_to_segment(p: Vec2, a: Vec2, b: Vec2) -> f32 {
    p.distance(nearest_on_segment(p, a, b))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn repeated_points_go_and_a_dot_is_no_stroke() {
        assert_eq!(clean(&[[0.0, 0.0], [0.0, 0.0], [1.0, 0.0]]), [Vec2::ZERO, Vec2::X]);
        assert!(clean(&[[0.3, 0.3]; 5]).is_empty());
        assert!(clean(&[]).is_empty());
    }

    #[test]
    fn samples_are_even_and_keep_both_ends() {
        let stroke = [Vec2::ZERO, Vec2::X, Vec2::ONE];
        let samples = resample(&stroke, 0.26, 100);
        assert_eq!(samples.len(), 9);
        assert_eq!((samples[0].0, samples[8].0), (Vec2::ZERO, Vec2::ONE));
        assert_eq!((samples[1].1, samples[7].1), (Vec2::X, Vec2::Y));
        for pair in samples.windows(2) {
            assert!((pair[0].0.distance(pair[1].0) - 0.25).abs() < 1e-6);
        }
    }

    #[test]
    fn thinning_keeps_within_its_tolerance() {
        let circle: Vec<Vec2> = (0..=100).map(|i| Vec2::from_angle(i as f32 / 20.0)).collect();
        let few = simplify(&circle, 0.01);
        assert!(few.len() < 40);
        for point in &circle {
            let nearest = few.windows(2).map(|w| distance_to_segment(*point, w[0], w[1]));
            assert!(nearest.fold(f32::INFINITY, f32::min) <= 0.01);
        }
    }

    #[test]
    fn points_off_the_plane_are_refused_by_their_number() {
        let error = check(&[[0.0, 0.0], [f32::NAN, 0.0]], "constraints[0]").unwrap_err();
        assert!(error.to_string().starts_with("constraints[0].points[1]"));
        assert!(check(&vec![[0.0, 0.0]; 10_001], "constraints[0]").is_err());
    }
}
