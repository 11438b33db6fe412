//! What is written: formats, names, pace.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::frames;
use crate::export::{FrameFormat, FrameLayer, FramePattern, PngDepth};
use crate::setting::schema::Describe;
use crate::setting::{Choice, Setting, settings};
use crate::{Error, Result};

/// What is written.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(transform = Describe(Self::SETTINGS))]
pub struct OutputSettings {
    /// File name without its ending.
    pub name: String,
    /// List of frames ([`Self::FRAMES`]).
    pub frames: Option<String>,
    /// Frames per second as a fraction.
    pub fps: [u32; 2],
    /// Formats: "exr", "png".
    pub formats: Vec<FrameFormat>,
    /// Layers of EXR files ([`Self::LAYERS`]).
    pub layers: Vec<FrameLayer>,
    /// Bits per channel of PNG files, 8 or 16.
    pub png_bits: u8,
    /// Whether sheets show the drawn constraints ([`Self::DRAWS_CONSTRAINTS`]).
    pub draws_constraints: bool,
}

settings! { OutputSettings {
    /// File name without its ending; #### or %04d stands for the frame number. Default frame.####
    NAME = Setting::text("output.name");
    /// Frames to render, such as 1-100x5,120. Default: all from the first key frame to the last.
    FRAMES = Setting::text("output.frames");
    /// Frames per second as a fraction: 24000 over 1001 is 23.976.
    FPS = Setting::whole("output.fps", [1.0, 1e6], &[24.0, 1.0]);
    /// Formats: "exr" holds the light itself in layers, for compositing; "png" shows it as on a screen. Default both.
    FORMATS = Setting::part("output.formats");
    /// Layers of EXR files: "beauty", "caustic", "caustics" (one for each named caustic), "background", "depth",
    /// "plane" (the light on the receiver, W/m², in files of its own). Without beauty and background none is traced, and PNG
    /// files show the caustics alone. Default all but "caustics" and "plane".
    LAYERS = Setting::part("output.layers");
    /// Bits per channel of PNG files.
    PNG_BITS = Setting::choice("output.png_bits", &[
        Choice { value: "8", help: "small files" },
        Choice { value: "16", help: "smooth dark gradients, larger files" },
    ]);
    /// Whether contact sheets and comparison sheets show the drawn lines and walls as thin lines over the light.
    DRAWS_CONSTRAINTS = Setting::switch("output.draws_constraints", false);
} }

impl Default for OutputSettings {
    fn default() -> Self {
        Self {
            name: "frame.####".into(),
            frames: None,
            fps: Self::FPS.value(),
            formats: vec![FrameFormat::Exr, FrameFormat::Png],
            layers: FrameLayer::DEFAULT.to_vec(),
            png_bits: 8,
            draws_constraints: Self::DRAWS_CONSTRAINTS.is_on(),
        }
    }
}

impl OutputSettings {
    /// The depth of PNG files.
    pub fn png_depth(&self) -> PngDepth {
        if self.png_bits == 16 { PngDepth::Sixteen } else { PngDepth::Eight }
    }

    /// Whether a layer shows the picture without caustics.
    pub fn shows_background(&self) -> bool {
        self.layers.iter().any(|layer| layer.shows_background())
    }

    /// Whether coverage or depth of the surfaces is written.
    pub fn shows_surfaces(&self) -> bool {
        let asked = self.shows_background() || self.layers.contains(&FrameLayer::Depth);
        asked && self.formats.contains(&FrameFormat::Exr)
    }

    /// Whether each named caustic is written by itself.
    pub fn separates_caustics(&self) -> bool {
        self.layers.contains(&FrameLayer::Caustics) && self.formats.contains(&FrameFormat::Exr)
    }

    /// Whether EXR files of the frames through the camera are written.
    pub fn shows_frames(&self) -> bool {
        self.layers.iter().any(|layer| layer.is_in_frame())
    }

    /// Whether the light on the plane is written.
    pub fn shows_plane(&self) -> bool {
        self.layers.contains(&FrameLayer::Plane) && self.formats.contains(&FrameFormat::Exr)
    }

    /// Whether `name` matches the file name of a frame.
    pub fn writes(&self, name: &str) -> bool {
        let frame_of = |format: &FrameFormat| {
            let (before, after) = self.name.split_once(['#', '%'])?;
            let after = after.trim_start_matches(['#', '0', '4', 'd']);
            let stem = name.strip_suffix(format.extension())?.strip_suffix('.')?;
            let beside = format!("{}_plane.", before.strip_suffix('.').unwrap_or(before));
            stem.strip_prefix(before)
                .or_else(|| stem.strip_prefix(&beside))?
                .strip_suffix(after)?
                .parse::<i64>()
                .ok()
        };
        self.formats.iter().any(|format| frame_of(format).is_some())
    }

    /// Refuses values that cannot be used, naming them below `place`.
    pub(super) fn check(&self, place: &str) -> Result<()> {
        let wrong = |field: &str, what: String| Err(Error::value(format!("{place}.{field}"), what));
        FramePattern::parse(&self.name, &format!("{place}.name"))?;
        if let Some(list) = &self.frames {
            frames::parse(list, &format!("{place}.frames"))?;
        }
        Self::FPS.check(self.fps, place)?;
        if self.formats.is_empty() {
            return wrong("formats", "the list is empty; name at least one of \"exr\", \"png\"".into());
        }
        if self.layers.iter().all(|layer| *layer == FrameLayer::Depth) {
            let names = FrameLayer::ALL.map(|layer| format!("\"{}\"", layer.name())).join(", ");
            return wrong("layers", format!("the list shows no light; name at least one of {names}"));
        }
        if self.layers.contains(&FrameLayer::Plane) && !self.formats.contains(&FrameFormat::Exr) {
            return wrong(
                "formats",
                "the layer \"plane\" is light in EXR files; add \"exr\" to the formats".into(),
            );
        }
        if ![8, 16].contains(&self.png_bits) {
            return wrong("png_bits", format!("{} is not offered; give 8 or 16", self.png_bits));
        }
        Ok(())
    }
}
