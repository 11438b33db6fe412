//! The flow of a project, segment by segment: one sequence of fields that all caustics share, and one for each that flows
//! by itself.

use std::borrow::Cow;
use std::sync::Arc;

use glam::Vec2;

use super::active_constraints::{ActiveConstraints, active};
use super::fitted_segment::{FittedFlow, FittedSegment, FlowInput};
use super::job::Job;
use super::key_photons::KeyPhotons;
use super::layer::Layer;
use super::memo::Same;
use super::meter::Meter;
use super::numeric_place::in_segment;
use super::segment_photons::{MeetingFlow, SegmentPhotons};
use super::walk::{MapsFrom, Walk};
use crate::constraint::{ActiveLine, ActiveWall};
use crate::flow::meeting::meeting_report;
use crate::flow::{
    FlowReport, FlowSettings, MotionMethod, PathTrajectories, Segment, SegmentFlow, Snapshots, Trajectories,
    fit_with_snapshots, path_report,
};
use crate::project::Project;
use crate::{Progress, Result};

/// Matches and fits all segments with the photons of pass 0.
pub(super) fn fit(job: &Job) -> Result<FittedFlow> {
    let mut walk = Walk::start(job, 0)?;
    let caustics = job.sources.caustics(walk.light());
    let idle_lights = job.tracer().map_or(Vec::new(), |tracer| tracer.idle_lights());
    let mut flow = FittedFlow { segments: Vec::new(), numbers: None, caustics, idle_lights };
    while let Some(photons) = walk.next(MapsFrom::Own { bounded: true })? {
        flow.push(fit_segment(job, &photons, None)?);
    }
    Ok(flow)
}

/// The fitted flow of one segment, remembered. Neither rho nor the numbers of the frames change it.
pub(super) fn fit_segment(
    job: &Job,
    photons: &SegmentPhotons,
    samples: Option<LayerSamples>,
) -> Result<Arc<FittedSegment>> {
    let Project { method, flow, .. } = job.project;
    let settings = match method {
        MotionMethod::Flow | MotionMethod::Guided => FlowSettings { rho: 1.0, ..flow.clone() },
        // Closed-form paths are watched by so many guides at so many times, and heed nothing else.
        MotionMethod::Stylized | MotionMethod::Linear => {
            FlowSettings { guides: flow.guides, steps: flow.steps, ..FlowSettings::default() }
        }
    };
    let matched = &photons.matched;
    let active = active(job.project, photons.number, job.extent);
    let input = FlowInput { matched: Same::of(matched), active, method: *method, settings };
    let fitted = job.stages.flows.get(
        job.slot(photons.number),
        input,
        job.progress,
        |FlowInput { active, .. }| {
            let ActiveConstraints { lines, walls } = active;
            let (layers, reports) = match &matched.maps.meeting {
                Some(meeting) => photons.report_meeting(job, meeting, samples)?,
                None => {
                    photons.fit(job.project, job.extent, (lines, walls), samples, job.meter, job.progress)?
                }
            };
            let fitted = FittedSegment { maps: matched.maps.clone(), layers, reports, cost: matched.cost };
            Ok(Arc::new(fitted))
        },
    );
    in_segment(fitted, job.project, photons.number)
}

/// Gets the groups of a layer, the index of a time, and the positions of their photons then, group by group.
type ShowSample<'a> = dyn FnMut(&[usize], usize, &[Vec2]) + 'a;

/// Times at which photons are shown while fields are fitted to them.
pub(super) struct LayerSamples<'a> {
    /// Times within 0..=1, rising.
    pub(super) times: &'a [f64],
    /// The time that is shown first where all are known at once.
    pub(super) first: Option<usize>,
    /// Called with each.
    pub(super) show: &'a mut ShowSample<'a>,
}

/// The numbers below `count`, one of them before the others.
pub(super) fn with_first(first: Option<usize>, count: usize) -> impl Iterator<Item = usize> {
    first.into_iter().chain((0..count).filter(move |i| Some(*i) != first))
}

impl SegmentPhotons {
    /// Fits the flow of each layer of groups between these lines and walls, and reports on it.
    pub(super) fn fit(
        &self,
        project: &Project,
        extent: Vec2,
        (lines, walls): (&[ActiveLine], &[ActiveWall]),
        mut samples: Option<LayerSamples>,
        meter: &Meter,
        progress: &Progress,
    ) -> Result<(Vec<Layer>, Vec<FlowReport>)> {
        let (mut layers, mut reports) = (Vec::new(), Vec::new());
        for groups in &self.layers {
            let [source, target] = self.columns(groups);
            let midpoint_offsets = &*column(&self.to, groups, |to| &to.midpoint_offsets);
            let number = self.number;
            let segment = Segment {
                source: &source,
                target: &target,
                extent,
                settings: &project.flow,
                lines,
                walls,
                number,
            };
            let (flow, report) = match &mut samples {
                None => fit_layer(project.method, &segment, midpoint_offsets, None, meter, progress)?,
                Some(LayerSamples { times, show, .. }) => {
                    let show = &mut |i: usize, positions: &[Vec2]| show(groups, i, positions);
                    let samples = Some(Snapshots { times, show });
                    fit_layer(project.method, &segment, midpoint_offsets, samples, meter, progress)?
                }
            };
            layers.push(Layer { groups: groups.clone(), flow: Arc::new(flow) });
            reports.push(report);
        }
        Ok((layers, reports))
    }

