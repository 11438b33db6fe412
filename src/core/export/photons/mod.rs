//! Photons and drawn lines for other programs, in the world's space (m, y up). A new format is a file here and a variant of
//! [`PhotonFormat`].

mod ply;
mod sequence;
mod usda;

use std::path::{Path, PathBuf};

pub use sequence::{DrawnLine, PhotonFrame, PhotonSequence};

use crate::Result;

/// The kinds of photon files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PhotonFormat {
    /// One USD file in text with a time sample for each frame: `Points` and `BasisCurves`.
    Usda,
    /// A binary PLY file for each frame, and one of the lines.
    Ply,
}

impl PhotonFormat {
    /// All formats.
    pub const ALL: [Self; 2] = [Self::Usda, Self::Ply];

    /// The file name extension, without a dot.
    pub fn extension(self) -> &'static str {
        match self {
            Self::Usda => "usda",
            Self::Ply => "ply",
        }
    }
}

/// Writes the photons of a sequence frame by frame; memory does not grow with their number.
pub enum PhotonWriter<'a> {
    /// One file; its columns are in scratch files until all frames are known.
    Usda(usda::UsdaWriter<'a>),
    /// A file for each frame.
    Ply(&'a Path),
}

impl<'a> PhotonWriter<'a> {
    /// A writer into `folder`, which must exist.
    ///
    /// # Errors
    /// Scratch files cannot be made.
    pub fn new(format: PhotonFormat, sequence: &'a PhotonSequence, folder: &'a Path) -> Result<Self> {
        Ok(match format {
            PhotonFormat::Usda => Self::Usda(usda::UsdaWriter::new(sequence, folder)?),
            PhotonFormat::Ply => Self::Ply(folder),
        })
    }

    /// Takes a frame, in rising order; returns its file where it has one.
    ///
    /// # Errors
    /// The system refuses.
    pub fn frame(&mut self, frame: &PhotonFrame) -> Result<Option<PathBuf>> {
        match self {
            Self::Usda(writer) => writer.frame(frame).map(|()| None),
            Self::Ply(folder) => {
                let path = folder.join(format!("photons.{:04}.ply", frame.frame));
                ply::write_frame(&path, frame).map(|()| Some(path))
            }
        }
    }

    /// Writes what all frames have in common; returns its file, where there is one.
    ///
    /// # Errors
    /// The system refuses.
    pub fn finish(self, sequence: &PhotonSequence) -> Result<Option<PathBuf>> {
        match self {
            Self::Usda(writer) => writer.finish().map(Some),
            Self::Ply(_) if sequence.lines.is_empty() => Ok(None),
            Self::Ply(folder) => {
                let path = folder.join("lines.ply");
                ply::write_lines(&path, &sequence.lines).map(|()| Some(path))
            }
        }
    }
}
