//! Key frames: what the light shows, at which frame.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::caustic::CausticKey;
use super::shows::Shows;
use crate::setting::schema::Describe;
use crate::setting::{Choice, Setting, settings};
use crate::{Error, Result};

/// One key frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(transform = Describe(Self::SETTINGS))]
pub struct KeyFrame {
    /// Frame number. Keys stand in rising order.
    pub frame: i32,
    /// What the light shows at this frame.
    pub shows: Shows,
    /// What single caustics do otherwise at this frame, by the names in `caustics` of the project. Default: nothing.
    #[serde(
        default,
        deserialize_with = "super::caustic::by_name",
        skip_serializing_if = "BTreeMap::is_empty"
    )]
    pub caustics: BTreeMap<String, CausticKey>,
    /// How the time runs from this key to the next.
    #[serde(default)]
    pub ease: Ease,
}

settings! { KeyFrame {
    /// Frame at which the light shows this. Key frames stand in rising order.
    FRAME = Setting::whole("keys[].frame", [-1e6, 1e6], &[]);
    /// What the light shows at this key frame.
    SHOWS = Shows::CHOICE;
    /// How the time runs from this key frame to the next.
    EASE = Setting::choice("keys[].ease", &[
        Choice { value: "smooth", help: "starts and ends at rest" },
        Choice { value: "linear", help: "constant pace" },
        Choice { value: "in", help: "starts at rest, arrives at full pace" },
        Choice { value: "out", help: "starts at full pace, comes to rest" },
        Choice { value: "settle", help: "starts at rest, is soon at full pace, comes to rest slowly" },
    ]);
} }

/// How the time runs between two keys.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(transform = Describe(KeyFrame::EASE))]
pub enum Ease {
    /// x^2 (3 - 2 x).
    #[default]
    Smooth,
    /// x.
    Linear,
    /// x^2.
    In,
    /// x (2 - x).
    Out,
    /// x^2 (6 - 8 x + 3 x^2); its pace, 12 x (1 - x)^2, is the highest after a third of the frames.
    Settle,
}

impl Ease {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Smooth, Self::Linear, Self::In, Self::Out, Self::Settle];

    /// The eased time in the segment for the linear share `x` of its frames; both 0..=1.
    pub fn apply(self, x: f64) -> f64 {
        let x = x.clamp(0.0, 1.0);
        match self {
            Self::Smooth => x * x * (3.0 - 2.0 * x),
            Self::Linear => x,
            Self::In => x * x,
            Self::Out => x * (2.0 - x),
            Self::Settle => x * x * (6.0 - x * (8.0 - 3.0 * x)),
        }
    }
}

impl KeyFrame {
    /// What a caustic shows at this key; without a name, or not mentioned by the key, what the key shows.
    pub fn shown_by(&self, caustic: Option<&str>) -> &Shows {
        let own = caustic.and_then(|name| self.caustics.get(name)?.shows.as_ref());
        own.unwrap_or(&self.shows)
    }
}

/// The time of a frame, relative to its segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SegmentTime {
    /// Index of the segment, from key `segment` to key `segment + 1`; 0 with a single key.
    pub segment: usize,
    /// The eased time in the segment, 0..=1.
    pub time: f64,
}

/// The segment time of `frame`, clamped to the first and the last key.
pub fn segment_time(keys: &[KeyFrame], frame: i32) -> SegmentTime {
    let after = keys.partition_point(|key| key.frame <= frame);
    if keys.len() < 2 || after == 0 {
        return SegmentTime { segment: 0, time: 0.0 };
    }
    if after == keys.len() {
        return SegmentTime { segment: keys.len() - 2, time: 1.0 };
    }
    let (from, to) = (&keys[after - 1], &keys[after]);
    let share = f64::from(frame - from.frame) / f64::from(to.frame - from.frame);
    SegmentTime { segment: after - 1, time: from.ease.apply(share) }
}

