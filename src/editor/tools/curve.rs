//! Freehand strokes as polylines of few points: smoothed between corners, joined by a spline, and simplified.

use glam::{Vec2, vec2};
use kurbo::{BezPath, PathEl, Point};
use lightloom_core::constraint::stroke;

/// Cosine of the turn that makes a corner: 60 degrees.
const CORNER: f32 = 0.5;
/// Standard deviation of the Gaussian that smooths, tolerances along the stroke.
const SIGMA: f32 = 4.0;

/// A polyline of few points along a stroke, with both of its ends. Every point of the stroke lies within twice
/// `tolerance` (plane units) of it: dropping close points adds a quarter, smoothing one, simplification 0.7.
pub(super) fn fit(points: &[Vec2], tolerance: f32) -> Vec<Vec2> {
    let mut apart: Vec<Vec2> = Vec::with_capacity(points.len());
    for &point in points {
        if apart.last().is_none_or(|last| last.distance(point) > 0.25 * tolerance) {
            apart.push(point);
        }
    }
    if let (Some(end), Some(&last), true) = (apart.last_mut(), points.last(), points.len() > 1) {
        *end = last;
    }
    if apart.len() < 3 {
        return apart;
    }
    let mut fitted = vec![apart[0]];
    for span in corners(&apart, 5.0 * tolerance).windows(2) {
        let smooth = smoothed(&apart[span[0]..=span[1]], tolerance);
        kurbo::flatten(spline(&smooth), f64::from(0.2 * tolerance), |element| {
            if let PathEl::LineTo(p) = element {
                fitted.push(vec2(p.x as f32, p.y as f32));
            }
        });
    }
    stroke::simplify(&fitted, 0.7 * tolerance)
}

/// Indices of both ends and of the corners between: where the stroke turns by more than 60 degrees within `reach`.
fn corners(points: &[Vec2], reach: f32) -> Vec<usize> {
    let last = points.len() - 1;
    let mut corners = vec![0];
    let turn = |i: usize| {
        let before = points[..i].iter().rev().find(|p| p.distance(points[i]) >= reach)?;
        let after = points[i..].iter().find(|p| p.distance(points[i]) >= reach)?;
        Some((points[i] - *before).normalize_or_zero().dot((*after - points[i]).normalize_or_zero()))
    };
    let turns: Vec<Option<f32>> =
        (0..=last).map(|i| if i == 0 || i == last { None } else { turn(i) }).collect();
    let mut sharpest: Option<usize> = None;
    for i in 0..=last {
        let sharp = turns[i].is_some_and(|cosine| cosine < CORNER);
        if sharp && sharpest.is_none_or(|s| turns[i] < turns[s]) {
            sharpest = Some(i);
        }
        if !sharp && let Some(corner) = sharpest.take() {
            corners.push(corner);
        }
    }
    corners.push(last);
    corners
}

/// The points after a Gaussian along the stroke, each moved by `tolerance` at most. The window shrinks towards the ends,
/// which stay where they are.
fn smoothed(points: &[Vec2], tolerance: f32) -> Vec<Vec2> {
    let sigma = SIGMA * tolerance;
    let mut walked = 0.0;
    let steps = points.windows(2).map(|pair| {
        walked += pair[0].distance(pair[1]);
        walked
    });
    let at: Vec<f32> = std::iter::once(0.0).chain(steps).collect();
    let total = at[at.len() - 1];
    let smooth = |i: usize| {
        let reach = (3.0 * sigma).min(at[i]).min(total - at[i]);
        let window = at.partition_point(|s| *s < at[i] - reach)..at.partition_point(|s| *s <= at[i] + reach);
        let (mut sum, mut weights) = (points[i], 1.0);
        for k in window.filter(|k| *k != i) {
            let weight = (-0.5 * ((at[k] - at[i]) / sigma).powi(2)).exp();
            sum += points[k] * weight;
            weights += weight;
        }
        points[i] + (sum / weights - points[i]).clamp_length_max(tolerance)
    };
    (0..points.len()).map(|i| if i == 0 || i + 1 == points.len() { points[i] } else { smooth(i) }).collect()
}

