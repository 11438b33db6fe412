//! What the artist decides about targets.

use glam::Vec2;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::setting::schema::Describe;
use crate::setting::{Choice, Setting, settings};
use crate::{Error, Result};

/// Share of the rectangle that a picture fills unless its width is given.
const FILL: f32 = 0.9;

/// A picture whose bright parts attract the photons.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(transform = Describe(Self::SETTINGS))]
pub struct ImageTarget {
    /// PNG, JPEG, WebP, TIFF, OpenEXR or Radiance HDR file, relative to the project.
    pub file: String,
    /// The channel that attracts the photons ([`Self::CHANNEL`]).
    #[serde(default)]
    pub channel: Channel,
    /// Whether the photons take the picture's colours.
    #[serde(default)]
    pub colour: bool,
    /// Whether the dark parts attract instead of the bright ones.
    #[serde(default)]
    pub invert: bool,
    /// Brightness as displayed, 0..=1, below which a pixel counts as black.
    #[serde(default)]
    pub threshold: f32,
    /// Where the picture lies on the receiver (default: in the middle, as large as fits).
    #[serde(default)]
    pub placement: Placement,
}

settings! { ImageTarget {
    /// PNG, JPEG, WebP, TIFF, OpenEXR or Radiance HDR file, relative to the project.
    FILE = Setting::part("keys[].shows.image.file");
    /// The channel of the picture that attracts the light.
    CHANNEL = Setting::choice("keys[].shows.image.channel", &[
        Choice { value: "brightness", help: "linear luminance times opacity; opacity alone where all is black" },
        Choice { value: "alpha", help: "opacity alone" },
    ]);
    /// Whether the light takes the picture's colours; else each photon keeps its own.
    COLOUR = Setting::switch("keys[].shows.image.colour", false);
    /// Whether the dark parts attract instead of the bright ones. Transparent parts never do.
    INVERT = Setting::switch("keys[].shows.image.invert", false);
    /// Brightness as displayed, below which a pixel counts as black. Raise it where a grey ground takes light.
    THRESHOLD = Setting::real("keys[].shows.image.threshold", [0.0, 1.0], &[0.0]);
} }

/// The channel of a picture that attracts photons ([`ImageTarget::CHANNEL`]).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(transform = Describe(ImageTarget::CHANNEL))]
pub enum Channel {
    /// Luminance times opacity.
    #[default]
    Brightness,
    /// Opacity.
    Alpha,
}

/// Where a picture lies on the receiver.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(transform = Describe(Self::SETTINGS))]
pub struct Placement {
    /// Centre, plane coordinates ([`Self::CENTRE`]).
    pub centre: Option<[f32; 2]>,
    /// Width, plane units ([`Self::WIDTH`]).
    pub width: Option<f32>,
    /// Turn about the centre, degrees.
    pub rotate: f32,
}

settings! { Placement {
    /// Centre of the picture: x to the right, y upwards, the plane's longer side is 1. By default the middle of the plane.
    CENTRE = Setting::vector("keys[].shows.image.placement.centre", [-10.0, 10.0], &[]).unit("plane units");
    /// Width of the picture. By default nine tenths of what fits.
    WIDTH = Setting::real("keys[].shows.image.placement.width", [0.0, 10.0], &[]).above().unit("plane units");
    /// Turn of the picture about its centre, counter-clockwise.
    ROTATE = Setting::real("keys[].shows.image.placement.rotate", [-360.0, 360.0], &[0.0]).unit("°");
} }

/// Points to which the photons go, as a file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(transform = Describe(Self::SETTINGS))]
pub struct PointsTarget {
    /// CSV or NPY file, relative to the project.
    pub file: String,
}

settings! { PointsTarget {
    /// CSV (columns x, y and optionally r, g, b; with decimal commas, too, where semicolons or tabs part them) or NPY (n x 2 or
    /// n x 5 numbers) file in plane coordinates, relative to the project.
    FILE = Setting::part("keys[].shows.points.file");
} }

impl ImageTarget {
    /// A picture with all defaults.
    pub fn new(file: impl Into<String>) -> Self {
        Self {
            file: file.into(),
            channel: Channel::default(),
            colour: Self::COLOUR.is_on(),
            invert: Self::INVERT.is_on(),
            threshold: Self::THRESHOLD.value(),
            placement: Placement::default(),
        }
    }

    /// # Errors
    /// `Value` naming the field under `place` that is out of range.
    pub fn check(&self, place: &str) -> Result<()> {
        named(&self.file, place, "a picture")?;
        Self::THRESHOLD.check(self.threshold, place)?;
        self.placement.check(&format!("{place}.placement"))
    }
}

impl PointsTarget {
    /// # Errors
    /// `Value` naming the field under `place` that is out of range.
    pub fn check(&self, place: &str) -> Result<()> {
        named(&self.file, place, "a CSV or NPY file")
    }
}

impl Placement {
    /// # Errors
    /// `Value` naming the field under `place` that is out of range.
    pub fn check(&self, place: &str) -> Result<()> {
        Self::CENTRE.check(self.centre, place)?;
        Self::WIDTH.check(self.width, place)?;
        Self::ROTATE.check(self.rotate, place)
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

/// Refuses an empty file name.
fn named(file: &str, place: &str, kind: &str) -> Result<()> {
    if file.is_empty() { Err(Error::value(format!("{place}.file"), format!("name {kind}"))) } else { Ok(()) }
}
