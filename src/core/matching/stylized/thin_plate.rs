//! The thin-plate warp through pairs of landmarks (Bookstein 1989): of all maps that take each landmark to its target the
//! one of least bending.
//!
//! ```text
//! f(x) = x + c + sum_axes c_d (x - m)_d + sum_k w_k U(|x - x_k|),   U(r) = r^2 log r
//! ```
//!
//! The weights w, with sums of w and of w x being zero, and the affine part c are found from one dense system. It is set up for
//! the displacements f(x) - x, which gives the same f, and leaves alone what the landmarks do not tell: a direction
//! in which they have no spread.

use glam::{DVec2, Vec2};

use crate::math::dense;

/// Landmarks nearer than this share of their spread count as one, bound for the mean of their targets. Where light is
/// focused they come so near that the warp through each would fold many times over.
const ONE_PLACE: f64 = 1e-3;
/// Spread of a direction over that of the other below which the landmarks lie on a line.
const ON_A_LINE: f64 = 1e-6;

/// A smooth map of the plane through given pairs.
#[derive(Clone, Debug, PartialEq, serde::Deserialize, serde::Serialize)]
pub(super) struct ThinPlate {
    middle: DVec2,
    /// Directions in which the landmarks have a spread, each over it: none, one or two.
    axes: Vec<DVec2>,
    /// Displacement of the middle, then its change along each axis.
    affine: Vec<DVec2>,
    /// Landmarks over the larger spread, from the middle.
    landmarks: Vec<DVec2>,
    weights: Vec<DVec2>,
    /// One over the larger spread.
    per_spread: f64,
}

impl ThinPlate {
    /// The warp that takes landmark i of `source` to `target[i]`.
    pub(super) fn new(source: &[DVec2], target: &[DVec2]) -> Self {
        let count = source.len().max(1) as f64;
        let middle = source.iter().sum::<DVec2>() / count;
        let (spread, axes) = spreads(source, middle);
        let per_spread = if spread > 0.0 { spread.recip() } else { 0.0 };
        let local = source.iter().map(|x| (*x - middle) * per_spread);
        let moves = source.iter().zip(target).map(|(a, b)| *b - *a);
        let (landmarks, moves) = merged(local, moves);
        let mut plate = Self { middle, axes, affine: Vec::new(), landmarks, weights: Vec::new(), per_spread };
        plate.solve(&moves);
        plate
    }

    /// Finds the weights for these displacements of the landmarks.
    fn solve(&mut self, moves: &[DVec2]) {
        let (points, affine) = (self.landmarks.len(), 1 + self.axes.len());
        let n = points + affine;
        let mut matrix = vec![0.0; n * n];
        for (i, &x) in self.landmarks.iter().enumerate() {
            for (k, other) in self.landmarks.iter().enumerate() {
                matrix[i * n + k] = kernel(x.distance_squared(*other));
            }
            for (d, part) in self.affine_parts(x).enumerate() {
                matrix[i * n + points + d] = part;
                matrix[(points + d) * n + i] = part;
            }
        }
        let mut right = moves.to_vec();
        right.resize(n, DVec2::ZERO);
        if !dense::solve(&mut matrix, &mut right) {
            // What is left when numbers run out: all go as the landmarks do on average.
            right.fill(DVec2::ZERO);
            right[points] = moves.iter().sum::<DVec2>() / points.max(1) as f64;
        }
        self.affine = right.split_off(points);
        self.weights = right;
    }

    /// Where `point` goes.
    pub(super) fn apply(&self, point: Vec2) -> Vec2 {
        let point = point.as_dvec2();
        let x = (point - self.middle) * self.per_spread;
        let affine = self.affine_parts(x).zip(&self.affine).map(|(part, c)| *c * part).sum::<DVec2>();
        let bending = self.landmarks.iter().zip(&self.weights);
        let bending = bending.map(|(other, w)| *w * kernel(x.distance_squared(*other))).sum::<DVec2>();
        (point + affine + bending).as_vec2()
    }

    /// 1 and the coordinates along the axes.
    fn affine_parts(&self, x: DVec2) -> impl Iterator<Item = f64> {
        std::iter::once(1.0).chain(self.axes.iter().map(move |axis| axis.dot(x)))
    }
}

/// U of a squared distance: r^2 log r = r^2 log(r^2) / 2.
#[inline(always)]
fn kernel(square: f64) -> f64 {
    if square > 0.0 { 0.5 * square * square.ln() } else { 0.0 }
}

