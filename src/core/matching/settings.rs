//! What the artist decides about the matching.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

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
