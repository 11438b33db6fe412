//! The trajectories of the photons of one pass through one segment, group by group.

use std::ops::Range;

use glam::{Vec2, Vec3};
use rayon::prelude::*;

use super::fitted_segment::FittedSegment;
use super::key_photons::KeyPhotons;
use super::segment_photons::GroupTracks;
use crate::flow::{Trajectories, WallViolations, flux};
use crate::{Progress, Result};

/// The trajectories of all groups from one key frame to the next. The rows of the groups follow each other.
pub(super) struct SegmentTrajectories<'a> {
    groups: Vec<Group<'a>>,
}

struct Group<'a> {
    from: &'a KeyPhotons,
    to: &'a KeyPhotons,
    rows: Range<usize>,
    /// Absent where the group rests, or where the fit saw no photon of it: then all go straight.
    trajectories: Option<Box<dyn Trajectories + 'a>>,
}

impl<'a> SegmentTrajectories<'a> {
    /// The trajectories of the photons at `from` to those at `to`, row by row.
    pub(super) fn new(segment: &'a FittedSegment, from: &'a [KeyPhotons], to: &'a [KeyPhotons]) -> Self {
        Self::with_tracks(segment, (from, to), &[])
    }

    /// As [`Self::new`], with the tracks to the meeting of those groups for which they are known.
    pub(super) fn with_tracks(
        segment: &'a FittedSegment,
        (from, to): (&'a [KeyPhotons], &'a [KeyPhotons]),
        tracks: &'a [Option<GroupTracks>],
    ) -> Self {
        let mut end = 0;
        let group = |(group, (from, to)): (usize, (&'a KeyPhotons, &'a KeyPhotons))| {
            let rows = end..end + from.positions.len();
            end = rows.end;
            let flow = segment.flow_of(group).filter(|_| !rows.is_empty());
            let tracks = tracks.get(group).and_then(Option::as_ref);
            let trajectories = flow
                .map(|flow| flow.trajectories(&from.positions, &to.positions, &to.midpoint_offsets, tracks));
            Group { from, to, rows, trajectories }
        };
        Self { groups: from.iter().zip(to).enumerate().map(group).collect() }
    }

    /// The number of photons.
    pub(super) fn len(&self) -> usize {
        self.groups.last().map_or(0, |group| group.rows.end)
    }

    /// Where all photons carry their light at time `t`, 0..=1; returns the standard deviation by which it is diffused, that of the
    /// group that is least. Otherwise as [`Self::positions_at`].
    ///
    /// # Errors
    /// As [`Self::positions_at`].
    ///
    /// # Panics
    /// As [`Self::positions_at`].
    pub(super) fn light_at(&mut self, t: f64, out: &mut [Vec2], progress: &Progress) -> Result<f32> {
        let mut least = f32::INFINITY;
        for Group { from, to, rows, trajectories } in
            self.groups.iter_mut().filter(|group| !group.rows.is_empty())
        {
            let out = &mut out[rows.clone()];
            let deviation = match trajectories {
                Some(trajectories) => trajectories.light_at(t, out, progress)?,
                None => {
                    straight(&from.positions, &to.positions, t as f32, out);
                    0.0
                }
            };
            least = least.min(deviation);
        }
        Ok(if least.is_finite() { least } else { 0.0 })
    }

    /// Positions of all photons at time `t`, 0..=1; ascending times cost one way through the fields in all.
    ///
    /// # Errors
    /// `Numeric` with the count when photons are no longer finite, `Cancelled`.
    ///
    /// # Panics
    /// When `out` has not one place for each photon.
    pub(super) fn positions_at(&mut self, t: f64, out: &mut [Vec2], progress: &Progress) -> Result<()> {
        for Group { from, to, rows, trajectories } in &mut self.groups {
            let out = &mut out[rows.clone()];
            match trajectories {
                Some(trajectories) => trajectories.positions_at(t, out, progress)?,
                None => straight(&from.positions, &to.positions, t as f32, out),
            }
        }
        Ok(())
    }

    /// The photons that crossed walls or were shut off by them, so far.
    pub(super) fn wall_violations(&self) -> WallViolations {
        let all = self.groups.iter().filter_map(|group| group.trajectories.as_ref());
        all.map(|one| one.wall_violations()).fold(WallViolations::default(), |a, b| a.plus(b))
    }

    /// RGB flux of all photons at time `t`, 0..=1, watts.
    ///
    /// # Panics
    /// When `out` has not one place for each photon.
    pub(super) fn flux_at(&self, t: f64, out: &mut [Vec3]) {
        for Group { from, to, rows, .. } in &self.groups {
            flux::blend(&from.flux, &to.flux, t as f32, &mut out[rows.clone()]);
        }
    }
}

/// Straight lines, written so that a photon at rest stays exactly in place.
fn straight(from: &[Vec2], to: &[Vec2], t: f32, out: &mut [Vec2]) {
    let ends = from.par_iter().zip(to);
    out.par_iter_mut().zip(ends).for_each(|(out, (&a, &b))| *out = if t < 1.0 { a + (b - a) * t } else { b });
}
