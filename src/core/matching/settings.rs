//! What the artist decides about the matching.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::setting::schema::Describe;
use crate::setting::{Choice, Setting, settings};

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
#[schemars(transform = Describe(Self::MATCHING))]
pub enum MatchingMethod {
    /// Optimal transport.
    #[default]
    Transport,
    /// Row i of the source to row i of the target.
    Given,
}

settings! { MatchingMethod {
    /// Which photon goes to which place of the target.
    MATCHING = Setting::choice("matching", &[
        Choice { value: "transport", help: "(nearly) least total squared distance: neighbours stay neighbours" },
        Choice { value: "given", help: "row by row, where all keys are files of points with equally many rows" },
    ]);
} }
