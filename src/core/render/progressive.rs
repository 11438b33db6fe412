//! Photon batches to the light of all frames: the whole sequence refines together.

use std::path::Path;

use glam::{Vec2, Vec3};

use super::density::{KernelFilter, default_radius, radius_of_pass};
use super::frames::FrameStore;
use super::settings::RenderSettings;
use super::splat::{OutsidePhotons, Splatter};
use super::texture::{ReceiverTexture, TextureLayout};
use crate::Result;

/// The kernel radius of the first pass, as set or by default, for a receiver of `extent`; plane units.
pub fn first_radius(settings: &RenderSettings, extent: Vec2) -> f32 {
    let photons = usize::try_from(settings.photons).unwrap_or(usize::MAX);
    settings.radius.unwrap_or_else(|| default_radius(photons, extent.x * extent.y).min(0.5))
}

/// Every frame's light so far. A pass may be added to the frames in any order and from several threads at once, each
/// with a [`Workspace`] of its own; the passes of a frame must come in order. Whatever frames are asked for, each is the
/// same bytes.
#[derive(Debug)]
pub struct ProgressiveRender {
    layout: TextureLayout,
    first_radius: f32,
    store: FrameStore,
}

/// What one thread needs to add photons.
#[derive(Debug)]
pub struct Workspace {
    texture: ReceiverTexture,
    splatter: Splatter,
    filter: KernelFilter,
}

impl Workspace {
    /// For textures of one layout.
    pub fn new(layout: TextureLayout) -> Self {
        Self {
            texture: ReceiverTexture::new(layout),
            splatter: Splatter::default(),
            filter: KernelFilter::default(),
        }
    }

    /// What was added last, filtered, in watts per texel.
    pub fn texture(&self) -> &ReceiverTexture {
        &self.texture
    }
}

impl ProgressiveRender {
    /// No light yet. The frames lie in a scratch file in `folder`, see [`FrameStore`].
    pub fn new(layout: TextureLayout, first_radius: f32, frames: usize, folder: &Path) -> Result<Self> {
        Ok(Self { layout, first_radius, store: FrameStore::new(layout, frames, folder)? })
    }

    /// Where the texels lie.
    pub fn layout(&self) -> &TextureLayout {
        &self.layout
    }

    /// Adds the photons of `pass` (from 0) as they stand in a frame: plane `positions`, RGB `flux` in watts. Every pass
    /// must carry the whole flux of the scene; the frame is the mean of its passes.
    pub fn add(
        &self,
        frame: usize,
        pass: usize,
        positions: &[Vec2],
        flux: &[Vec3],
        work: &mut Workspace,
    ) -> Result<OutsidePhotons> {
        let outside = self.expose(pass, positions, flux, work);
        self.accumulate(frame, work)?;
        Ok(outside)
    }

    /// The first half of [`Self::add`]: the photons' light is in the workspace.
    pub fn expose(
        &self,
        pass: usize,
        positions: &[Vec2],
        flux: &[Vec3],
        work: &mut Workspace,
    ) -> OutsidePhotons {
        let outside = work.splatter.splat(positions, flux, &mut work.texture);
        work.filter.filter(&mut work.texture, radius_of_pass(self.first_radius, pass));
        outside
    }

    /// The second half: adds the light in the workspace to a frame. It waits for the system on one thread, so let it run
    /// beside the next exposure.
    pub fn accumulate(&self, frame: usize, work: &Workspace) -> Result<()> {
        self.store.add(frame, &work.texture)
    }

    /// The light of a frame in watts per texel, the mean over its passes, and their number.
    pub fn mean(&self, frame: usize) -> Result<(ReceiverTexture, usize)> {
        self.store.mean(frame)
    }
}
