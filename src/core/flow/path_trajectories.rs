//! Closed-form trajectories: straight lines and natural cubics.
//!
//! A natural cubic through a, q, b at t = 0, 1/2, 1 is the straight line plus a multiple of the midpoint offset,
//!
//! ```text
//! c(t) = (1-t) a + t b + n(x) (q - (a + b)/2),   n(x) = 3 x - 4 x^3,   x = min(t, 1-t)
//! ```
//!
//! as n is the natural cubic through 0, 1, 0. At t = 0 and t = 1 it is a and b to the last bit.

use glam::Vec2;
use rayon::prelude::*;

use super::observer::{Kinematics, Observer};
use super::report::FlowReport;
use super::segment::{check_photons, guide_rows};
use super::trajectories::Trajectories;
use super::walls::WallViolations;
use crate::{Progress, Result};

/// Photons per parallel task.
const CHUNK: usize = 8192;

/// The photons of one pass on closed-form paths.
#[derive(Clone, Copy, Debug)]
pub struct PathTrajectories<'a> {
    source: &'a [Vec2],
    targets: &'a [Vec2],
    midpoint_offsets: &'a [Vec2],
}

impl<'a> PathTrajectories<'a> {
    /// Photons at `source` bound for `targets`, row by row. `midpoint_offsets` are the offsets of their paths from the
    /// straight ones at t = 1/2, plane units; empty where all paths are straight.
    ///
    /// # Panics
    /// When the columns differ in length.
    pub fn new(source: &'a [Vec2], targets: &'a [Vec2], midpoint_offsets: &'a [Vec2]) -> Self {
        assert_eq!(source.len(), targets.len(), "each photon has one target");
        assert!(
            midpoint_offsets.is_empty() || midpoint_offsets.len() == source.len(),
            "each photon has one midpoint offset, or none has"
        );
        Self { source, targets, midpoint_offsets }
    }

    /// Positions at time `t`, clipped to 0..=1.
    ///
    /// # Panics
    /// When `out` has not one position for each photon.
    pub fn positions(&self, t: f64, out: &mut [Vec2]) {
        let t = t.clamp(0.0, 1.0);
        let x = t.min(1.0 - t);
        self.each(out, [1.0 - t, t, 3.0 * x - 4.0 * x * x * x]);
    }

    /// Each photon's sum of source, target and midpoint offset with these weights.
    fn each(&self, out: &mut [Vec2], shares: [f64; 3]) {
        assert_eq!(out.len(), self.source.len(), "one position for each photon");
        let [a, b, offset] = shares.map(|share| share as f32);
        let straight = |i: usize| self.source[i] * a + self.targets[i] * b;
        out.par_chunks_mut(CHUNK).enumerate().for_each(|(chunk, out)| {
            let rows = (chunk * CHUNK..).zip(out);
            if self.midpoint_offsets.is_empty() {
                rows.for_each(|(i, out)| *out = straight(i));
            } else {
                rows.for_each(|(i, out)| *out = straight(i) + self.midpoint_offsets[i] * offset);
            }
        });
    }
}

impl Kinematics for PathTrajectories<'_> {
    fn positions(&self, t: f64, out: &mut [Vec2]) {
        PathTrajectories::positions(self, t, out);
    }

    fn velocities(&self, t: f64, out: &mut [Vec2]) {
        let x = t.min(1.0 - t);
        let slope = (3.0 - 12.0 * x * x).copysign(0.5 - t);
        self.each(out, [-1.0, 1.0, slope]);
    }
}

impl Trajectories for PathTrajectories<'_> {
    fn positions_at(&mut self, t: f64, out: &mut [Vec2], progress: &Progress) -> Result<()> {
        self.positions(t, out);
        progress.check()
    }
}

