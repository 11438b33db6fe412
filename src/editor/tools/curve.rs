//! Freehand strokes become few points: cubic curves are fitted to them, and drawn as polylines again.
//!
//! Schneider, "An algorithm for automatically fitting digitized curves", Graphics Gems (1990); corners, which it would
//! round, are kept apart before.

use glam::Vec2;
use lightloom_core::constraint::stroke;

/// Most steps of Newton's method that bring the parameters nearer to the points.
const REFINEMENTS: usize = 4;
/// Cosine of the turn that makes a corner: 60 degrees.
const CORNER: f32 = 0.5;

type Cubic = [Vec2; 4];

/// Fewer points for the stroke through `points`: all of the stroke lies within twice `tolerance` (plane units) of the
/// polyline through them, and both of its ends among them.
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
    let corners = corners(&apart, 5.0 * tolerance);
    for span in corners.windows(2) {
        let span = &apart[span[0]..=span[1]];
        let mut cubics = Vec::new();
        fit_span(
            span,
            tangent(span.iter(), tolerance),
            tangent(span.iter().rev(), tolerance),
            tolerance,
            &mut cubics,
        );
        for cubic in cubics {
            flatten(&cubic, 0.5 * tolerance, &mut fitted);
        }
    }
    stroke::simplify(&fitted, 0.4 * tolerance)
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

/// The direction in which a stroke sets out: towards its first point that is some way off.
fn tangent<'a>(mut points: impl DoubleEndedIterator<Item = &'a Vec2> + Clone, tolerance: f32) -> Vec2 {
    let Some(&from) = points.next() else { return Vec2::X };
    let far = points.clone().find(|p| p.distance(from) > 2.0 * tolerance).or_else(|| points.next_back());
    far.map_or(Vec2::X, |&p| (p - from).normalize_or(Vec2::X))
}

fn fit_span(points: &[Vec2], start: Vec2, end: Vec2, tolerance: f32, out: &mut Vec<Cubic>) {
    let (first, last) = (points[0], points[points.len() - 1]);
    if points.len() < 3 {
        out.push(arc(first, last, start, end, [first.distance(last) / 3.0; 2]));
        return;
    }
    let mut parameters = chord_parameters(points);
    let mut worst = 1;
    for _ in 0..=REFINEMENTS {
        let cubic = least_squares(points, &parameters, start, end);
        let (at, error) = farthest(points, &parameters, &cubic);
        if error <= tolerance {
            out.push(cubic);
            return;
        }
        worst = at;
        if error > 4.0 * tolerance {
            break;
        }
        for (parameter, &point) in parameters.iter_mut().zip(points) {
            *parameter = newton(&cubic, point, *parameter);
        }
    }
    let middle = (points[worst - 1] - points[worst + 1]).normalize_or((first - last).normalize_or(Vec2::X));
    fit_span(&points[..=worst], start, middle, tolerance, out);
    fit_span(&points[worst..], -middle, end, tolerance, out);
}

fn arc(first: Vec2, last: Vec2, start: Vec2, end: Vec2, reach: [f32; 2]) -> Cubic {
    [first, first + start * reach[0], last + end * reach[1], last]
}

/// Shares of the length at each point, 0..=1.
fn chord_parameters(points: &[Vec2]) -> Vec<f32> {
    let total = stroke::length(points).max(f32::MIN_POSITIVE);
    let mut walked = 0.0;
    let lengths = points.windows(2).map(|pair| {
        walked += pair[0].distance(pair[1]);
        walked / total
    });
    std::iter::once(0.0).chain(lengths).collect()
}

fn weights(t: f32) -> [f32; 4] {
    let s = 1.0 - t;
    [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t]
}

fn point(cubic: &Cubic, t: f32) -> Vec2 {
    weights(t).iter().zip(cubic).map(|(w, p)| *p * *w).sum()
}

/// The curve of given end tangents that is nearest to the points at their parameters.
fn least_squares(points: &[Vec2], parameters: &[f32], start: Vec2, end: Vec2) -> Cubic {
    let (first, last) = (points[0], points[points.len() - 1]);
    let (mut c, mut x) = ([[0.0f32; 2]; 2], [0.0f32; 2]);
    for (&p, &t) in points.iter().zip(parameters) {
        let w = weights(t);
        let (a, b) = (start * w[1], end * w[2]);
        let rest = p - first * (w[0] + w[1]) - last * (w[2] + w[3]);
        c[0][0] += a.dot(a);
        c[0][1] += a.dot(b);
        c[1][1] += b.dot(b);
        x[0] += a.dot(rest);
        x[1] += b.dot(rest);
    }
    let determinant = c[0][0] * c[1][1] - c[0][1] * c[0][1];
    let chord = first.distance(last);
    let reach =
        [(x[0] * c[1][1] - x[1] * c[0][1]) / determinant, (c[0][0] * x[1] - c[0][1] * x[0]) / determinant];
    // Handles that point back, or far beyond the stroke, make loops; a third of the chord never does.
    let longest = 2.0 * stroke::length(points);
    let sound = reach.iter().all(|r| (1e-3 * chord..=longest).contains(r) && *r > 0.0);
    arc(first, last, start, end, if sound { reach } else { [chord / 3.0; 2] })
}

/// The inner point that is farthest from the curve, and its distance.
fn farthest(points: &[Vec2], parameters: &[f32], cubic: &Cubic) -> (usize, f32) {
    let distances = (1..points.len() - 1).map(|i| (i, points[i].distance(point(cubic, parameters[i]))));
    distances.max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((1, 0.0))
}

/// A parameter at which the curve is nearer to `p`.
fn newton(cubic: &Cubic, p: Vec2, t: f32) -> f32 {
    let s = 1.0 - t;
    let [a, b, c] = [cubic[1] - cubic[0], cubic[2] - cubic[1], cubic[3] - cubic[2]];
    let first = (a * (s * s) + b * (2.0 * s * t) + c * (t * t)) * 3.0;
    let second = ((b - a) * s + (c - b) * t) * 6.0;
    let off = point(cubic, t) - p;
    let slope = first.dot(first) + off.dot(second);
    if slope.abs() < f32::MIN_POSITIVE { t } else { (t - off.dot(first) / slope).clamp(0.0, 1.0) }
}

/// Appends points of the curve after its first, so dense that the polyline strays by less than `tolerance`.
fn flatten(cubic: &Cubic, tolerance: f32, out: &mut Vec<Vec2>) {
    let bend =
        (cubic[0] - 2.0 * cubic[1] + cubic[2]).length().max((cubic[1] - 2.0 * cubic[2] + cubic[3]).length());
    let steps = (0.75 * bend / tolerance).sqrt().ceil().clamp(1.0, 200.0) as usize;
    out.extend((1..=steps).map(|i| point(cubic, i as f32 / steps as f32)));
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use glam::vec2;

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
    fn dots_and_straight_strokes_are_no_trouble() {
        assert_eq!(fit(&[Vec2::ONE], TOLERANCE), [Vec2::ONE]);
        assert!(fit(&[], TOLERANCE).is_empty());
        let there_and_back = [vec2(0.0, 0.0), vec2(0.5, 0.0), vec2(0.0, 0.0)];
        assert!(stray(&there_and_back, &fit(&there_and_back, TOLERANCE)) <= 2.0 * TOLERANCE);
        let straight: Vec<Vec2> = (0..50).map(|i| vec2(0.01 * i as f32, 0.2)).collect();
        assert_eq!(fit(&straight, TOLERANCE).len(), 2);
    }
}
