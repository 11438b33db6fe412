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
    /// Both key frames are carried along fitted fields by a plan of the whole body of light, and paired half way.
    #[default]
    Flow,
    /// The paper's: paired by optimal transport first, each photon guided to its target, Eq. (2).
    Guided,
    /// The method of 2016 (Stylized Caustics).
    Stylized,
    /// Straight lines, paired by optimal transport.
    Linear,
}

settings! { MotionMethod {
    /// How the light gets from key frame to key frame.
    METHOD = Setting::choice("method", &[
        Choice { value: "flow", help: "the whole light is planned as one body and meets its target half way" },
        Choice { value: "guided", help: "the paper's: each photon is paired first and guided to its target" },
        Choice { value: "stylized", help: "the method of 2016, to compare with: landmarks, a warp, greedy pairs" },
        Choice { value: "linear", help: "straight lines at constant speed, to compare with" },
    ]);
} }

impl MotionMethod {
    /// All methods, the default first.
    pub const ALL: [Self; 4] = [Self::Flow, Self::Guided, Self::Stylized, Self::Linear];

    /// Whether fields are fitted, so that lines and walls act.
    pub fn fits(self) -> bool {
        matches!(self, Self::Flow | Self::Guided)
    }

    /// The name in project files; also that of its folder in a comparison.
    pub fn name(self) -> &'static str {
        match self {
            Self::Flow => "flow",
            Self::Guided => "guided",
            Self::Stylized => "stylized",
            Self::Linear => "linear",
        }
    }

    /// What it does, in a few words.
    pub fn describe(self) -> &'static str {
        match self {
            Self::Flow => "planned, meets half way",
            Self::Guided => "guided fields",
            Self::Stylized => "landmarks and warp",
            Self::Linear => "straight lines",
        }
    }
}
