//! The cubics through the steps of a half.

use glam::Vec2;

use super::tracks::HalfTracks;

/// The cubics of all photons over one step of a half.
pub(super) struct Curves<'a> {
    /// Positions before the step before, at the begin, at the end, and after the step after.
    columns: [&'a [Vec2]; 4],
    at_border: [bool; 2],
}

impl<'a> Curves<'a> {
    /// Those of the step after `done` steps.
    pub(super) fn new(tracks: &'a HalfTracks, done: usize) -> Self {
        let last = tracks.count();
        let columns = [done.saturating_sub(1), done, done + 1, (done + 2).min(last)].map(|n| tracks.after(n));
        Self { columns, at_border: [done == 0, done + 1 == last] }
    }

    /// That of a photon.
    #[inline(always)]
    pub(super) fn of(&self, row: usize) -> Curve {
        Curve { points: self.columns.map(|column| column[row]), at_border: self.at_border }
    }
}

/// The cubic of a photon through the ends of a step, with the slopes of its neighbours.
pub(super) struct Curve {
    points: [Vec2; 4],
    /// Whether the step is the first, and the last, of its half.
    at_border: [bool; 2],
}

impl Curve {
    /// Where the step begins, and ends.
    pub(super) fn ends(&self) -> [Vec2; 2] {
        [self.points[1], self.points[2]]
    }

    /// Slopes at both ends, per step: central differences, one-sided of second order at a border.
    #[inline(always)]
    fn slopes(&self) -> [Vec2; 2] {
        let [before, begin, end, after] = self.points;
        let chord = end - begin;
        match self.at_border {
            [true, true] => [chord, chord],
            [true, false] => {
                let slope = 0.5 * (after - begin);
                [2.0 * chord - slope, slope]
            }
            [false, true] => {
                let slope = 0.5 * (end - before);
                [slope, 2.0 * chord - slope]
            }
            [false, false] => [0.5 * (end - before), 0.5 * (after - begin)],
        }
    }

    /// The position after the fraction `x` of the step.
    #[inline(always)]
    pub(super) fn position(&self, x: f32) -> Vec2 {
        let ([_, begin, end, _], [a, b]) = (self.points, self.slopes());
        let (y, chord) = (1.0 - x, end - begin);
        begin + x * (chord * x * (3.0 - 2.0 * x) + y * (y * a - x * b))
    }

    /// The slope there, per step from the key frame on.
    #[inline(always)]
    pub(super) fn slope(&self, x: f32) -> Vec2 {
        let ([_, begin, end, _], [a, b]) = (self.points, self.slopes());
        let chord = end - begin;
        6.0 * x * (1.0 - x) * chord + (1.0 - x) * (1.0 - 3.0 * x) * a + x * (3.0 * x - 2.0) * b
    }

    /// The radius about the begin within which the cubic stays: that of its Bezier polygon.
    #[inline(always)]
    pub(super) fn reach(&self) -> f32 {
        let ([begin, end], [a, b]) = (self.ends(), self.slopes());
        let chord = end - begin;
        let farthest = a.length_squared() / 9.0;
        farthest.max((chord - b / 3.0).length_squared()).max(chord.length_squared()).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::rng::{Purpose, Stream};

    #[test]
    fn a_cubic_meets_its_ends_and_stays_within_its_reach() {
        let mut stream = Stream::new(3, Purpose::Match, 0, 0);
        for _ in 0..200 {
            let points = std::array::from_fn(|_| Vec2::new(stream.f32(), stream.f32()));
            let curve = Curve { points, at_border: [stream.f32() < 0.3, stream.f32() < 0.3] };
            let [begin, end] = curve.ends();
            assert!(curve.position(0.0).distance(begin) < 1e-6 && curve.position(1.0).distance(end) < 1e-6);
            for i in 0..=20 {
                // Rounding alone.
                assert!(curve.position(i as f32 / 20.0).distance(begin) <= curve.reach() + 1e-6);
            }
        }
    }
}
