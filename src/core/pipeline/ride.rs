//! The photons of one pass on their way through one segment, whatever carries each group.

use std::ops::Range;

use glam::{Vec2, Vec3};
use rayon::prelude::*;

use super::light::KeyPhotons;
use super::motion::Segment;
use crate::flow::{Trajectories, WallViolations, flux};
use crate::{Progress, Result};

/// All groups from one key to the next. Their rows follow each other in the columns that are filled.
pub(super) struct Ride<'a> {
    groups: Vec<Group<'a>>,
}

struct Group<'a> {
    from: &'a KeyPhotons,
    to: &'a KeyPhotons,
    rows: Range<usize>,
    /// Absent where the group rests, or where the fit saw no photon of it: then all go straight.
    carriage: Option<Box<dyn Trajectories + 'a>>,
}

impl<'a> Ride<'a> {
    /// The groups of photons at `from`, bound for `to`, row by row.
    pub(super) fn new(segment: &'a Segment, from: &'a [KeyPhotons], to: &'a [KeyPhotons]) -> Self {
        let mut end = 0;
        let group = |(group, (from, to)): (usize, (&'a KeyPhotons, &'a KeyPhotons))| {
            let rows = end..end + from.positions.len();
            end = rows.end;
            let mover = segment.mover_of(group).filter(|_| !rows.is_empty());
            let carriage = mover.map(|mover| mover.trajectories(&from.positions, &to.positions, &to.bows));
            Group { from, to, rows, carriage }
        };
        Self { groups: from.iter().zip(to).enumerate().map(group).collect() }
    }

    /// Photons of all groups.
    pub(super) fn len(&self) -> usize {
        self.groups.last().map_or(0, |group| group.rows.end)
    }

    /// Positions of all photons at time `t`, 0..=1; ascending times cost one way through the fields in all.
    ///
    /// # Errors
    /// `Numeric` with the count when photons are no longer finite, `Cancelled`.
    ///
    /// # Panics
    /// When `out` has not one place for each photon.
    pub(super) fn positions_at(&mut self, t: f64, out: &mut [Vec2], progress: &Progress) -> Result<()> {
        for Group { from, to, rows, carriage } in &mut self.groups {
            let out = &mut out[rows.clone()];
            match carriage {
                Some(carriage) => carriage.positions_at(t, out, progress)?,
                None => straight(&from.positions, &to.positions, t as f32, out),
            }
        }
        Ok(())
    }

    /// Photons that walls did not keep, so far.
    pub(super) fn astray(&self) -> WallViolations {
        let carriages = self.groups.iter().filter_map(|group| group.carriage.as_ref());
        carriages.map(|carriage| carriage.wall_violations()).fold(WallViolations::default(), |a, b| a.plus(b))
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

/// Written so that what rests does so exactly.
fn straight(from: &[Vec2], to: &[Vec2], t: f32, out: &mut [Vec2]) {
    let ends = from.par_iter().zip(to);
    out.par_iter_mut().zip(ends).for_each(|(out, (&a, &b))| *out = if t < 1.0 { a + (b - a) * t } else { b });
}
