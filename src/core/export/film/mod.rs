//! Films: the frames of a sequence in one file that plays. A new kind is a file here and a variant of [`FilmFormat`].

mod apng;
mod delta;
mod gif;
mod job;
mod mp4;
mod palette;
mod reel;
mod timing;

use std::path::Path;

use self::job::Film;
pub use reel::Reel;
pub use timing::holds;

use crate::{Error, Progress, Result};

/// The kinds of films.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FilmFormat {
    /// 256 colours for the whole film, dithered; plays everywhere.
    Gif,
    /// All colours of PNG files; plays in browsers.
    Apng,
    /// H.264 by the program ffmpeg.
    Mp4,
}

impl FilmFormat {
    /// All formats.
    pub const ALL: [Self; 3] = [Self::Gif, Self::Apng, Self::Mp4];

    /// The file name extension, without a dot; also the name of the format.
    pub fn extension(self) -> &'static str {
        match self {
            Self::Gif => "gif",
            Self::Apng => "apng",
            Self::Mp4 => "mp4",
        }
    }

    /// The format of a file by its extension; `png` is an APNG, too.
    ///
    /// # Errors
    /// Names `place` for any other.
    pub fn of(path: &Path, place: &str) -> Result<Self> {
        let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
        let known = Self::ALL.into_iter().find(|format| format.extension() == extension);
        known.or((extension == "png").then_some(Self::Apng)).ok_or_else(|| {
            let what = format!("'{}' does not end in .gif, .apng or .mp4, which films are", path.display());
            Error::value(place, what)
        })
    }

    /// Whether it can be written on this machine.
    ///
    /// # Errors
    /// Names `place`, and what to install.
    pub fn require(self, place: &str) -> Result<()> {
        if self == Self::Mp4 { mp4::require(place) } else { Ok(()) }
    }
}

/// Writes a film whose frames are shown for `holds` of the `frames_per_second` (a fraction), over and over where the format
/// knows how. The file appears when it is complete. Equal input gives equal bytes but for MP4, which depend on ffmpeg.
///
/// Work that was stopped before still gets its film; if it is stopped meanwhile, nothing is written.
///
/// # Errors
/// The file and the system's reason; cancelled.
pub fn write_film(
    path: &Path,
    format: FilmFormat,
    reel: &Reel,
    holds: &[u32],
    frames_per_second: [u32; 2],
    progress: &Progress,
) -> Result<()> {
    progress.begin("film", reel.count() as u64);
    let stopped = progress.is_cancelled();
    let film = Film { path, reel, holds, frames_per_second, progress, stopped };
    match format {
        FilmFormat::Gif => film.fill(|file| gif::write(&film, file)),
        FilmFormat::Apng => film.fill(|file| apng::write(&film, file)),
        FilmFormat::Mp4 => mp4::write(&film),
    }
}
