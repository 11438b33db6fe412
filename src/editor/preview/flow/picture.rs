//! The visible flow at one frame, and the request for it.

use std::sync::Arc;

use glam::Vec2;
use lightloom_core::engine::Preview;
use lightloom_core::project::Project;

use crate::editor::session::{FieldMap, Overlays};

/// The visible flow at one frame. Positions in plane coordinates, velocities in plane units per segment.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FlowPicture {
    /// Positions on a lattice, with the velocities there.
    pub arrows: Vec<(Vec2, Vec2)>,
    /// Speed of the full colour: the 95th percentile on the lattice.
    pub fast: f32,
    /// Streamlines of the field at this frame, at equal time steps.
    pub streamlines: Vec<Vec<Vec2>>,
    /// The visible map.
    pub map: Option<HeatMap>,
    /// Paths of some photons over all frames.
    pub trails: Vec<Vec<Vec2>>,
    /// The followed photon.
    pub followed: Option<Followed>,
}

/// A quantity of the field on a lattice that covers the plane.
#[derive(Clone, Debug, PartialEq)]
pub struct HeatMap {
    /// Which quantity.
    pub of: FieldMap,
    /// Cells along x and y; there is one node more in each direction.
    pub cells: [usize; 2],
    /// Values at the nodes, row by row from y 0.
    pub values: Vec<f32>,
    /// Magnitude of the full colour: the 99th percentile.
    pub most: f32,
}

/// A followed photon.
#[derive(Clone, Debug, PartialEq)]
pub struct Followed {
    /// Its path over all computed frames.
    pub trajectory: Vec<Vec2>,
    /// Its position at this frame.
    pub at: Vec2,
    /// Its target at the next key frame.
    pub target: Vec2,
    /// Shortest path there around the active walls; straight where none is between, empty where there is no
    /// path.
    pub path_around_walls: Vec<Vec2>,
}

/// A request to the flow worker.
#[derive(Clone)]
pub(super) struct Request {
    pub(super) preview: Arc<Preview>,
    pub(super) project: Arc<Project>,
    pub(super) frame: i32,
    pub(super) show: Overlays,
    /// Index of the caustic whose field is shown, if it has its own.
    pub(super) caustic: Option<usize>,
    pub(super) probe: Option<usize>,
    /// Number of arrows along the plane's longer side.
    pub(super) arrows: usize,
}

impl PartialEq for Request {
    fn eq(&self, other: &Self) -> bool {
        let rest = |r: &Self| (r.frame, r.show, r.caustic, r.probe, r.arrows);
        Arc::ptr_eq(&self.preview, &other.preview)
            && Arc::ptr_eq(&self.project, &other.project)
            && rest(self) == rest(other)
    }
}