/// The larger root mean square distance from the middle, and the principal directions that have any.
fn spreads(points: &[DVec2], middle: DVec2) -> (f64, Vec<DVec2>) {
    let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
    for offset in points.iter().map(|p| *p - middle) {
        xx += offset.x * offset.x;
        xy += offset.x * offset.y;
        yy += offset.y * offset.y;
    }
    // Eigenvalues and eigenvectors of a symmetric 2 x 2 matrix.
    let axis = DVec2::from_angle(0.5 * (2.0 * xy).atan2(xx - yy));
    let along = |axis: DVec2| {
        let square = points.iter().map(|p| (*p - middle).dot(axis).powi(2)).sum::<f64>();
        (square / points.len().max(1) as f64).sqrt()
    };
    let (large, small) = (along(axis), along(axis.perp()));
    let mut axes = Vec::new();
    if large > 0.0 {
        axes.push(axis);
        if small > ON_A_LINE * large {
            axes.push(axis.perp() * (large / small));
        }
    }
    (large, axes)
}

/// One landmark for each place, with the mean displacement of all that share it.
fn merged(
    landmarks: impl Iterator<Item = DVec2>,
    moves: impl Iterator<Item = DVec2>,
) -> (Vec<DVec2>, Vec<DVec2>) {
    let mut places: Vec<(DVec2, DVec2, f64)> = Vec::new();
    for (x, motion) in landmarks.zip(moves) {
        match places.iter_mut().find(|place| place.0.distance(x) <= ONE_PLACE) {
            Some((_, sum, count)) => {
                *sum += motion;
                *count += 1.0;
            }
            None => places.push((x, motion, 1.0)),
        }
    }
    places.into_iter().map(|(x, sum, count)| (x, sum / count)).unzip()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::rng::{Purpose, Stream};
    use glam::{DAffine2, DMat2, dvec2};

    fn scattered(count: usize, pass: u64) -> Vec<DVec2> {
        let mut random = Stream::new(9, Purpose::Match, pass, 0);
        (0..count).map(|_| dvec2(random.f64(), random.f64())).collect()
    }

    #[test]
    fn every_landmark_goes_to_its_target() {
        // A lattice, jittered: no two landmarks count as one.
        let jitter = scattered(100, 0);
        let place = |(i, j): (usize, &DVec2)| (dvec2((i % 10) as f64, (i / 10) as f64) + *j * 0.5) / 10.0;
        let source: Vec<DVec2> = jitter.iter().enumerate().map(place).collect();
        let target = scattered(100, 1);
        let plate = ThinPlate::new(&source, &target);
        for (a, b) in source.iter().zip(&target) {
            let gone = plate.apply(a.as_vec2());
            // Landmarks are asked for in f32, and the warp stretches their rounding (6e-8) some tens of times.
            assert!(gone.as_dvec2().distance(*b) < 1e-5, "{gone} {b}");
        }
    }

    #[test]
    fn affine_maps_are_reproduced_everywhere() {
        let map = DAffine2::from_mat2_translation(
            DMat2::from_cols(dvec2(1.4, 0.3), dvec2(-0.8, 0.6)),
            dvec2(0.2, -0.1),
        );
        let source = scattered(50, 2);
        let target: Vec<DVec2> = source.iter().map(|x| map.transform_point2(*x)).collect();
        let plate = ThinPlate::new(&source, &target);
        for point in [dvec2(0.5, 0.5), dvec2(-1.0, 2.0), dvec2(3.0, 0.1)] {
            let gone = plate.apply(point.as_vec2()).as_dvec2();
            // f32 on the way in and out, values up to 5.
            assert!(gone.distance(map.transform_point2(point)) < 2e-6, "{gone}");
        }
    }

    #[test]
    fn landmarks_in_a_line_or_in_one_place_make_a_map_that_is_finite() {
        let line: Vec<DVec2> = (0..30).map(|i| dvec2(0.02, 0.01) * f64::from(i)).collect();
        let spot = vec![dvec2(0.3, 0.7); 30];
        let free = scattered(30, 3);
        for source in [&line, &spot, &free] {
            for target in [&line, &spot, &free] {
                let plate = ThinPlate::new(source, target);
                for point in [Vec2::ZERO, Vec2::ONE, Vec2::new(5.0, -3.0)] {
                    assert!(plate.apply(point).is_finite());
                }
            }
        }
        // What moves as a whole is moved as a whole, however little is known.
        let moved = |source: &[DVec2]| {
            let target: Vec<DVec2> = source.iter().map(|x| *x + dvec2(0.25, 0.5)).collect();
            ThinPlate::new(source, &target).apply(Vec2::new(0.5, -1.0))
        };
        for source in [&line[..], &spot, &free, &free[..1], &free[..2]] {
            assert!(moved(source).distance(Vec2::new(0.75, -0.5)) < 1e-6);
        }
    }
}
