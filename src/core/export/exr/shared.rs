//! What the files of all frames of a sequence share, compressed once.

use exr::error::Result;
use exr::prelude::{AnyChannel, FlatSamples};
use glam::Vec3;

use super::channels::{alpha, colours, finite};
use super::part::KeptPart;
use crate::export::layer::FrameLayer;
use crate::export::repairs::RepairedSamples;
use crate::render::first_hits::FirstHits;
use crate::render::image::Image;

/// The parts that are the same in all files.
#[derive(Debug)]
pub(in crate::export) struct SharedParts {
    /// The light without caustics, finite.
    pub(super) light: Vec<Vec3>,
    /// Where it is written.
    pub(super) background: Option<KeptPart>,
    /// Where it is written and there are surfaces.
    pub(super) depth: Option<KeptPart>,
    /// What was repaired in them.
    pub(super) repairs: RepairedSamples,
}

impl SharedParts {
    /// The parts of files in these layers.
    pub(in crate::export) fn new(
        layers: &[FrameLayer],
        background: &Image,
        hits: Option<&FirstHits>,
    ) -> Result<Self> {
        let size = (background.width, background.height);
        let mut repairs = RepairedSamples::default();
        let light = finite(background, &mut repairs);
        let background = layers.contains(&FrameLayer::Background).then(|| {
            let mut channels = colours("background.", &light, &mut repairs.half_clamped);
            channels.push(alpha("background.", size, hits));
            KeptPart::new(size, channels)
        });
        let depth = hits.filter(|_| layers.contains(&FrameLayer::Depth)).map(|hits| {
            KeptPart::new(size, vec![AnyChannel::new("depth.Z", FlatSamples::F32(hits.depth.clone()))])
        });
        Ok(Self { light, background: background.transpose()?, depth: depth.transpose()?, repairs })
    }
}
