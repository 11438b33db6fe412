//! Where photons are within a step of a half.

use glam::Vec2;

use super::curve::{Curve, Curves};
use super::fields::MeetingFields;
use super::tracks::HalfTracks;
use super::walks::Walks;
use super::wall_motion::WallMotion;
use crate::flow::walls::SUBSTEPS;

/// One step of a half with the tracks of its photons.
///
/// Between the ends of the step a photon is on a cubic; one that walks along walls moves straight in each substep, and one whose
/// cubic might meet a wall goes straight.
pub(super) struct HalfStep<'a> {
    curves: Curves<'a>,
    /// The walls that stand in the step, and the photons that walk along them.
    walls: Option<(WallMotion<'a>, &'a Walks)>,
}

impl<'a> HalfStep<'a> {
    /// The step after `done` steps of a half.
    pub(super) fn new(fields: &'a MeetingFields, half: usize, done: usize, tracks: &'a HalfTracks) -> Self {
        let walls = WallMotion::new(fields, half, done);
        Self { curves: Curves::new(tracks, done), walls: walls.map(|walls| (walls, tracks.walks(done))) }
    }

    /// The walls; none where none stands.
    pub(super) fn walls(&self) -> Option<&WallMotion<'a>> {
        self.walls.as_ref().map(|(walls, _)| walls)
    }

    /// The cubic of a photon.
    #[inline(always)]
    pub(super) fn curve(&self, row: usize) -> Curve {
        self.curves.of(row)
    }

    /// The position of a photon after the fraction `x` of the step.
    #[inline(always)]
    pub(super) fn position(&self, row: usize, x: f32) -> Vec2 {
        let curve = self.curve(row);
        let Some((walls, walks)) = &self.walls else { return curve.position(x) };
        let [begin, end] = curve.ends();
        match walks.of(row) {
            Some(places) => along(begin, places, x),
            None if walls.is_clear(begin, curve.reach()) => curve.position(x),
            None => begin.lerp(end, x),
        }
    }

    /// Whether no wall is near a photon in this step, nor while it makes up for half of `gap`.
    pub(super) fn is_clear(&self, row: usize, gap: Vec2) -> bool {
        let Some((walls, walks)) = &self.walls else { return true };
        let curve = self.curve(row);
        walks.of(row).is_none() && walls.is_clear(curve.ends()[0], curve.reach() + 0.5 * gap.length())
    }
}

/// The place after the fraction `x` of a step from `begin`, straight between those after its substeps.
fn along(begin: Vec2, places: &[Vec2; SUBSTEPS], x: f32) -> Vec2 {
    let at = x * SUBSTEPS as f32;
    let part = (at as usize).min(SUBSTEPS - 1);
    let from = if part == 0 { begin } else { places[part - 1] };
    from.lerp(places[part], at - part as f32)
}
