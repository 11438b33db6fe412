//! The flow of a segment whose key frames meet half way, layer by layer, before its photons are paired.

use std::sync::Arc;

use glam::Vec2;

use super::job::Job;
use super::layer::Layer;
use super::pairing::MeetingInput;
use super::segment_photons::MeetingFlow;
use crate::Result;
use crate::flow::SegmentFlow;
use crate::flow::meeting::{MeetingFields, MeetingFit, MeetingSegment, fit_meeting};

/// Plans and fits the flow of segment `number` for each of the `layers` of groups; `groups` are the photons of every group at
/// both key frames.
pub(super) fn fit(
    job: &Job,
    (number, input): (usize, &MeetingInput),
    (layers, groups): (&[Vec<usize>], &[[&[Vec2]; 2]]),
) -> Result<MeetingFlow> {
    let planned = |fit: &Result<MeetingFit>| fit.as_ref().map_or(0.0, |fit| fit.plan.seconds[0]);
    let mut flow = MeetingFlow { layers: Vec::new(), fits: Vec::new(), plans: Vec::new() };
    for members in layers {
        let photons: Vec<_> = members.iter().map(|&group| groups[group]).collect();
        let segment = MeetingSegment {
            groups: &photons,
            extent: job.extent,
            settings: &input.settings,
            lines: &input.active.lines,
            walls: &input.active.walls,
            number,
        };
        let MeetingFit { fields, fits, plan } =
            job.meter.measure_turns(["plan", "fit"], || fit_meeting(&segment, job.progress), planned)?;
        flow.layers.push(Layer { groups: members.clone(), flow: Arc::new(SegmentFlow::Meeting(fields)) });
        flow.fits.push(fits);
        flow.plans.push(plan);
    }
    Ok(flow)
}

impl MeetingFlow {
    /// The fields that carry a group; none where it rests.
    pub(super) fn fields_of(&self, group: usize) -> Option<&MeetingFields> {
        let layer = self.layers.iter().find(|layer| layer.groups.contains(&group))?;
        match &*layer.flow {
            SegmentFlow::Meeting(fields) => Some(fields),
            SegmentFlow::Fields(_) | SegmentFlow::Paths => None,
        }
    }
}
