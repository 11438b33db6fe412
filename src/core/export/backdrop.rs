//! What all frames of a sequence share.

use std::sync::OnceLock;

use super::exr::shared::SharedParts;
use super::layer::FrameLayer;
use crate::render::first_hits::FirstHits;
use crate::render::image::Image;

/// The picture behind the caustics, and the layers that are written.
#[derive(Debug)]
pub struct Backdrop<'a> {
    /// The layers to be written, for formats that have some.
    pub layers: &'a [FrameLayer],
    /// Light without caustics, linear; black where no layer shows it.
    pub background: &'a Image,
    /// Coverage and depth of the surfaces; none where there are none, and everything is covered.
    pub first_hits: Option<&'a FirstHits>,
    shared: OnceLock<exr::error::Result<SharedParts>>,
}

impl<'a> Backdrop<'a> {
    /// The backdrop of frames in these layers.
    pub fn new(layers: &'a [FrameLayer], background: &'a Image, first_hits: Option<&'a FirstHits>) -> Self {
        Self { layers, background, first_hits, shared: OnceLock::new() }
    }

    /// The parts of EXR files that are the same in all, made for the first.
    pub(super) fn shared(&self) -> &exr::error::Result<SharedParts> {
        self.shared.get_or_init(|| SharedParts::new(self.layers, self.background, self.first_hits))
    }
}