/// The Catmull-Rom spline through the points.
fn spline(points: &[Vec2]) -> BezPath {
    let point = |p: Vec2| Point::new(p.x.into(), p.y.into());
    let last = points.len() - 1;
    let slope = |i: usize| (points[(i + 1).min(last)] - points[i.saturating_sub(1)]) / 6.0;
    let mut path = BezPath::new();
    path.move_to(point(points[0]));
    for i in 0..last {
        let (from, to) = (points[i] + slope(i), points[i + 1] - slope(i + 1));
        path.curve_to(point(from), point(to), point(points[i + 1]));
    }
    path
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    const TOLERANCE: f32 = 0.002;

    fn stray(points: &[Vec2], line: &[Vec2]) -> f32 {
        let distance = |p: Vec2| {
            line.windows(2).map(|s| stroke::distance_to_segment(p, s[0], s[1])).fold(f32::INFINITY, f32::min)
        };
        points.iter().map(|&p| distance(p)).fold(0.0, f32::max)
    }

    #[test]
    fn a_shaky_circle_becomes_few_points_near_it() {
        let shaky: Vec<Vec2> = (0..500)
            .map(|i| {
                let angle = i as f32 / 500.0 * std::f32::consts::TAU;
                let shake = 0.0008 * (37.0 * angle).sin();
                vec2(0.5, 0.5) + Vec2::from_angle(angle) * (0.3 + shake)
            })
            .collect();
        let line = fit(&shaky, TOLERANCE);
        // A tenth of what was drawn.
        assert!(line.len() <= 50, "{}", line.len());
        assert!(stray(&shaky, &line) <= 2.0 * TOLERANCE);
        assert_eq!((line[0], *line.last().unwrap()), (shaky[0], shaky[499]));
    }

    #[test]
    fn a_corner_stays_sharp() {
        let leg = |from: Vec2, to: Vec2| (0..100).map(move |i| from.lerp(to, i as f32 / 99.0));
        let (a, b, c) = (vec2(0.1, 0.1), vec2(0.5, 0.8), vec2(0.9, 0.1));
        let drawn: Vec<Vec2> = leg(a, b).chain(leg(b, c)).collect();
        let line = fit(&drawn, TOLERANCE);
        assert!(line.len() <= 5, "{line:?}");
        // The points next to the corner lie 0.008 apart.
        assert!(line.iter().any(|p| p.distance(b) < 0.004), "{line:?}");
    }

    #[test]
    fn the_noise_of_a_hand_leaves_few_points_on_a_straight_line() {
        // Off by up to 0.7 of the tolerance, on pixels of half a tolerance.
        let noise = |i: usize| 0.7 * TOLERANCE * ((i * i * 7919 % 1013) as f32 / 506.0 - 1.0);
        let pixel = |x: f32| (x / (0.5 * TOLERANCE)).round() * 0.5 * TOLERANCE;
        let drawn: Vec<Vec2> = (0..200)
            .map(|i| vec2(pixel(0.1 + 0.004 * i as f32), pixel(0.2 + 0.001 * i as f32 + noise(i))))
            .collect();
        let line = fit(&drawn, TOLERANCE);
        assert!(line.len() <= 30, "{}", line.len());
        assert!(stray(&drawn, &line) <= 2.0 * TOLERANCE);
    }

    #[test]
    fn dots_and_straight_strokes_are_no_trouble() {
        assert_eq!(fit(&[Vec2::ONE], TOLERANCE), [Vec2::ONE]);
        assert!(fit(&[], TOLERANCE).is_empty());
        let there_and_back = [vec2(0.0, 0.0), vec2(0.5, 0.0), vec2(0.0, 0.0)];
        assert!(stray(&there_and_back, &fit(&there_and_back, TOLERANCE)) <= 2.0 * TOLERANCE);
        let straight: Vec<Vec2> = (0..50).map(|i| vec2(0.01 * i as f32, 0.2)).collect();
        assert_eq!(fit(&straight, TOLERANCE).len(), 2);
    }
}
