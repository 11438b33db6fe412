//! How well the light of each segment holds together on its way.

use std::sync::Arc;

use super::Engine;
use super::fitted_project::FittedProject;
use super::fitted_segment::FittedSegment;
use super::job::Job;
use super::memo::Same;
use super::meter::Meter;
use super::segment_figures::{Figures, SegmentContinuity};
use super::segment_photons::SegmentPhotons;
use super::track_files::with_guides_alone;
use super::walk::{MapsFrom, Walk};
use crate::project::Project;
use crate::{Error, Progress, Result};

impl Engine {
    /// How well the light of a project holds together in each segment in which it moves, by the photons that the flow is
    /// fitted to.
    ///
    /// # Errors
    /// Anything wrong with the project or its files; photons that are not finite; cancelled.
    pub fn continuity(&self, project: &Project, progress: &Progress) -> Result<Vec<SegmentContinuity>> {
        let meter = Meter::quick();
        let prepared = self.prepare(&with_guides_alone(project), &meter, progress)?;
        self.fit_prepared(prepared, &meter, progress)?.continuity(progress)
    }
}

impl FittedProject {
    /// How well the light holds together in each segment in which it moves; remembered.
    ///
    /// # Errors
    /// Photons that are not finite; cancelled.
    pub fn continuity(&self, progress: &Progress) -> Result<Vec<SegmentContinuity>> {
        self.measured(&Meter::quick(), progress)
    }

    /// The same after all else: none in a run that was stopped, whose results are kept all the same.
    pub(super) fn measured_unless_stopped(
        &self,
        meter: &Meter,
        progress: &Progress,
    ) -> Result<Vec<SegmentContinuity>> {
        match progress.check().and_then(|()| self.measured(meter, progress)) {
            Err(Error::Cancelled) => Ok(Vec::new()),
            measured => measured,
        }
    }

    fn measured(&self, meter: &Meter, progress: &Progress) -> Result<Vec<SegmentContinuity>> {
        let Self { engine, prepared, flow } = self;
        let inner = progress.inner();
        let job = engine.job(prepared, meter, &inner)?;
        progress.begin("measure", flow.segments.len() as u64);
        let mut ahead = Ahead { job: &job, walk: None, walked: 0 };
        let mut segments = Vec::new();
        for (number, fitted) in flow.segments.iter().enumerate() {
            let make = |_: &_| {
                let photons = ahead.of_segment(number, &flow.segments)?;
                let ends: [&[_]; 2] = [&photons.from, &photons.to];
                let figures = || Figures::of(fitted, ends, prepared.extent, &inner);
                meter.measure("measure", figures).map(Arc::new)
            };
            let figures = job.stages.continuity.get(job.slot(number), Same::of(fitted), &inner, make)?;
            let frames = [number, number + 1].map(|key| prepared.project.keys[key].frame);
            let name = |group| job.sources.grouping().name(group).map(str::to_owned);
            segments.extend(figures.named(frames, name));
            progress.advance(1);
        }
        Ok(segments)
    }
}

/// The photons of pass 0 of segments in their order, walked to only when asked for.
struct Ahead<'a> {
    job: &'a Job<'a>,
    walk: Option<Walk<'a>>,
    walked: usize,
}

impl Ahead<'_> {
    fn of_segment(&mut self, number: usize, flow: &[Arc<FittedSegment>]) -> Result<SegmentPhotons> {
        let mut walk = match self.walk.take() {
            Some(walk) => walk,
            None => Walk::start(self.job, 0)?,
        };
        loop {
            let maps = match flow.get(self.walked) {
                Some(fitted) if self.job.baked => MapsFrom::Others(&fitted.maps),
                _ => MapsFrom::Own { bounded: true },
            };
            let photons = walk.next(maps)?.ok_or(Error::Cancelled)?;
            self.walked += 1;
            if self.walked > number {
                self.walk = Some(walk);
                return Ok(photons);
            }
        }
    }
}
