//! A fitted flow as it is baked.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::fitted_segment::{FittedFlow, FittedSegment};
use super::flow_numbers::FlowNumbers;
use super::grouping::CausticFlux;
use super::layer::Layer;
use super::pairing::TransportCost;
use super::segment_photons::{Maps, MeetingFlow};
use crate::flow::FlowReport;
use crate::flow::meeting::BridgeReport;
use crate::matching::ContinuousMap;

/// The fitted flow of a project.
#[derive(Serialize, Deserialize)]
pub(super) struct BakedFlow {
    segments: Vec<BakedSegment>,
    caustics: Vec<CausticFlux>,
    idle_lights: Vec<(usize, String)>,
}

/// The fitted flow of a segment. Where key frames meet half way, the flow to the meeting has the same layers.
#[derive(Serialize, Deserialize)]
struct BakedSegment {
    by_group: Vec<Option<ContinuousMap>>,
    meeting: Option<(Vec<FlowReport>, Vec<BridgeReport>)>,
    layers: Vec<Layer>,
    reports: Vec<FlowReport>,
    cost: TransportCost,
}

impl From<&FittedFlow> for BakedFlow {
    fn from(flow: &FittedFlow) -> Self {
        let segment = |fitted: &Arc<FittedSegment>| {
            let FittedSegment { maps, layers, reports, cost } = &**fitted;
            BakedSegment {
                by_group: maps.by_group.clone(),
                meeting: maps.meeting.as_ref().map(|meeting| (meeting.fits.clone(), meeting.plans.clone())),
                layers: layers.clone(),
                reports: reports.clone(),
                cost: *cost,
            }
        };
        let segments = flow.segments.iter().map(segment).collect();
        Self { segments, caustics: flow.caustics.clone(), idle_lights: flow.idle_lights.clone() }
    }
}

impl From<BakedFlow> for FittedFlow {
    fn from(BakedFlow { segments, caustics, idle_lights }: BakedFlow) -> Self {
        let mut flow = Self { segments: Vec::new(), numbers: None, caustics, idle_lights };
        for BakedSegment { by_group, meeting, layers, reports, cost } in segments {
            let meeting =
                meeting.map(|(fits, plans)| Arc::new(MeetingFlow { layers: layers.clone(), fits, plans }));
            let maps = Arc::new(Maps { by_group, meeting });
            flow.push(Arc::new(FittedSegment { maps, layers, reports, cost }));
        }
        flow
    }
}

impl FittedFlow {
    /// Appends a segment, and keeps the worse of its numbers and those before.
    pub(super) fn push(&mut self, segment: Arc<FittedSegment>) {
        let numbers = FlowNumbers::of_segment(segment.reports.clone(), &segment.cost);
        self.numbers = self.numbers.take().into_iter().chain(numbers).reduce(FlowNumbers::worst);
        self.segments.push(segment);
    }
}
