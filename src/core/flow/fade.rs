//! How the photons leave the field to arrive exactly: `c' = (1-s) u + s v`, with s from 0 to 1.
//!
//! What the field cannot represent, r = v - u, grows: v' = (1-s)/(1-t) r. A late fade lets it grow by 1/(1-tau) (6.7
//! times for the paper's tau) before anything is done about it: the photons snap into place. Two means against it:
//! fade earlier and evenly, and fade each photon by how fast it would have to hurry. The second bounds the speed whatever
//! the field leaves undone, for v' points along r and vanishes as |v| nears the limit. A field that is itself faster than
//! the limit, as one of hardly any smoothness is between its photons, is left likewise: by the larger of |v| and |u|.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::Result;
use crate::math::smoothstep::smoothstep;
use crate::setting::schema::Describe;
use crate::setting::{Choice, Setting, settings};

/// The transition of the photons from the field to their targets.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "type", rename_all = "snake_case", deny_unknown_fields)]
#[schemars(transform = Describe(Self::SETTINGS))]
pub enum Fade {
    /// Early and even.
    Smooth {
        /// Begin of the fade ([`Self::START`]).
        #[serde(default = "default_start")]
        start: f32,
        /// End of the fade ([`Self::END`]).
        #[serde(default = "default_end")]
        end: f32,
        /// Speed limit in the field ([`Self::LIMIT`]).
        #[serde(default = "default_limit")]
        limit: f32,
    },
    /// The paper's: the field alone until `tau`, then linear.
    Paper {
        /// Begin of the fade ([`Self::TAU`]).
        #[serde(default = "default_tau")]
        tau: f32,
    },
}

/// A [`Fade`] as it is baked: the formats of bakes know no names of types.
#[derive(Serialize, Deserialize)]
#[serde(remote = "Fade")]
pub(super) enum PlainFade {
    Smooth { start: f32, end: f32, limit: f32 },
    Paper { tau: f32 },
}

settings! { Fade {
    /// How the photons leave the field to arrive exactly at their targets.
    KIND = Setting::choice("flow.fade", &[
        Choice { value: "smooth", help: "early and even: no photon has to hurry at the end" },
        Choice { value: "paper", help: "the field alone until tau, as in the paper; the last photons snap into place" },
    ]);
    /// Share of the time until which the field steers alone. Later keeps the flow longer and arrives faster.
    START = Setting::real("flow.fade.start", [0.0, 0.99], &[0.3]);
    /// Share of the time from which the photons go straight to their targets; at least 0.01 after the start.
    END = Setting::real("flow.fade.end", [0.01, 1.0], &[0.9]);
    /// Speed towards which a photon leaves the field early, in mean straight speeds; one with a longer path of its own
    /// may keep its pace. Lower it where light darts.
    LIMIT = Setting::real("flow.fade.limit", [1.0, 1000.0], &[3.0]);
    /// Share of the time after which the photons are drawn to their targets.
    TAU = Setting::real("flow.fade.tau", [0.0, 0.99], &[0.85]);
} }

fn default_start() -> f32 {
    Fade::START.value()
}
fn default_end() -> f32 {
    Fade::END.value()
}
fn default_limit() -> f32 {
    Fade::LIMIT.value()
}
fn default_tau() -> f32 {
    Fade::TAU.value()
}

/// A photon keeps the field while it is slower than this share of its speed limit.
const SPEED_RAMP_START: f32 = 0.7;
/// A photon with a long way may go this much faster than on its straight line. SPEED_RAMP_START times this is more than 1, so that
/// none leaves the field at the start.
const OWN_SPEED_FACTOR: f32 = 1.5;

impl Default for Fade {
    fn default() -> Self {
        Self::Smooth { start: default_start(), end: default_end(), limit: default_limit() }
    }
}

impl Fade {
    /// Least time from `start` to `end`.
    pub const APART: f32 = 0.01;

    /// The paper's fade, with its default.
    pub fn paper() -> Self {
        Self::Paper { tau: default_tau() }
    }

    /// Refuses values out of range; `place` is the path of this fade, such as `flow.fade`.
    ///
    /// # Errors
    /// `Value` names what is out of range.
    pub fn check(&self, place: &str) -> Result<()> {
        match *self {
            Self::Smooth { start, end, limit } => {
                Self::START.check(start, place)?;
                let range = [f64::from(start + Self::APART), Self::END.range[1]];
                Setting { range, ..Self::END }.check(end, place)?;
                Self::LIMIT.check(limit, place)
            }
            Self::Paper { tau } => Self::TAU.check(tau, place),
        }
    }

    /// The field is not asked any more from this time on.
    pub fn end(&self) -> f64 {
        match *self {
            Self::Smooth { end, .. } => end.into(),
            Self::Paper { .. } => 1.0,
        }
    }

    /// Share of the field, 1 - s, at time `t`, before any photon's hurry.
    pub fn share(&self, t: f64) -> f64 {
        match *self {
            Self::Smooth { start, end, .. } => {
                1.0 - smoothstep((t - f64::from(start)) / f64::from(end - start))
            }
            Self::Paper { tau } => 1.0 - ((t - f64::from(tau)) / (1.0 - f64::from(tau))).clamp(0.0, 1.0),
        }
    }

    /// (1 - s) / (1 - t), bounded for every `t` up to and with 1.
    pub(super) fn rate(&self, t: f64) -> f32 {
        match *self {
            Self::Paper { tau } => (1.0 / (1.0 - t.min(f64::from(tau)))) as f32,
            Self::Smooth { end, .. } if t >= f64::from(end) => 0.0,
            Self::Smooth { .. } => (self.share(t) / (1.0 - t)) as f32,
        }
    }

    /// Speed at which a photon with a straight way of `straight` leaves the field whatever the time.
    pub(super) fn speed_limit(&self, straight: f32, mean_straight: f32) -> f32 {
        match *self {
            Self::Smooth { limit, .. } => (OWN_SPEED_FACTOR * straight).max(limit * mean_straight),
            Self::Paper { .. } => f32::INFINITY,
        }
    }
}

/// Share of the field left where the larger of the speeds of guidance and field is this part of a photon's limit.
#[inline(always)]
pub(super) fn ease(speed_over_limit: f32) -> f32 {
    let x = ((speed_over_limit - SPEED_RAMP_START) / (1.0 - SPEED_RAMP_START)).clamp(0.0, 1.0);
    1.0 - x * x * (3.0 - 2.0 * x)
}
