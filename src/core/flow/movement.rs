//! The methods by which photons get from key to key.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::setting::schema::Describe;
use crate::setting::{Choice, Setting, settings};

/// How the photons get from key to key.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(transform = Describe(Self::METHOD))]
pub enum MotionMethod {
    /// Along a fitted vector field, paired by optimal transport.
    #[default]
    Flow,
    /// The method of 2016 (Stylized Caustics).
    Stylized,
    /// Straight lines, paired by optimal transport.
    Linear,
}

settings! { MotionMethod {
    /// How the light gets from key frame to key frame.
    METHOD = Setting::choice("method", &[
        Choice { value: "flow", help: "along a fitted field; the only one that heeds lines and walls" },
        Choice { value: "stylized", help: "the method of 2016, to compare with: landmarks, a warp, greedy pairs" },
        Choice { value: "linear", help: "straight lines at constant speed, to compare with" },
    ]);
} }

impl MotionMethod {
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
