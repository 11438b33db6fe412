//! How the photons leave the field to arrive exactly: `c' = (1-s) u + s v`, with s from 0 to 1.
//!
//! What the field cannot represent, r = v - u, grows: v' = (1-s)/(1-t) r. A late fade lets it grow by 1/(1-tau) (6.7
//! times for the paper's tau) before anything is done about it: the photons snap into place. Two means against it:
//! fade earlier and evenly, and fade each photon by how fast it would have to hurry. The second bounds the speed whatever
//! the field leaves undone, for v' points along r and vanishes as |v| nears the limit.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{Error, Result};

/// How the photons leave the field to arrive exactly at their targets.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "type", rename_all = "snake_case", deny_unknown_fields)]
pub enum Fade {
    /// Early and even, so that no photon has to hurry at the end.
    Smooth {
        /// Until then the field steers alone, 0 to 0.99 of the time between the key frames. Default 0.3.
        #[serde(default = "default_start")]
        start: f32,
        /// From then on the photons go straight, above `start` to 1. Default 0.9.
        #[serde(default = "default_end")]
        end: f32,
        /// Speed towards which a photon leaves the field early, in mean straight speeds, 1 to 1000; a photon whose own
        /// way is longer may keep its pace. Default 3.
        #[serde(default = "default_limit")]
        limit: f32,
    },
    /// The paper's: the field alone until `tau`, then linear. The last photons snap into place.
    Paper {
        /// When it begins, 0 to 0.99 of the time between the key frames. Default 0.85.
        #[serde(default = "default_tau")]
        tau: f32,
    },
}

fn default_start() -> f32 {
    0.3
}
fn default_end() -> f32 {
    0.9
}
fn default_limit() -> f32 {
    3.0
}
fn default_tau() -> f32 {
    0.85
}

/// A photon keeps the field while it is slower than this share of its speed limit.
const AT_EASE: f32 = 0.7;
/// A photon with a long way may go this much faster than on its straight line. AT_EASE times this is more than 1, so that
/// none leaves the field at the start.
const OWN_PACE: f32 = 1.5;

impl Default for Fade {
    fn default() -> Self {
        Self::Smooth { start: default_start(), end: default_end(), limit: default_limit() }
    }
}

impl Fade {
    /// Refuses values out of range; `place` is the path of this fade, such as `flow.fade`.
    ///
    /// # Errors
    /// `Value` names what is out of range.
    pub fn check(&self, place: &str) -> Result<()> {
        let check = |name: &str, value: f32, low: f32, high: f32, why: &str| {
            if (low..=high).contains(&value) {
                return Ok(());
            }
            Err(Error::value(format!("{place}.{name}"), format!("is {value}, must be {low} to {high}{why}")))
        };
        match *self {
            Self::Smooth { start, end, limit } => {
                check("start", start, 0.0, 0.99, "")?;
                check("end", end, start + 0.01, 1.0, ": it comes after `start`")?;
                check("limit", limit, 1.0, 1000.0, "")
            }
            Self::Paper { tau } => check("tau", tau, 0.0, 0.99, ": a later fade cannot arrive"),
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
            Self::Smooth { limit, .. } => (OWN_PACE * straight).max(limit * mean_straight),
            Self::Paper { .. } => f32::INFINITY,
        }
    }
}

/// Share of the field left to a photon at this part of its speed limit.
#[inline(always)]
pub(super) fn ease(speed_over_limit: f32) -> f32 {
    let x = ((speed_over_limit - AT_EASE) / (1.0 - AT_EASE)).clamp(0.0, 1.0);
    1.0 - x * x * (3.0 - 2.0 * x)
}

/// From 0 to 1 without a kink at either end; clipped beyond.
pub(super) fn smoothstep(x: f64) -> f64 {
    let x = x.clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}
