//! The photons whose tracks are compared.

use glam::Vec2;

use lightloom_core::engine::MovingSegment;
use lightloom_core::flow::{FieldTrajectories, Fields, Trajectories as _};
use lightloom_core::{Progress, Result};

/// Largest number of probes.
const PROBES: usize = 4000;
/// The times at which they are compared, in tenths of the segment.
const TENTHS: std::ops::RangeInclusive<u8> = 1..=9;

/// Photons of a segment, the same for all flows.
pub(super) struct Probes {
    source: Vec<Vec2>,
    targets: Vec<Vec2>,
}

/// Distance between the tracks of the same photons in two flows, over all photons and times; plane units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct TrackError {
    /// Root mean square.
    pub(super) rms: f64,
    /// The 99.9th percentile.
    pub(super) high: f64,
    /// The largest.
    pub(super) most: f64,
}

impl Probes {
    /// Rows at even distances, half-way between those of the guide photons.
    pub(super) fn new(photons: &MovingSegment) -> Self {
        let all = photons.source.len();
        let count = PROBES.min(all);
        let rows = || (0..count).map(|i| (2 * i + 1) * all / (2 * count));
        let pick = |column: &[Vec2]| rows().map(|row| column[row]).collect();
        Self { source: pick(&photons.source), targets: pick(&photons.target) }
    }

    pub(super) fn count(&self) -> usize {
        self.source.len()
    }

    /// Positions along the fields: all photons at the first time, then all at the next.
    ///
    /// # Errors
    /// `Numeric` when photons are no longer finite, `Cancelled`.
    pub(super) fn tracks(&self, fields: &Fields, progress: &Progress) -> Result<Vec<Vec2>> {
        let mut carrier = FieldTrajectories::new(fields, &self.source, &self.targets);
        let mut tracks = Vec::with_capacity(self.count() * TENTHS.count());
        let mut positions = vec![Vec2::ZERO; self.count()];
        for tenth in TENTHS {
            carrier.positions_at(f64::from(tenth) / 10.0, &mut positions, progress)?;
            tracks.extend_from_slice(&positions);
        }
        Ok(tracks)
    }
}

impl TrackError {
    /// The distance between two sets of tracks.
    pub(super) fn between(a: &[Vec2], b: &[Vec2]) -> Self {
        let mut distances: Vec<f64> =
            (a.iter().zip(b)).map(|(a, b)| a.as_dvec2().distance(b.as_dvec2())).collect();
        distances.sort_by(f64::total_cmp);
        let count = distances.len();
        let squares: f64 = distances.iter().map(|d| d * d).sum();
        let at = |row: usize| distances.get(row).copied().unwrap_or_default();
        Self {
            rms: (squares / count.max(1) as f64).sqrt(),
            high: at(count - count.div_ceil(1000)),
            most: at(count.saturating_sub(1)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::vec2;

    #[test]
    fn distances_are_counted_as_they_say() {
        let here = vec![Vec2::ZERO; 4000];
        let mut there = vec![vec2(0.25, 0.0); 4000];
        (there[..4]).fill(vec2(0.0, 0.5));
        let error = TrackError::between(&here, &there);
        // Four of four thousand are one in a thousand.
        assert_eq!((error.high, error.most), (0.5, 0.5));
        assert!((error.rms.powi(2) - (0.0625 + 0.001 * 0.1875)).abs() < 1e-12);
        let equal = TrackError::between(&here, &here);
        assert_eq!((equal.rms, equal.high, equal.most), (0.0, 0.0, 0.0));
        assert_eq!(TrackError::between(&[], &[]).most, 0.0);
    }
}
