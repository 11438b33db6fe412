//! Representatives of cells that hold equal numbers of points.

use glam::Vec2;

/// `count` representatives of as many equally large parts of `points`, from recursive median cuts of the longer side; each
/// is the point of its part nearest to the part's mean. `count` is a power of two, at most the
/// number of points.
pub(super) fn representatives(points: &[Vec2], count: usize) -> Vec<Vec2> {
    let mut points = points.to_vec();
    let mut found = Vec::with_capacity(count);
    cut(&mut points, count, &mut found);
    found
}

fn cut(points: &mut [Vec2], count: usize, found: &mut Vec<Vec2>) {
    if count <= 1 {
        let mean = points.iter().copied().sum::<Vec2>() / points.len().max(1) as f32;
        let nearer = |a: &&Vec2, b: &&Vec2| a.distance_squared(mean).total_cmp(&b.distance_squared(mean));
        found.extend(points.iter().min_by(nearer));
        return;
    }
    let (mut low, mut high) = (Vec2::INFINITY, Vec2::NEG_INFINITY);
    for &point in &*points {
        (low, high) = (low.min(point), high.max(point));
    }
    let axis = usize::from((high - low).y > (high - low).x);
    let middle = points.len() / 2;
    points.select_nth_unstable_by(middle, |a, b| a[axis].total_cmp(&b[axis]));
    let (below, above) = points.split_at_mut(middle);
    cut(below, count / 2, found);
    cut(above, count / 2, found);
}
