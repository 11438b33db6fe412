//! What the artist decides about the matching.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How exactly the transport map is worked out. The default is what projects are matched with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapSettings {
    /// Cells along the longer side of the lattice, rounded up to a multiple of 16. Default one for every four points, at
    /// least 32 x 32 and at most 256 x 256.
    pub cells: Option<usize>,
    /// Iterations at most on each lattice, on the coarsest twice as many. Default 20.
    pub iterations: usize,
    /// The iteration that raises the dual value by no more than this share is the last. Default 1e-5.
    pub tolerance: f64,
}

impl Default for MapSettings {
    fn default() -> Self {
        Self { cells: None, iterations: 20, tolerance: 1e-5 }
    }
}

/// A way to pair photons with target points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Method {
    /// The pairing of (nearly) least total squared distance: photons that are neighbours stay neighbours.
    #[default]
    Transport,
    /// Row i of the source goes to row i of the target; both need the same number of rows.
    Given,
}
