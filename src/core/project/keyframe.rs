//! Key frames: what the light shows, at which frame.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::CausticKey;
use crate::setting::schema::Describe;
use crate::setting::{Choice, Setting, settings};
use crate::targets::{ImageTarget, PointsTarget};
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
    SHOWS = Setting::choice("keys[].shows", &[
        Choice { value: "physical_caustic", help: "what the scene's glass and mirrors really cast" },
        Choice { value: "image", help: "a picture: its bright parts attract the light" },
        Choice { value: "points", help: "a file of points, one for each photon or fewer" },
        Choice { value: "", help: "what the key frame shows by all light" },
    ]).required();
    /// How the time runs from this key frame to the next.
    EASE = Setting::choice("keys[].ease", &[
        Choice { value: "smooth", help: "starts and ends at rest" },
        Choice { value: "linear", help: "constant pace" },
        Choice { value: "in", help: "starts at rest, arrives at full pace" },
        Choice { value: "out", help: "starts at full pace, comes to rest" },
    ]);
} }

/// What the light shows at a key frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(transform = Describe(KeyFrame::SHOWS))]
pub enum Shows {
    /// The caustic that the scene casts.
    PhysicalCaustic,
    /// A picture.
    Image(ImageTarget),
    /// A file of points.
    Points(PointsTarget),
}

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
}

impl Ease {
    /// The eased time in the segment for the linear share `x` of its frames; both 0..=1.
    pub fn apply(self, x: f64) -> f64 {
        let x = x.clamp(0.0, 1.0);
        match self {
            Self::Smooth => x * x * (3.0 - 2.0 * x),
            Self::Linear => x,
            Self::In => x * x,
            Self::Out => x * (2.0 - x),
        }
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

impl Shows {
    /// Refuses what is out of range, naming its place under `place`.
    pub(super) fn check(&self, place: &str) -> Result<()> {
        match self {
            Self::PhysicalCaustic => Ok(()),
            Self::Image(image) => image.check(&format!("{place}.image")),
            Self::Points(points) => points.check(&format!("{place}.points")),
        }
    }
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
    fn every_ease_begins_at_the_key_and_ends_at_the_next() {
        for ease in [Ease::Smooth, Ease::Linear, Ease::In, Ease::Out] {
            assert_eq!((ease.apply(0.0), ease.apply(1.0)), (0.0, 1.0));
        }
    }
}