    /// The layers of a flow that meets half way, with reports on the photons that were paired along it.
    fn report_meeting(
        &self,
        job: &Job,
        meeting: &MeetingFlow,
        mut samples: Option<LayerSamples>,
    ) -> Result<(Vec<Layer>, Vec<FlowReport>)> {
        if let Some(samples) = &mut samples {
            self.show_samples(&meeting.layers, samples, job.progress)?;
        }
        let mut reports = Vec::new();
        for (layer, fits) in meeting.layers.iter().zip(&meeting.fits) {
            let SegmentFlow::Meeting(fields) = &*layer.flow else { continue };
            let [source, target] = self.columns(&layer.groups);
            let guides = (job.extent, job.project.flow.guides as usize);
            let report = || meeting_report(fields, (&source, &target), guides, fits, job.progress);
            reports.push(job.meter.measure("watch", report)?);
        }
        Ok((meeting.layers.clone(), reports))
    }

    /// Shows the photons of all layers, time after time.
    fn show_samples(
        &self,
        layers: &[Layer],
        LayerSamples { times, first, show }: &mut LayerSamples,
        progress: &Progress,
    ) -> Result<()> {
        let mut layers: Vec<_> = layers.iter().map(|layer| (layer, self.trajectories(layer))).collect();
        for i in with_first(*first, times.len()) {
            for (layer, groups) in &mut layers {
                let mut positions = vec![Vec2::ZERO; groups.iter().map(|(count, _)| count).sum()];
                let mut rest = &mut *positions;
                for (count, trajectories) in groups {
                    let (own, others) = std::mem::take(&mut rest).split_at_mut(*count);
                    trajectories.light_at(times[i], own, &progress.inner())?;
                    rest = others;
                }
                show(&layer.groups, i, &positions);
            }
        }
        Ok(())
    }

    /// Of each group of a layer: the number of its photons, and their trajectories.
    fn trajectories<'a>(&'a self, layer: &'a Layer) -> Vec<(usize, Box<dyn Trajectories + 'a>)> {
        let of_group = |&group: &usize| {
            let (from, to) = (&self.from[group].positions, &self.to[group].positions);
            let tracks = self.tracks.get(group).and_then(Option::as_ref);
            (from.len(), layer.flow.trajectories(from, to, &[], tracks))
        };
        layer.groups.iter().map(of_group).collect()
    }

    /// The positions of some groups at both key frames, one group after the other.
    pub(super) fn columns(&self, groups: &[usize]) -> [Cow<'_, [Vec2]>; 2] {
        [&self.from, &self.to].map(|photons| column(photons, groups, |at| &at.positions))
    }
}

/// One column of several groups, one after the other; borrowed where it is but one.
fn column<'a>(
    photons: &'a [KeyPhotons],
    groups: &[usize],
    pick: impl Fn(&'a KeyPhotons) -> &'a [Vec2],
) -> Cow<'a, [Vec2]> {
    match groups {
        [group] => Cow::Borrowed(pick(&photons[*group])),
        _ => groups.iter().flat_map(|&group| pick(&photons[group])).copied().collect(),
    }
}

/// Fits the flow of one layer by a method, and reports on it. `samples` are shown the photons that the method looks at.
fn fit_layer(
    method: MotionMethod,
    segment: &Segment,
    midpoint_offsets: &[Vec2],
    samples: Option<Snapshots>,
    meter: &Meter,
    progress: &Progress,
) -> Result<(SegmentFlow, FlowReport)> {
    match method {
        MotionMethod::Flow | MotionMethod::Guided => meter.measure("fit", || {
            let (fields, report) = fit_with_snapshots(segment, samples, progress)?;
            Ok((SegmentFlow::Fields(fields), report))
        }),
        MotionMethod::Stylized | MotionMethod::Linear => meter.measure("watch", || {
            let Segment { source, target, extent, settings, .. } = *segment;
            let (guides, steps) = (settings.guides as usize, settings.steps as usize);
            let paths = PathTrajectories::new(source, target, midpoint_offsets);
            if let Some(Snapshots { times, show }) = samples {
                let mut positions = vec![Vec2::ZERO; source.len()];
                for (i, &time) in times.iter().enumerate() {
                    progress.check()?;
                    paths.positions(time, &mut positions);
                    show(i, &positions);
                }
            }
            let report = path_report(&paths, extent, guides, steps, progress)?;
            Ok((SegmentFlow::Paths, report))
        }),
    }
}
