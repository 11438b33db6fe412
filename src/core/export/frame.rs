//! What is written for one frame.

use super::backdrop::Backdrop;
use super::repairs::RepairedSamples;
use crate::render::image::Image;
use crate::scene::camera::Camera;

/// One finished frame.
#[derive(Clone, Copy, Debug)]
pub struct Frame<'a> {
    /// What it shares with the other frames of its sequence.
    pub backdrop: &'a Backdrop<'a>,
    /// The caustics alone, linear, of the same size.
    pub caustic: &'a Image,
    /// The caustics one by one with the names of their layers, of the same size.
    pub caustics: &'a [(String, Image)],
    /// Metadata of the file.
    pub metadata: &'a Metadata,
    /// Whether its own layers are compressed in EXR files. Otherwise they take twice the room and less time.
    pub compressed: bool,
}

/// The metadata of a frame's file.
#[derive(Clone, Debug, PartialEq)]
pub struct Metadata {
    /// Frame number.
    pub frame: i32,
    /// Frames per second as a fraction, such as (24, 1) or (30000, 1001).
    pub frames_per_second: (i32, u32),
    /// Seed of the run.
    pub seed: u64,
    /// Passes in this frame.
    pub passes: u32,
    /// The camera; none where the plane is seen straight on.
    pub camera: Option<Camera>,
    /// Further names and values, such as settings; each name is prefixed with `lightloom:`.
    pub settings: Vec<(String, String)>,
}

impl Metadata {
    /// All that is told in words, by name without `lightloom:`: frame, seed, passes, the settings and what was repaired.
    pub(super) fn texts(&self, repairs: RepairedSamples) -> Vec<(&str, String)> {
        let numbers = [
            ("seed", self.seed.to_string()),
            ("passes", self.passes.to_string()),
            ("half_clamped", repairs.half_clamped.to_string()),
            ("nonfinite_replaced", repairs.nonfinite_replaced.to_string()),
        ];
        let settings = self.settings.iter().map(|(name, value)| (name.as_str(), value.clone()));
        numbers.into_iter().chain(settings).collect()
    }
}
