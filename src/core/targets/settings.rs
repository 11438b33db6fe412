//! What the artist decides about targets.

use glam::Vec2;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{Error, Result};

/// Widest placement, and farthest centre, in plane units.
const FARTHEST: f32 = 10.0;
/// Share of the rectangle that a picture fills unless its width is given.
const FILL: f32 = 0.9;

/// A picture whose bright parts attract the photons.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ImageTarget {
    /// PNG, JPEG, OpenEXR or Radiance HDR file, relative to the project.
    pub file: String,
    /// What of the picture attracts the photons (default `brightness`).
    #[serde(default)]
    pub channel: Channel,
    /// Whether the photons take the picture's colours on (default false: they keep their own).
    #[serde(default)]
    pub colour: bool,
    /// Whether the dark parts attract instead of the bright ones (default false). Transparent parts never do.
    #[serde(default)]
    pub invert: bool,
    /// Brightness as displayed, 0 to 1, below which a pixel counts as black (default 0).
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub threshold: f32,
    /// Where the picture lies on the receiver (default: in the middle, as large as fits).
    #[serde(default)]
    pub placement: Placement,
}

/// What of a picture attracts photons.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Channel {
    /// Luminance in linear light times opacity; opacity alone in a picture that is black all over.
    #[default]
    Brightness,
    /// Opacity.
    Alpha,
}

/// Where a picture lies on the receiver.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Placement {
    /// Centre of the picture in plane coordinates, x to the right and y upwards, the receiver's longer side 1;
    /// each within -10 to 10 (default: the middle of the receiver).
    pub centre: Option<[f32; 2]>,
    /// Width of the picture in plane units, above 0 up to 10 (default: 0.9 of what fits on the receiver).
    pub width: Option<f32>,
    /// Turn about the centre in degrees, counter-clockwise, -360 to 360 (default 0).
    #[schemars(range(min = -360.0, max = 360.0))]
    pub rotate: f32,
}

/// Points to which the photons go, as a file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PointsTarget {
    /// CSV (columns x, y and perhaps r, g, b) or NPY (n x 2 or n x 5 numbers) in plane coordinates, relative to the project.
    pub file: String,
}

impl ImageTarget {
    /// A picture with all defaults.
    pub fn new(file: impl Into<String>) -> Self {
        Self {
            file: file.into(),
            channel: Channel::default(),
            colour: false,
            invert: false,
            threshold: 0.0,
            placement: Placement::default(),
        }
    }

    /// # Errors
    /// `Value` naming the field under `place` that is out of range.
    pub fn check(&self, place: &str) -> Result<()> {
        require(!self.file.is_empty(), place, "file", "name a picture")?;
        require((0.0..=1.0).contains(&self.threshold), place, "threshold", "give a number from 0 to 1")?;
        self.placement.check(&format!("{place}.placement"))
    }
}

impl PointsTarget {
    /// # Errors
    /// `Value` naming the field under `place` that is out of range.
    pub fn check(&self, place: &str) -> Result<()> {
        require(!self.file.is_empty(), place, "file", "name a CSV or NPY file")
    }
}

impl Placement {
    /// # Errors
    /// `Value` naming the field under `place` that is out of range.
    pub fn check(&self, place: &str) -> Result<()> {
        let near = |value: f32| value.abs() <= FARTHEST;
        let centre = self.centre.unwrap_or_default();
        require(centre.into_iter().all(near), place, "centre", "give plane coordinates from -10 to 10")?;
        let width = self.width.unwrap_or(1.0);
        require(width > 0.0 && near(width), place, "width", "give a number above 0, at most 10")?;
        require(self.rotate.abs() <= 360.0, place, "rotate", "give degrees from -360 to 360")
    }

    /// The frame of a picture of `size` pixels on a receiver of `extent`: its centre, and the plane's steps for one
    /// pixel to the right and for one pixel up.
    pub fn frame(&self, size: Vec2, extent: Vec2) -> (Vec2, Vec2, Vec2) {
        let turn = Vec2::from_angle(self.rotate.to_radians());
        let upright = turn.abs();
        let turned = Vec2::new(upright.dot(size), upright.dot(Vec2::new(size.y, size.x)));
        let pixel = self.width.map_or_else(|| FILL * (extent / turned).min_element(), |width| width / size.x);
        let centre = self.centre.map_or(extent / 2.0, Vec2::from);
        (centre, turn * pixel, turn.perp() * pixel)
    }
}

/// Comparisons with NaN are false, so that what is not a number is refused as well.
fn require(holds: bool, place: &str, field: &str, what: &str) -> Result<()> {
    if holds { Ok(()) } else { Err(Error::value(format!("{place}.{field}"), what)) }
}
