//! Cutting discs out of polylines.

use glam::Vec2;

use super::arrange::is_loop;

/// The parts of a polyline outside of a disc; the whole polyline where the disc does not touch it.
pub(super) fn cut(points: &[Vec2], centre: Vec2, radius: f32) -> Vec<Vec<Vec2>> {
    let mut parts: Vec<Vec<Vec2>> = Vec::new();
    let mut part: Vec<Vec2> = Vec::new();
    for pair in points.windows(2) {
        let (a, b) = (pair[0], pair[1]);
        let Some([enter, leave]) = inside(a, b, centre, radius) else {
            if part.is_empty() {
                part.push(a);
            }
            part.push(b);
            continue;
        };
        if enter > 0.0 {
            if part.is_empty() {
                part.push(a);
            }
            part.push(a.lerp(b, enter));
        }
        parts.push(std::mem::take(&mut part));
        if leave < 1.0 {
            part.extend([a.lerp(b, leave), b]);
        }
    }
    parts.push(part);
    // A loop that was cut elsewhere continues through its start.
    let untouched = |p: Option<&Vec2>| p.is_some_and(|p| p.distance(centre) > radius);
    if parts.len() > 1 && is_loop(points) && untouched(points.first()) {
        let begin = parts.remove(0);
        if let Some(end) = parts.last_mut() {
            end.extend(begin.into_iter().skip(1));
        }
    }
    parts.retain(|part| part.len() > 1);
    parts
}

/// The parameters in 0..=1 between which the segment from `a` to `b` is inside the disc.
fn inside(a: Vec2, b: Vec2, centre: Vec2, radius: f32) -> Option<[f32; 2]> {
    let (along, off) = (b - a, a - centre);
    let squared = along.length_squared();
    if squared <= 0.0 {
        return (off.length() < radius).then_some([0.0, 1.0]);
    }
    let nearest = -off.dot(along) / squared;
    let reach = (radius * radius - (off + along * nearest).length_squared()) / squared;
    if reach <= 0.0 {
        return None;
    }
    let (enter, leave) = (nearest - reach.sqrt(), nearest + reach.sqrt());
    (enter < 1.0 && leave > 0.0).then_some([enter.max(0.0), leave.min(1.0)])
}

#[cfg(test)]
mod tests {
    use glam::vec2;
    use lightloom_core::constraint::stroke;

    use super::*;

    #[test]
    fn a_disc_takes_its_diameter_out_of_a_line() {
        let line = [vec2(0.0, 0.0), vec2(0.5, 0.0), vec2(1.0, 0.0)];
        let parts = cut(&line, vec2(0.3, 0.0), 0.1);
        assert_eq!(parts.len(), 2);
        let left: f32 = parts.iter().map(|part| stroke::length(part)).sum();
        assert!((left - 0.8).abs() < 1e-5);
        assert_eq!(cut(&line, vec2(0.3, 0.2), 0.1), [line.to_vec()]);
    }

    #[test]
    fn a_loop_that_is_cut_once_stays_in_one_piece() {
        let square = [vec2(0.0, 0.0), vec2(1.0, 0.0), vec2(1.0, 1.0), vec2(0.0, 1.0), vec2(0.0, 0.0)];
        let parts = cut(&square, vec2(1.0, 0.5), 0.1);
        assert_eq!(parts.len(), 1);
        assert!((stroke::length(&parts[0]) - 3.8).abs() < 1e-5);
        let at_its_begin = cut(&square, vec2(0.0, 0.0), 0.1);
        assert_eq!(at_its_begin.len(), 1);
        assert!((stroke::length(&at_its_begin[0]) - 3.8).abs() < 1e-5);
    }

    #[test]
    fn nothing_is_left_of_what_lies_in_the_disc() {
        assert!(cut(&[vec2(0.0, 0.0), vec2(0.01, 0.0), vec2(0.02, 0.01)], Vec2::ZERO, 0.1).is_empty());
    }
}
