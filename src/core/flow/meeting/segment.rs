//! The input of a flow that is not paired yet.

use glam::Vec2;

use crate::constraint::{ActiveLine, ActiveWall};
use crate::flow::segment::guide_rows;
use crate::flow::settings::FlowSettings;
use crate::flow::spatial_order::spatial_order;
use crate::{Error, Result};

/// One segment before its photons are paired: the light at both key frames, settings, lines and walls.
#[derive(Clone, Copy, Debug)]
pub struct MeetingSegment<'a> {
    /// Positions at the earlier and at the later key frame, plane units, group by group: each group has a plan of its
    /// own, all share one field. The rows of the two are not paired; their numbers may differ.
    pub groups: &'a [[&'a [Vec2]; 2]],
    /// Size of the plane; its longer side is 1.
    pub extent: Vec2,
    /// Flow settings.
    pub settings: &'a FlowSettings,
    /// Directed lines, Term (6).
    pub lines: &'a [ActiveLine],
    /// Walls.
    pub walls: &'a [ActiveWall],
    /// Number of the segment in the animation, from 0: turbulence continues from the segment before.
    pub number: usize,
}

impl MeetingSegment<'_> {
    /// Guide photons of each group at both key frames, evenly over the light: at most `settings.guides` at either.
    ///
    /// # Errors
    /// `Value` when a group has no photon at a key frame, or one that is not finite.
    pub(super) fn guides(&self) -> Result<Vec<[Vec<Vec2>; 2]>> {
        let all: usize = self.groups.iter().map(|[earlier, _]| earlier.len()).sum();
        let share = (f64::from(self.settings.guides) / all.max(1) as f64).min(1.0);
        let guides = |photons: &[Vec2]| -> Result<Vec<Vec2>> {
            if photons.is_empty() {
                let what = "there are no photons to move; check that light reaches the receiver";
                return Err(Error::value("flow", what));
            }
            if let Some(row) = photons.iter().position(|p| !p.is_finite()) {
                return Err(Error::value("flow", format!("photon {row} has a position that is not finite")));
            }
            let count = ((photons.len() as f64 * share).round() as usize).max(1);
            if count >= photons.len() {
                return Ok(photons.to_vec());
            }
            // Points of a picture stand in an order of low discrepancy: every third of them is no fair sample.
            let order = spatial_order(photons);
            Ok(guide_rows(photons.len(), count).into_iter().map(|i| photons[order[i] as usize]).collect())
        };
        if self.groups.is_empty() {
            return Err(Error::value(
                "flow",
                "there are no photons to move; check that light reaches the receiver",
            ));
        }
        self.groups.iter().map(|[earlier, later]| Ok([guides(earlier)?, guides(later)?])).collect()
    }
}