/// Checks for at least one key, rising order, and a scene where a key needs one.
pub(super) fn check(keys: &[KeyFrame], has_scene: bool) -> Result<()> {
    if keys.is_empty() {
        return Err(Error::value(
            "keys",
            "there is no key frame; give at least one, such as {\"frame\": 1, \"shows\": …}",
        ));
    }
    for (i, key) in keys.iter().enumerate() {
        KeyFrame::FRAME.check(key.frame, &format!("keys[{i}]"))?;
        if i > 0 && key.frame <= keys[i - 1].frame {
            return Err(Error::value(
                format!("keys[{i}].frame"),
                format!(
                    "frame {} does not come after the key before it (frame {}); give keys in rising order",
                    key.frame,
                    keys[i - 1].frame
                ),
            ));
        }
        if key.shows == Shows::PhysicalCaustic && !has_scene {
            return Err(Error::value(
                format!("keys[{i}].shows"),
                "a physical caustic needs a scene and this project has none; add \"scene\", or show an image or points",
            ));
        }
        key.shows.check(&format!("keys[{i}].shows"))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn keys(frames: &[i32]) -> Vec<KeyFrame> {
        frames
            .iter()
            .map(|&frame| KeyFrame {
                frame,
                shows: Shows::PhysicalCaustic,
                caustics: BTreeMap::new(),
                ease: Ease::Linear,
            })
            .collect()
    }

    #[test]
    fn a_frame_between_two_keys_belongs_to_their_segment() {
        let keys = keys(&[1, 11, 31]);
        assert_eq!(segment_time(&keys, 6), SegmentTime { segment: 0, time: 0.5 });
        assert_eq!(segment_time(&keys, 11), SegmentTime { segment: 1, time: 0.0 });
        assert_eq!(segment_time(&keys, 21), SegmentTime { segment: 1, time: 0.5 });
    }

    #[test]
    fn frames_outside_the_keys_rest_at_the_nearest_key() {
        let keys = keys(&[1, 11]);
        assert_eq!(segment_time(&keys, -5), SegmentTime { segment: 0, time: 0.0 });
        assert_eq!(segment_time(&keys, 11), SegmentTime { segment: 0, time: 1.0 });
        assert_eq!(segment_time(&keys, 99), SegmentTime { segment: 0, time: 1.0 });
    }

    #[test]
    fn every_ease_goes_from_key_to_key_and_rests_where_it_says_so() {
        for ease in Ease::ALL {
            assert_eq!((ease.apply(0.0), ease.apply(1.0)), (0.0, 1.0));
            let times: Vec<f64> = (0..=100).map(|i| ease.apply(f64::from(i) / 100.0)).collect();
            assert!(times.is_sorted(), "{ease:?} goes back");
            // At rest the way of the first hundredth is of second order: at most 6 of its squares.
            let rests = [times[1], 1.0 - times[99]].map(|way| way < 6e-4);
            let says = match ease {
                Ease::Smooth | Ease::Settle => [true, true],
                Ease::Linear => [false, false],
                Ease::In => [true, false],
                Ease::Out => [false, true],
            };
            assert_eq!(rests, says, "{ease:?}");
        }
    }

    #[test]
    fn a_key_without_a_word_on_a_caustic_shows_the_same_by_all() {
        let text = r#"{ "frame": 1, "shows": "physical_caustic",
            "caustics": { "red": { "shows": { "points": { "file": "a.csv" } } }, "blue": { "brightness": 0.5 } } }"#;
        let key: KeyFrame = serde_json::from_str(text).expect("a good key");
        assert!(matches!(key.shown_by(Some("red")), Shows::Points(_)));
        for other in [Some("blue"), Some("green"), None] {
            assert_eq!(*key.shown_by(other), Shows::PhysicalCaustic);
        }
        assert_eq!(key.caustics["blue"].gain(), [0.5; 3]);
    }

    #[test]
    fn a_caustic_that_a_key_names_twice_is_refused() {
        let text = r#"{ "frame": 1, "shows": "physical_caustic", "caustics": { "red": {}, "red": { "brightness": 2 } } }"#;
        let error = serde_json::from_str::<KeyFrame>(text).expect_err("a name twice").to_string();
        assert!(error.contains("duplicate caustic `red`"), "{error}");
    }
}