/// The report on closed-form paths, at the times of a fitted flow of `steps` steps; the numbers of fields and fits are 0.
/// Covers at most `guides` photons, the same rows that a field would be fitted to.
///
/// # Errors
/// `Value` when there are no photons, the columns differ in length or hold a number that is not finite; `Cancelled`.
pub fn path_report(
    paths: &PathTrajectories,
    extent: Vec2,
    guides: usize,
    steps: usize,
    progress: &Progress,
) -> Result<FlowReport> {
    check_photons(paths.source, paths.targets)?;
    let rows = guide_rows(paths.source.len(), guides);
    let some = |column: &[Vec2]| {
        if column.is_empty() { Vec::new() } else { rows.iter().map(|&i| column[i]).collect() }
    };
    let (source, targets, midpoint_offsets) =
        (some(paths.source), some(paths.targets), some(paths.midpoint_offsets));
    let paths = PathTrajectories::new(&source, &targets, &midpoint_offsets);
    let mut observer = Observer::new(&source, &targets, extent);
    progress.begin("watch", steps as u64);
    for n in 0..steps {
        progress.check()?;
        let (start, end) = (n as f64 / steps as f64, (n + 1) as f64 / steps as f64);
        observer.stepped(&paths, start, end - start);
        progress.advance(1);
    }
    let mut positions = vec![Vec2::ZERO; source.len()];
    paths.positions(1.0, &mut positions);
    Ok(observer.finish(&positions, None, WallViolations::default(), FlowReport::default()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::vec2;

    const A: [Vec2; 2] = [vec2(0.1, 0.2), vec2(0.7, 0.9)];
    const B: [Vec2; 2] = [vec2(0.8, 0.3), vec2(0.3, -0.1)];
    const Q: [Vec2; 2] = [vec2(0.5, 0.6), vec2(0.4, 0.5)];

    fn midpoint_offsets() -> Vec<Vec2> {
        (0..2).map(|i| Q[i] - (A[i] + B[i]) / 2.0).collect()
    }

    fn at(paths: &PathTrajectories, t: f64) -> [Vec2; 2] {
        let mut out = [Vec2::ZERO; 2];
        paths.positions(t, &mut out);
        out
    }

    #[test]
    fn a_cubic_way_passes_its_three_points_and_ends_exactly() {
        let midpoint_offsets = midpoint_offsets();
        let paths = PathTrajectories::new(&A, &B, &midpoint_offsets);
        assert_eq!(at(&paths, 0.0), A);
        assert_eq!(at(&paths, 1.0), B);
        assert_eq!(at(&paths, 7.0), B);
        for (c, q) in at(&paths, 0.5).iter().zip(Q) {
            // Three sums of numbers below 1 in f32.
            assert!(c.distance(q) < 2e-7, "{c} {q}");
        }
    }

    #[test]
    fn a_cubic_way_is_natural_and_smooth_at_its_middle() {
        let midpoint_offsets = midpoint_offsets();
        let paths = PathTrajectories::new(&A, &B, &midpoint_offsets);
        let h = 1e-2;
        let second = |t: f64| {
            let [before, now, after] = [t - h, t, t + h].map(|t| at(&paths, t)[0].as_dvec2());
            ((before - now * 2.0 + after) / (h * h)).length()
        };
        // The second derivative is 24 x |bow|; rounding of 1e-7 in c, over h^2, is 1e-3, and its kink at 1/2 shows within h.
        let bow = f64::from(midpoint_offsets[0].length());
        assert!((second(0.25) - 6.0 * bow).abs() < 1e-2, "{} {bow}", second(0.25));
        assert!((second(0.5) - 12.0 * bow).abs() < 24.0 * bow * h, "{} {bow}", second(0.5));
        assert!(second(h) < 24.0 * bow * h + 1e-2, "no bending at the ends");
    }

    #[test]
    fn velocities_are_the_change_of_positions() {
        let midpoint_offsets = midpoint_offsets();
        for midpoint_offsets in [&midpoint_offsets[..], &[]] {
            let paths = PathTrajectories::new(&A, &B, midpoint_offsets);
            for t in [0.1, 0.4, 0.6, 0.9] {
                let mut velocities = [Vec2::ZERO; 2];
                paths.velocities(t, &mut velocities);
                for i in 0..2 {
                    let change = (at(&paths, t + 1e-2)[i] - at(&paths, t - 1e-2)[i]) / 2e-2;
                    // Cubic: the central difference is off by h^2/6 times 24 |bow|, below 2e-4.
                    assert!(change.distance(velocities[i]) < 3e-4, "{change} {}", velocities[i]);
                }
            }
        }
    }

    #[test]
    fn a_way_without_bow_is_straight_at_constant_speed() {
        let paths = PathTrajectories::new(&A, &B, &[]);
        for t in [0.0, 0.3, 0.5, 1.0] {
            let straight = [0, 1].map(|i| A[i].lerp(B[i], t as f32));
            assert!(at(&paths, t).iter().zip(straight).all(|(c, s)| c.distance(s) < 1e-7));
        }
    }
}
