//! The time during which a constraint acts.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::setting::schema::Describe;
use crate::setting::{Setting, settings};
use crate::{Error, Result};

/// The frames during which a constraint acts.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(transform = Describe(Self::SETTINGS))]
pub struct Span {
    /// First frame.
    pub from: i32,
    /// Last frame, not before `from`.
    pub to: i32,
    /// Frames over which a directed line sets in and fades out ([`Self::FADE`]).
    #[serde(default)]
    pub fade: u32,
}

settings! { Span {
    /// First frame in which the constraint acts.
    FROM = Setting::whole("constraints[].span.from", [-1e6, 1e6], &[]);
    /// Last frame in which the constraint acts, not before the first.
    TO = Setting::whole("constraints[].span.to", [-1e6, 1e6], &[]);
    /// Frames over which a directed line sets in and fades out within its span. A wall stands or does not.
    FADE = Setting::whole("constraints[].span.fade", [0.0, 100_000.0], &[0.0]).unit("frames");
} }

/// A span in time, that of the flow of one segment or frames: rises over the first pair of times, falls over the second.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
pub struct Window {
    /// Nothing before the first, full from the second on.
    pub rise: [f64; 2],
    /// Full until the first, nothing after the second.
    pub fall: [f64; 2],
}

impl Span {
    pub(super) fn check(&self, place: &str) -> Result<()> {
        let place = format!("{place}.span");
        Self::FROM.check(self.from, &place)?;
        Self::TO.check(self.to, &place)?;
        Self::FADE.check(self.fade, &place)?;
        if self.to < self.from {
            let what = format!("ends at frame {}, before it begins at {}", self.to, self.from);
            return Err(Error::value(place, what));
        }
        Ok(())
    }

    /// The window in the segment between two key frames; none where the span lies outside it. `time_of` maps the
    /// elapsed fraction of the frames to flow time, 0..=1.
    pub fn window(&self, keys: [i32; 2], time_of: impl Fn(f64) -> f64) -> Option<Window> {
        if self.to < keys[0] || self.from > keys[1] {
            return None;
        }
        let time = |frame: f64| {
            let share = (frame - f64::from(keys[0])) / (f64::from(keys[1]) - f64::from(keys[0]));
            // What lies beside the segment is over or not yet begun at any of its times.
            if share < 0.0 {
                f64::NEG_INFINITY
            } else if share > 1.0 {
                f64::INFINITY
            } else {
                time_of(share)
            }
        };
        let Window { rise, fall } = self.in_frames();
        Some(Window { rise: rise.map(time), fall: fall.map(time) })
    }

    /// Whether a frame is within it.
    pub fn contains(&self, frame: i32) -> bool {
        (self.from..=self.to).contains(&frame)
    }

    /// Strength of a directed line at a frame, 0..=1, for display: within a segment the fade runs in its flow time.
    pub fn strength(&self, frame: i32) -> f64 {
        self.in_frames().at(f64::from(frame))
    }

    fn in_frames(&self) -> Window {
        let (from, to) = (f64::from(self.from), f64::from(self.to));
        let fade = f64::from(self.fade).min(0.5 * (to - from));
        Window { rise: [from, from + fade], fall: [to - fade, to] }
    }
}

impl Window {
    /// From begin to end.
    pub const ALWAYS: Self = Self { rise: [f64::NEG_INFINITY; 2], fall: [f64::INFINITY; 2] };

    /// Strength at flow time `t`, 0..=1.
    pub fn at(&self, t: f64) -> f64 {
        ramp(self.rise, t) * (1.0 - ramp_after(self.fall, t))
    }

    /// Fraction of the segment in which it acts, 0..=1.
    pub fn duration(&self) -> f64 {
        (self.fall[1].min(1.0) - self.rise[0].max(0.0)).max(0.0)
    }

    /// Whether it acts at any time from `start` to `end`.
    pub fn touches(&self, start: f64, end: f64) -> bool {
        self.rise[0] <= end && self.fall[1] >= start
    }
}

/// 0 before, 1 from the second time on, smooth between.
fn ramp([begin, end]: [f64; 2], t: f64) -> f64 {
    if t >= end {
        return 1.0;
    }
    if t < begin {
        return 0.0;
    }
    smooth(if begin.is_finite() && end.is_finite() { (t - begin) / (end - begin) } else { 1.0 })
}

/// As [`ramp`], but still 0 at the first time.
fn ramp_after([begin, end]: [f64; 2], t: f64) -> f64 {
    if t <= begin {
        return 0.0;
    }
    if t > end {
        return 1.0;
    }
    smooth(if begin.is_finite() && end.is_finite() { (t - begin) / (end - begin) } else { 0.0 })
}

fn smooth(x: f64) -> f64 {
    x * x * (3.0 - 2.0 * x)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn linear(share: f64) -> f64 {
        share
    }

    #[test]
    fn a_span_acts_from_its_first_frame_to_its_last() {
        let window = Span { from: 11, to: 21, fade: 0 }.window([1, 41], linear).unwrap();
        let at = |frame: f64| window.at((frame - 1.0) / 40.0);
        assert_eq!([10.0, 11.0, 15.0, 21.0, 22.0].map(at), [0.0, 1.0, 1.0, 1.0, 0.0]);
    }

    #[test]
    fn a_fade_rises_and_falls_within_the_span() {
        let window = Span { from: 1, to: 41, fade: 10 }.window([1, 41], linear).unwrap();
        assert_eq!([0.0, 0.125, 0.25, 0.75, 1.0].map(|t| window.at(t)), [0.0, 0.5, 1.0, 1.0, 0.0]);
        let span = Span { from: 1, to: 41, fade: 10 };
        assert_eq!(
            [0, 1, 6, 11, 31, 41, 42].map(|frame| span.strength(frame)),
            [0.0, 0.0, 0.5, 1.0, 1.0, 0.0, 0.0]
        );
    }

    #[test]
    fn a_span_beside_the_segment_does_not_act_and_one_that_reaches_over_acts_to_the_border() {
        assert!(Span { from: 50, to: 60, fade: 0 }.window([1, 41], linear).is_none());
        let over = Span { from: -10, to: 90, fade: 0 }.window([1, 41], linear).unwrap();
        assert_eq!((over.at(0.0), over.at(1.0)), (1.0, 1.0));
        let fading = Span { from: -10, to: 90, fade: 20 }.window([1, 41], linear).unwrap();
        assert!(fading.at(0.0).is_finite() && fading.at(1.0).is_finite());
    }
}
