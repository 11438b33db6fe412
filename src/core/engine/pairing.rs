//! The pairing of the photons at one key frame with the points of the next.

use std::sync::Arc;

use glam::Vec2;

use super::active_constraints::{ActiveConstraints, active};
use super::key_photons::KeyPhotons;
use crate::constraint::{ActiveWall, VisibilityGraph};
use crate::flow::{FlowSettings, MotionMethod};
use crate::matching::{ContinuousMap, MatchingMethod, StylizedMap, WallMap, transport_map};
use crate::project::Project;
use crate::{Progress, Result};

/// Share of a segment that a wall must stand to take part in the matching; photons only go around others.
const LASTING: f64 = 0.5;

/// Whether a wall takes part in the matching.
pub(super) fn takes_part(wall: &ActiveWall) -> bool {
    wall.window.duration() >= LASTING
}

/// The method by which the points of a segment are paired.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum PairingMethod {
    /// Row by row, as given.
    Given,
    /// Optimal transport along straight lines.
    Transport,
    /// Optimal transport along the shortest paths around these walls.
    AroundWalls(Vec<ActiveWall>),
    /// Landmarks and a thin-plate warp (Günther et al. 2016).
    Stylized,
    /// Where the light of both key frames meets half way along this flow.
    Meeting(Box<MeetingInput>),
}

/// Everything that a flow depends on which meets half way, but for the light.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct MeetingInput {
    pub(super) settings: FlowSettings,
    pub(super) active: ActiveConstraints,
}

impl PairingMethod {
    /// The method of a project in segment `segment`.
    pub(super) fn of(project: &Project, segment: usize, extent: Vec2) -> Self {
        match (project.matching, project.method) {
            (MatchingMethod::Given, _) => Self::Given,
            (MatchingMethod::Transport, MotionMethod::Flow) => {
                // rho acts on the flux alone.
                let settings = FlowSettings { rho: 1.0, ..project.flow.clone() };
                let active = active(project, segment, extent);
                Self::Meeting(Box::new(MeetingInput { settings, active }))
            }
            (MatchingMethod::Transport, MotionMethod::Linear) => Self::Transport,
            (MatchingMethod::Transport, MotionMethod::Stylized) => Self::Stylized,
            (MatchingMethod::Transport, MotionMethod::Guided) => {
                let mut walls = active(project, segment, extent).walls;
                walls.retain(takes_part);
                if walls.is_empty() { Self::Transport } else { Self::AroundWalls(walls) }
            }
        }
    }

    /// The map between these points, around walls by at most `anchors` anchors; none where rows are paired as given.
    pub(super) fn map(
        &self,
        (from, to): (&[Vec2], &[Vec2]),
        (extent, anchors): (Vec2, usize),
        progress: &Progress,
    ) -> Result<Option<ContinuousMap>> {
        Ok(match self {
            Self::Given => None,
            Self::Transport | Self::Meeting(_) => {
                Some(ContinuousMap::Transport(transport_map(from, to, extent, progress)?))
            }
            Self::AroundWalls(walls) => {
                let walls: Vec<&ActiveWall> = walls.iter().collect();
                let graph = Arc::new(VisibilityGraph::new(&walls, extent, progress)?);
                let map = WallMap::with_anchors(anchors, from, to, &graph, progress)?;
                Some(ContinuousMap::Walls(map, graph))
            }
            Self::Stylized => Some(ContinuousMap::Stylized(StylizedMap::new(from, to, progress)?)),
        })
    }
}

/// The target of each photon of a group among the group's points at the next key frame.
#[derive(Clone, Debug, Default)]
pub(super) struct Pairing {
    /// Photon k goes to point `order[k]`; absent where it goes to point k.
    pub(super) order: Option<Vec<u32>>,
    /// See [`KeyPhotons::midpoint_offsets`].
    pub(super) midpoint_offsets: Vec<Vec2>,
}

impl Pairing {
    /// The points in the rows of their photons.
    pub(super) fn arrange(&self, points: KeyPhotons) -> KeyPhotons {
        let mut arranged = match &self.order {
            Some(order) => points.permuted(order),
            None => points,
        };
        arranged.midpoint_offsets.clone_from(&self.midpoint_offsets);
        arranged
    }
}

/// The transport cost of the pairing of all groups, squared plane units.
#[derive(Clone, Copy, Debug, Default, serde::Deserialize, serde::Serialize)]
pub(super) struct TransportCost {
    /// Photons that were paired; those that rest are not.
    photons: f64,
    /// Sum of the squared distances of the pairs.
    sum: f64,
    /// A lower bound of the sum for any pairing; absent where the method knows none.
    pub(super) bound: Option<f64>,
}

impl TransportCost {
    /// Counts `photons` more, with their mean squared distance and a lower bound of it.
    pub(super) fn add(&mut self, photons: usize, mean: f64, bound: Option<f64>) {
        let (before, more) = (Some(0.0).filter(|_| self.photons == 0.0).or(self.bound), photons as f64);
        self.photons += more;
        self.sum += more * mean;
        self.bound = before.zip(bound).map(|(before, bound)| before + more * bound);
    }

    /// Mean squared distance of the pairs.
    pub(super) fn mean(&self) -> f64 {
        self.sum / self.photons.max(1.0)
    }

    /// The sum over `bound`, that of this or of another method for the same points.
    pub(super) fn ratio(&self, bound: Option<f64>) -> Option<f64> {
        // Nothing to move costs nothing, which is the optimum.
        bound.map(|bound| if bound > 0.0 { self.sum / bound } else { 1.0 })
    }
}
