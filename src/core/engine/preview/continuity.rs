//! How well the light of a preview holds together.

use glam::Vec2;

use super::frames::Preview;
use crate::engine::segment_figures::{Figures, SegmentContinuity};
use crate::project::SegmentTime;
use crate::{Progress, Result};

impl Preview {
    /// How well the light holds together in each segment in which it moves and whose flow is known. Nothing is remembered:
    /// it takes some tenths of a second for each segment.
    ///
    /// # Errors
    /// Photons that are not finite; cancelled.
    pub fn continuity(&self, progress: &Progress) -> Result<Vec<SegmentContinuity>> {
        let mut segments = Vec::new();
        let known = self.segments.iter().zip(&self.ends).enumerate();
        for (number, (fitted, ends)) in known {
            let Some((fitted, [from, to])) = fitted.as_ref().zip(ends.as_ref()) else { continue };
            let figures = Figures::of(fitted, [from, to], self.keys.extent, progress)?;
            let frames = [number, number + 1].map(|key| self.keys.frames[key]);
            segments.extend(figures.named(frames, |group| self.keys.groups[group].0.clone()));
        }
        Ok(segments)
    }

    /// The number, from 0, of the key whose picture is seen at a frame: the earlier one up to half time, the later one after.
    pub fn seen_key(&self, frame: i32) -> usize {
        let SegmentTime { segment, time } = self.moment(frame);
        let last = self.keys.lights.len() - 1;
        if time > 0.5 { (segment + 1).min(last) } else { segment }
    }

    /// Positions of the photons at a key, row by row.
    ///
    /// # Panics
    /// When there is no key of this number.
    pub fn at_key(&self, key: usize) -> &[Vec2] {
        &self.keys.lights[key].positions
    }
}
