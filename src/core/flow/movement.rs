//! The methods by which photons get from key to key.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How the photons get from key to key.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Movement {
    /// Along a fitted vector field, paired by optimal transport.
    #[default]
    Flow,
    /// The method before (Stylized Caustics, 2016), to compare with: landmarks, thin-plate warp, greedy pairs, cubic ways.
    Stylized,
    /// Straight at constant speed, paired by optimal transport, to compare with.
    Linear,
}

impl Movement {
    /// All methods, the default first.
    pub const ALL: [Self; 3] = [Self::Flow, Self::Stylized, Self::Linear];

    /// The name in project files; also that of its folder in a comparison.
    pub fn name(self) -> &'static str {
        match self {
            Self::Flow => "flow",
            Self::Stylized => "stylized",
            Self::Linear => "linear",
        }
    }

    /// What it does, in a few words.
    pub fn describe(self) -> &'static str {
        match self {
            Self::Flow => "vector field",
            Self::Stylized => "landmarks and warp",
            Self::Linear => "straight lines",
        }
    }
}
