//! The fitted flow of a segment and of a project, and everything that it depends on.

use std::sync::Arc;

use super::active_constraints::ActiveConstraints;
use super::flow_numbers::FlowNumbers;
use super::grouping::{CausticFlux, Grouping};
use super::layer::Layer;
use super::memo::Same;
use super::pairing::TransportCost;
use super::segment_photons::{Maps, Matched};
use crate::flow::{FlowReport, FlowSettings, MotionMethod, SegmentFlow};

/// The fitted flow of one segment.
pub(super) struct FittedSegment {
    pub(super) maps: Arc<Maps>,
    pub(super) layers: Vec<Layer>,
    /// By layer.
    pub(super) reports: Vec<FlowReport>,
    /// Transport cost of the pairing of pass 0.
    pub(super) cost: TransportCost,
}

/// The fitted flow of a project; no segments where there is one key frame.
pub(super) struct FittedFlow {
    pub(super) segments: Vec<Arc<FittedSegment>>,
    /// The worst over the segments; absent where nothing moves.
    pub(super) numbers: Option<FlowNumbers>,
    /// The light of each group; empty where no caustic is named.
    pub(super) caustics: Vec<CausticFlux>,
    /// Notes on lights that cast no caustic.
    pub(super) idle_lights: Vec<(usize, String)>,
}

/// Everything that the fit of a segment depends on.
#[derive(PartialEq)]
pub(super) struct FlowInput {
    pub(super) matched: Same<Matched>,
    pub(super) active: ActiveConstraints,
    pub(super) method: MotionMethod,
    pub(super) settings: FlowSettings,
}

impl FittedSegment {
    /// The flow of a group; none where it rests, or where the fit saw no photon of it.
    pub(super) fn flow_of(&self, group: usize) -> Option<&SegmentFlow> {
        self.layers.iter().find(|layer| layer.groups.contains(&group)).map(|layer| &*layer.flow)
    }

    /// The fields of the segment, where the method has any: those that the caustics share, with `None`, and own ones with
    /// the number of the caustic.
    pub(super) fn fields(&self, grouping: &Grouping) -> impl Iterator<Item = (Option<usize>, &SegmentFlow)> {
        self.layers.iter().filter_map(|layer| {
            let own = layer.groups.iter().copied().find(|&group| grouping.own_flow(group));
            layer.flow.steps().map(|_| (own, &*layer.flow))
        })
    }
}
