//! The stage that carries the photons of a preview through the frames of a segment.

use std::sync::Arc;

use glam::Vec2;

use super::growing::{Composition, Growing};
use crate::engine::fitted_segment::FittedSegment;
use crate::engine::flow::{LayerSamples, fit_segment, with_first};
use crate::engine::job::Job;
use crate::engine::memo::Same;
use crate::engine::memo_keys::PositionsInput;
use crate::engine::segment_photons::SegmentPhotons;
use crate::engine::trajectories::SegmentTrajectories;
use crate::{Error, Result};

/// All photons at the frames of a segment.
pub(super) type Frames = Vec<Arc<[Vec2]>>;

impl Growing<'_> {
    /// Fits a segment and shows its frames on the way; returns them where they were made.
    pub(super) fn fit(
        &mut self,
        job: &Job,
        photons: &SegmentPhotons,
    ) -> Result<(Arc<FittedSegment>, Option<Frames>)> {
        let (slots, times) = self.between_keys(photons.number);
        let mut composition = Composition::new(&photons.from, photons.layers.len(), times.len());
        let first = self.first_of(&slots);
        let mut frames = vec![None; slots.len()];
        let show = &mut |groups: &[usize], moment: usize, positions: &[Vec2]| {
            let composed = composition.as_mut().and_then(|c| c.take(groups, moment, positions));
            if let Some(positions) = composed {
                self.add(slots[moment], &positions);
                frames[moment] = Some(positions);
            }
        };
        let samples = Some(LayerSamples { times: &times, first, show });
        let fitted = fit_segment(job, photons, samples)?;
        Ok((fitted, frames.into_iter().collect()))
    }

    /// Carries the photons of a segment through its frames along a fitted flow; `known` are the frames where they were
    /// made by the fit.
    pub(super) fn carry(
        &mut self,
        job: &Job,
        photons: &SegmentPhotons,
        fitted: &Arc<FittedSegment>,
        known: Option<Frames>,
    ) -> Result<()> {
        let (slots, times) = self.between_keys(photons.number);
        let input = PositionsInput { fitted: Same::of(fitted), matched: Same::of(&photons.matched), times };
        let memo = &job.stages.positions;
        let frames = memo.get(job.slot(photons.number), input, job.progress, |input| match known {
            Some(frames) => Ok(Arc::new(frames)),
            None => job.meter.measure("carry", || {
                let mut trajectories =
                    SegmentTrajectories::with_tracks(fitted, (&photons.from, &photons.to), &photons.tracks);
                let mut frames = vec![Arc::default(); slots.len()];
                job.progress.begin("carry", slots.len() as u64);
                for i in with_first(self.first_of(&slots), slots.len()) {
                    let mut positions = vec![Vec2::ZERO; trajectories.len()];
                    trajectories.light_at(input.times[i], &mut positions, &job.progress.inner())?;
                    frames[i] = Arc::from(positions);
                    self.add(slots[i], &frames[i]);
                    job.progress.advance(1);
                }
                Ok::<_, Error>(Arc::new(frames))
            }),
        })?;
        slots.iter().zip(&*frames).for_each(|(&slot, positions)| self.add(slot, positions));
        self.fitted(photons, fitted);
        Ok(())
    }
}
