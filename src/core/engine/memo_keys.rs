//! The keys under which emission guides, camera views and positions are remembered.

use glam::Vec2;

use super::fitted_segment::FittedSegment;
use super::memo::Same;
use super::segment_photons::Matched;
use super::still_light::StillShares;
use crate::project::CausticDesc;
use crate::render::{RenderSettings, TextureLayout};
use crate::scene::{Geometry, LightDesc, ReceiverDesc, Scene};

/// Everything that the emission guide of a scene depends on.
#[derive(PartialEq)]
pub(super) struct GuideInput {
    pub(super) geometry: Same<Geometry>,
    /// Of the same number of lights those that cast caustics.
    pub(super) lights: Vec<Option<LightDesc>>,
    pub(super) receiver: ReceiverDesc,
    pub(super) seed: u64,
}

/// Everything that the camera's stages depend on.
#[derive(Clone, PartialEq)]
pub(super) struct ViewInput {
    pub(super) scene: Option<Same<Scene>>,
    pub(super) render: RenderSettings,
    pub(super) extent: Vec2,
    pub(super) seed: u64,
    pub(super) layout: Option<TextureLayout>,
    pub(super) rough: bool,
}

/// Everything that the light depends on that does not flow.
#[derive(PartialEq)]
pub(super) struct StillInput {
    pub(super) view: ViewInput,
    pub(super) photons: (u64, u32),
    pub(super) caustics: Vec<CausticDesc>,
    pub(super) shares: Vec<Option<StillShares>>,
    /// Whether the light of each caustic is wanted by itself.
    pub(super) apart: bool,
    /// Whether it is wanted on the plane, too.
    pub(super) on_plane: bool,
}

/// Everything that the frames of a segment depend on.
#[derive(PartialEq)]
pub(super) struct PositionsInput {
    pub(super) fitted: Same<FittedSegment>,
    pub(super) matched: Same<Matched>,
    pub(super) times: Vec<f64>,
}
