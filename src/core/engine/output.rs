//! Where a render goes.

use std::path::Path;

use super::existing::Existing;
use super::observer::RenderObserver;
use crate::Progress;

/// Where a render goes, and those who are told of it.
pub struct Output<'a> {
    /// The folder of the frames; it must exist.
    pub folder: &'a Path,
    /// The file of a film of all frames, where one is wanted ([`prepare_film`](super::prepare_film)).
    pub film: Option<&'a Path>,
    /// What becomes of frames of other renders that are in the folder.
    pub existing: Existing,
    /// The folder of a bake of the same project ([`Engine::bake`](super::Engine::bake)); the frames are then a part.
    pub bake: Option<&'a Path>,
    /// Whether the frames are a part of a render that is done in parts, so that no contact sheet is written.
    pub is_part: bool,
    /// The progress of the work.
    pub progress: &'a Progress,
    /// Called with each finished file.
    pub saved: &'a (dyn Fn(&Path) + Sync),
    /// Sees the frames grow.
    pub observer: &'a dyn RenderObserver,
}

impl<'a> Output<'a> {
    /// Frames alone, which replace others.
    pub fn new(folder: &'a Path, progress: &'a Progress, saved: &'a (dyn Fn(&Path) + Sync)) -> Self {
        let (existing, film, bake) = (Existing::Overwrite, None, None);
        Self { folder, film, existing, bake, is_part: false, progress, saved, observer: &() }
    }
}
