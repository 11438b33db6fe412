//! Ways that are known at once, without a field: straight lines and cubics.
//!
//! A natural cubic through a, q, b at t = 0, 1/2, 1 is the straight line and a bow,
//!
//! ```text
//! c(t) = (1-t) a + t b + n(x) (q - (a + b)/2),   n(x) = 3 x - 4 x^3,   x = min(t, 1-t)
//! ```
//!
//! as n is the natural cubic through 0, 1, 0. At t = 0 and t = 1 it is a and b to the last bit.

use glam::Vec2;
use rayon::prelude::*;

use super::report::{FlowReport, Moving, Observer};
use super::trajectory::Astray;
use super::{check_photons, guide_rows};
use crate::{Progress, Result};

/// Photons per parallel task.
const CHUNK: usize = 8192;

/// Photons of one pass on such ways.
#[derive(Clone, Copy, Debug)]
pub struct Paths<'a> {
    source: &'a [Vec2],
    targets: &'a [Vec2],
    bows: &'a [Vec2],
}

impl<'a> Paths<'a> {
    /// Photons at `source`, each bound for the target in the same row. `bows` are the distances of their ways from the
    /// straight ones at half-time, plane units; empty where all go straight.
    ///
    /// # Panics
    /// When the columns differ in length.
    pub fn new(source: &'a [Vec2], targets: &'a [Vec2], bows: &'a [Vec2]) -> Self {
        assert_eq!(source.len(), targets.len(), "each photon has one target");
        assert!(bows.is_empty() || bows.len() == source.len(), "each photon has one bow, or none has");
        Self { source, targets, bows }
    }

    /// Positions at time `t`, clipped to 0..=1.
    ///
    /// # Panics
    /// When `out` has not one place for each photon.
    pub fn positions(&self, t: f64, out: &mut [Vec2]) {
        let t = t.clamp(0.0, 1.0);
        let x = t.min(1.0 - t);
        self.each(out, [1.0 - t, t, 3.0 * x - 4.0 * x * x * x]);
    }

    /// Velocities at time `t`, per unit of t.
    ///
    /// # Panics
    /// When `out` has not one place for each photon.
    pub fn velocities(&self, t: f64, out: &mut [Vec2]) {
        let x = t.min(1.0 - t);
        let slope = (3.0 - 12.0 * x * x).copysign(0.5 - t);
        self.each(out, [-1.0, 1.0, slope]);
    }

    /// Each photon's source, target and bow, in these shares.
    fn each(&self, out: &mut [Vec2], shares: [f64; 3]) {
        assert_eq!(out.len(), self.source.len(), "one place for each photon");
        let [a, b, bow] = shares.map(|share| share as f32);
        let straight = |i: usize| self.source[i] * a + self.targets[i] * b;
        out.par_chunks_mut(CHUNK).enumerate().for_each(|(chunk, out)| {
            let rows = (chunk * CHUNK..).zip(out);
            if self.bows.is_empty() {
                rows.for_each(|(i, out)| *out = straight(i));
            } else {
                rows.for_each(|(i, out)| *out = straight(i) + self.bows[i] * bow);
            }
        });
    }
}

impl Moving for Paths<'_> {
    fn positions(&self, t: f64, out: &mut [Vec2]) {
        Paths::positions(self, t, out);
    }

    fn velocities(&self, t: f64, out: &mut [Vec2]) {
        Paths::velocities(self, t, out);
    }
}

/// What such ways are like, in the numbers and at the times of a fitted flow of `steps` steps; those of fields and fits
/// stay 0. Looks at no more than `guides` photons, the same rows that a field would be fitted to.
///
/// # Errors
/// `Value` when there are no photons, the columns differ in length or hold a number that is not finite; `Cancelled`.
pub fn watch_paths(
    paths: &Paths,
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
    let (source, targets, bows) = (some(paths.source), some(paths.targets), some(paths.bows));
    let paths = Paths::new(&source, &targets, &bows);
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
    Ok(observer.finish(&positions, None, Astray::default()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::vec2;

    const A: [Vec2; 2] = [vec2(0.1, 0.2), vec2(0.7, 0.9)];
    const B: [Vec2; 2] = [vec2(0.8, 0.3), vec2(0.3, -0.1)];
    const Q: [Vec2; 2] = [vec2(0.5, 0.6), vec2(0.4, 0.5)];

    fn bows() -> Vec<Vec2> {
        (0..2).map(|i| Q[i] - (A[i] + B[i]) / 2.0).collect()
    }

    fn at(paths: &Paths, t: f64) -> [Vec2; 2] {
        let mut out = [Vec2::ZERO; 2];
        paths.positions(t, &mut out);
        out
    }

    #[test]
    fn a_cubic_way_passes_its_three_points_and_ends_exactly() {
        let bows = bows();
        let paths = Paths::new(&A, &B, &bows);
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
        let bows = bows();
        let paths = Paths::new(&A, &B, &bows);
        let h = 1e-2;
        let second = |t: f64| {
            let [before, now, after] = [t - h, t, t + h].map(|t| at(&paths, t)[0].as_dvec2());
            ((before - now * 2.0 + after) / (h * h)).length()
        };
        // The second derivative is 24 x |bow|; rounding of 1e-7 in c, over h^2, is 1e-3, and its kink at 1/2 shows within h.
        let bow = f64::from(bows[0].length());
        assert!((second(0.25) - 6.0 * bow).abs() < 1e-2, "{} {bow}", second(0.25));
        assert!((second(0.5) - 12.0 * bow).abs() < 24.0 * bow * h, "{} {bow}", second(0.5));
        assert!(second(h) < 24.0 * bow * h + 1e-2, "no bending at the ends");
    }

    #[test]
    fn velocities_are_the_change_of_positions() {
        let bows = bows();
        for bows in [&bows[..], &[]] {
            let paths = Paths::new(&A, &B, bows);
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
        let paths = Paths::new(&A, &B, &[]);
        for t in [0.0, 0.3, 0.5, 1.0] {
            let straight = [0, 1].map(|i| A[i].lerp(B[i], t as f32));
            assert!(at(&paths, t).iter().zip(straight).all(|(c, s)| c.distance(s) < 1e-7));
        }
    }
}
