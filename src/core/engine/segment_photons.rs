//! The matching of a segment, and everything that it depends on.

use std::sync::Arc;

use glam::Vec2;

use super::key_photons::KeyPhotons;
use super::key_sources::KeySource;
use super::layer::Layer;
use super::memo::Same;
use super::pairing::{Pairing, PairingMethod, TransportCost};
use crate::flow::FlowReport;
use crate::flow::meeting::{BridgeReport, HalfTracks};
use crate::matching::{ContinuousMap, MatchingMethod};
use crate::photon::EmissionGuide;
use crate::project::CausticDesc;

/// How the photons of all passes are paired in a segment.
pub(super) struct Maps {
    /// By group; absent where rows are paired as given, where the group rests, and where it has no photon. Where the key
    /// frames meet half way, the map from one side of the meeting to the other.
    pub(super) by_group: Vec<Option<ContinuousMap>>,
    /// The flow that carries both key frames to their meeting; absent where photons are paired before they flow.
    pub(super) meeting: Option<Arc<MeetingFlow>>,
}

/// The flow of a segment whose key frames meet half way, made before its photons are paired.
pub(super) struct MeetingFlow {
    pub(super) layers: Vec<Layer>,
    /// By layer.
    pub(super) fits: Vec<FlowReport>,
    pub(super) plans: Vec<BridgeReport>,
}

/// The tracks of a group's photons from both key frames to the meeting, row by row.
pub(super) type GroupTracks = [HalfTracks; 2];

/// The photons of a pass at both key frames of a segment, row by row.
pub(super) struct SegmentPhotons {
    /// Number of the segment, from 0.
    pub(super) number: usize,
    /// By group, at the earlier key frame.
    pub(super) from: Arc<Vec<KeyPhotons>>,
    /// By group, at the later one.
    pub(super) to: Arc<Vec<KeyPhotons>>,
    /// Flux that all photons should have at both, watts; rho does not count.
    pub(super) requested: [f64; 2],
    /// The groups that move; those together that share a field.
    pub(super) layers: Vec<Vec<usize>>,
    pub(super) matched: Arc<Matched>,
    /// By group, where they were made to pair its photons.
    pub(super) tracks: Vec<Option<GroupTracks>>,
}

/// The matching of one segment.
pub(super) struct Matched {
    /// By group.
    pub(super) pairings: Vec<Pairing>,
    pub(super) maps: Arc<Maps>,
    pub(super) cost: TransportCost,
}

/// Everything that a matching depends on.
#[derive(PartialEq)]
pub(super) struct MatchInput {
    pub(super) from: Origin,
    pub(super) sources: Vec<Same<KeySource>>,
    pub(super) method: PairingMethod,
    pub(super) anchors: usize,
    pub(super) bounded: bool,
    pub(super) maps: Option<Same<Maps>>,
}

/// Everything that the photons at a key frame depend on.
#[derive(Clone, PartialEq)]
pub(super) enum Origin {
    /// At the first key frame.
    First(Box<FirstKey>),
    /// At a later one, as they were matched.
    Matched(Same<Matched>),
}

#[derive(Clone, PartialEq)]
pub(super) struct FirstKey {
    pub(super) guide: Option<Same<EmissionGuide>>,
    pub(super) photons: usize,
    pub(super) seed: u64,
    pub(super) extent: Vec2,
    pub(super) caustics: Vec<CausticDesc>,
    pub(super) matching: MatchingMethod,
    pub(super) sources: Vec<Same<KeySource>>,
}
