//! Plane curves: uniform cubic B-splines given by their control points.
//!
//! A B-spline has a continuous second derivative and never swings more often than its control polygon, so a surface turned
//! from it has no visible seams, neither in its reflections nor in the caustics it casts.

use glam::DVec2;

/// One sample of a curve.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Station {
    /// Where the sample lies.
    pub point: DVec2,
    /// Direction of travel, of unit length.
    pub tangent: DVec2,
}

/// How finely a curve is cut into stations.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fineness {
    /// Longest step along a straight piece, in the unit of the curve.
    pub step: f64,
    /// Largest turn of the tangent from one station to the next, in radians.
    pub turn: f64,
}

/// A uniform cubic B-spline in the plane.
#[derive(Clone, Debug)]
pub(crate) struct Curve {
    control: Vec<DVec2>,
}

impl Curve {
    /// A curve that starts at the first and ends at the last point, which are its only interpolated control points.
    pub(crate) fn open(points: &[DVec2]) -> Self {
        let [first, second, .., before, last] = points else {
            panic!("a curve needs four control points or more")
        };
        let mut control = vec![2.0 * *first - *second];
        control.extend_from_slice(points);
        control.push(2.0 * *last - *before);
        Self { control }
    }

    /// A profile to be turned around the axis x = 0, on which its first and last control points lie.
    ///
    /// The control polygon goes on as its own mirror image behind the axis: the curve meets the axis at a right angle.
    pub(crate) fn profile(points: &[DVec2]) -> Self {
        let [first, second, .., before, last] = points else {
            panic!("a profile needs four control points or more")
        };
        assert!(first.x == 0.0 && last.x == 0.0, "a profile starts and ends on the axis");
        let mirror = DVec2::new(-1.0, 1.0);
        let mut control = vec![*second * mirror];
        control.extend_from_slice(points);
        control.push(*before * mirror);
        Self { control }
    }

    /// The curve cut into stations, denser where it bends: `step` bounds their distance and `turn` the angle between them.
    pub(crate) fn stations(&self, fineness: Fineness) -> Vec<Station> {
        const PER_SPAN: usize = 64;
        let samples = self.spans() * PER_SPAN;
        let parameter = |i: usize| i as f64 / PER_SPAN as f64;
        let mut length = vec![0.0];
        for i in 0..samples {
            let [_, velocity, acceleration] = self.derivatives(parameter(i) + 0.5 / PER_SPAN as f64);
            let speed = velocity.length();
            let turning = velocity.perp_dot(acceleration).abs() / (speed * speed);
            length.push(length[i] + (speed / fineness.step + turning / fineness.turn) / PER_SPAN as f64);
        }
        let count = libm::ceil(length[samples]) as usize;
        let mut i = 0;
        let mut station = |k: usize| {
            let wanted = length[samples] * k as f64 / count as f64;
            while i + 1 < samples && length[i + 1] < wanted {
                i += 1;
            }
            let within = (wanted - length[i]) / (length[i + 1] - length[i]);
            let [point, velocity, _] =
                self.derivatives((i as f64 + within.clamp(0.0, 1.0)) / PER_SPAN as f64);
            Station { point, tangent: velocity.normalize() }
        };
        (0..=count).map(&mut station).collect()
    }

    fn spans(&self) -> usize {
        self.control.len() - 3
    }

    /// Value, first and second derivative at the parameter `u` in [0, spans].
    fn derivatives(&self, u: f64) -> [DVec2; 3] {
        let span = (libm::floor(u) as usize).min(self.spans() - 1);
        let t = u - span as f64;
        let s = 1.0 - t;
        let [a, b, c, d] = [0, 1, 2, 3].map(|k| self.control[span + k]);
        let value = (a * (s * s * s) + b * (3.0 * t * t * t - 6.0 * t * t + 4.0)) / 6.0
            + (c * (3.0 * s * s * s - 6.0 * s * s + 4.0) + d * (t * t * t)) / 6.0;
        let first =
            (d * (t * t) - a * (s * s) + b * (3.0 * t * t - 4.0 * t) - c * (3.0 * s * s - 4.0 * s)) / 2.0;
        let second = a * s + b * (3.0 * t - 2.0) + c * (3.0 * s - 2.0) + d * t;
        [value, first, second]
    }
}

/// The polygon moved to its left by `distance`, each point along the mean normal of its two neighbouring sides.
pub(crate) fn offset(points: &[DVec2], distance: f64) -> Vec<DVec2> {
    let last = points.len() - 1;
    let moved = |i: usize| {
        let along = (points[(i + 1).min(last)] - points[i.saturating_sub(1)]).normalize();
        points[i] + distance * along.perp()
    };
    (0..points.len()).map(moved).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn arch() -> Curve {
        let points = [(0.0, 0.0), (2.0, 0.0), (3.0, 1.0), (3.0, 3.0), (0.0, 4.0)];
        Curve::profile(&points.map(DVec2::from))
    }

    #[test]
    fn a_profile_meets_the_axis_at_a_right_angle() {
        let stations = arch().stations(Fineness { step: 0.1, turn: 0.1 });
        for end in [stations[0], stations[stations.len() - 1]] {
            assert!(end.point.x.abs() < 1e-12, "{end:?}");
            assert!(end.tangent.y.abs() < 1e-12, "{end:?}");
        }
    }

    #[test]
    fn stations_keep_the_bounds_on_step_and_turn() {
        let fineness = Fineness { step: 0.1, turn: 0.05 };
        for pair in arch().stations(fineness).windows(2) {
            // The table behind the stations is exact to the second order; 2 % is ample.
            assert!(pair[0].point.distance(pair[1].point) < 1.02 * fineness.step);
            assert!(pair[0].tangent.angle_to(pair[1].tangent).abs() < 1.02 * fineness.turn);
        }
    }

    #[test]
    fn derivatives_agree_with_differences() {
        let (curve, h) = (arch(), 1e-4);
        for u in [0.3, 1.0, 2.7, 3.5] {
            let [_, velocity, acceleration] = curve.derivatives(u);
            let [before, here, after] = [u - h, u, u + h].map(|u| curve.derivatives(u)[0]);
            // Third derivatives are below 10 here and jump at the knots: h * 10 bounds the second difference.
            assert!(((after - before) / (2.0 * h) - velocity).length() < 1e-6);
            assert!(((after - 2.0 * here + before) / (h * h) - acceleration).length() < 10.0 * h);
        }
    }

    #[test]
    fn an_open_curve_starts_and_ends_at_its_points() {
        let points = [(0.0, 0.0), (1.0, 2.0), (2.0, -1.0), (4.0, 0.0)].map(DVec2::from);
        let stations = Curve::open(&points).stations(Fineness { step: 0.2, turn: 0.2 });
        assert!(stations[0].point.distance(points[0]) < 1e-12);
        assert!(stations[stations.len() - 1].point.distance(points[3]) < 1e-12);
    }
}
