//! Picture files. A new format is a file here and a variant of [`FrameFormat`].

pub mod comparison;
pub mod exr;
pub mod fields;
pub mod film;
pub mod layer;
pub mod overlay;
pub mod pattern;
pub mod photons;
pub mod png;
pub mod sheet;

mod backdrop;
mod frame;
mod inspect;
mod projection;
mod repairs;
mod text;
mod time_code;

use std::io::Write as _;
use std::path::Path;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use backdrop::Backdrop;
pub use comparison::{ComparisonSheet, MethodRow, write_comparison};
pub use exr::encode_plane;
pub use fields::{SegmentFields, load_fields, write_fields};
pub use film::{FilmFormat, Reel, write_film};
pub use frame::{Frame, Metadata};
pub use inspect::{FrameFile, inspect};
pub use layer::{FrameLayer, caustic_layer_names};
pub use overlay::{MAGENTA, ORANGE, Overlay, OverlayLine};
pub use pattern::FramePattern;
pub use photons::{DrawnLine, PhotonFormat, PhotonFrame, PhotonSequence, PhotonWriter};
pub use png::PngDepth;
pub use repairs::RepairedSamples;
pub use sheet::{evenly_chosen, write_contact_sheet};

use crate::files::write_atomic;
use crate::render::view::View;
use crate::{Error, Result};

/// The kinds of picture files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum FrameFormat {
    /// OpenEXR, half float, linear, in layers ([`FrameLayer`]).
    Exr,
    /// PNG through the view transform, ready to be shown.
    Png,
}

impl FrameFormat {
    /// All formats.
    pub const ALL: [Self; 2] = [Self::Exr, Self::Png];

    /// The file name extension, without a dot; also the name of the format in settings.
    pub fn extension(self) -> &'static str {
        match self {
            Self::Exr => "exr",
            Self::Png => "png",
        }
    }
}

/// Writes a frame atomically: to a temporary file in the same folder, then renamed. `view` and `depth` apply to PNG only.
/// Equal input gives equal bytes. Runs on the calling thread; write frames in parallel to use more.
///
/// # Panics
/// If the layers differ in size.
pub fn write_frame(
    path: &Path,
    format: FrameFormat,
    frame: &Frame<'_>,
    view: &View,
    depth: PngDepth,
) -> Result<RepairedSamples> {
    let (bytes, repairs) = encode_frame(path, format, frame, view, depth)?;
    write_atomic(path, |file| file.write_all(&bytes))?;
    Ok(repairs)
}

/// The bytes that [`write_frame`] writes, and the repaired samples; errors name `path`.
///
/// # Panics
/// If the layers differ in size.
pub fn encode_frame(
    path: &Path,
    format: FrameFormat,
    frame: &Frame<'_>,
    view: &View,
    depth: PngDepth,
) -> Result<(Vec<u8>, RepairedSamples)> {
    match format {
        FrameFormat::Exr => exr::encode(path, frame),
        FrameFormat::Png => {
            let beauty = frame.backdrop.background.plus(frame.caustic);
            let nonfinite =
                beauty.pixels.iter().flat_map(|p| p.to_array()).filter(|v| !v.is_finite()).count();
            let repairs = RepairedSamples { half_clamped: 0, nonfinite_replaced: nonfinite as u64 };
            let mut texts = vec![("frame", frame.metadata.frame.to_string())];
            texts.extend(frame.metadata.texts(repairs));
            let bytes = png::encode_with_texts(&view.apply(&beauty), depth, &texts);
            Ok((bytes.map_err(Error::io("write", path))?, repairs))
        }
    }
}
