//! Progressive rendering: photon passes to the light of all frames; the whole sequence refines together.

use std::path::Path;

use glam::{Vec2, Vec3};

use super::density::{KernelFilter, default_radius, radius_of_pass};
use super::frames::FrameStore;
use super::settings::RenderSettings;
use super::splat::{OutsidePhotons, Splatter};
use super::texture::{ReceiverTexture, TextureLayout};
use crate::Result;

/// Kernel radius over the standard deviation by which light is diffused. The kernel's own variance is a ninth of its square: it
/// widens that light by 8 %, unseen, where a thin one would leave it grainy.
const OF_DIFFUSED: f32 = 1.2;

/// The kernel radius of the first pass, as set or by default, for a plane of `extent`; plane units.
pub fn first_radius(settings: &RenderSettings, extent: Vec2) -> f32 {
    let photons = usize::try_from(settings.photons).unwrap_or(usize::MAX);
    settings.radius.unwrap_or_else(|| default_radius(photons, extent.x * extent.y).min(0.5))
}

/// The light of every frame so far. A pass may be added to the frames in any order and from several threads, each with its
/// own [`Workspace`]; the passes of one frame must come in order. A frame's bytes do not depend on the other frames.
#[derive(Debug)]
pub struct ProgressiveRender {
    layout: TextureLayout,
    first_radius: f32,
    store: FrameStore,
}

/// The buffers of one thread.
#[derive(Debug)]
pub struct Workspace {
    texture: ReceiverTexture,
    splatter: Splatter,
    filter: KernelFilter,
}

impl Workspace {
    /// Buffers for textures of one layout.
    pub fn new(layout: TextureLayout) -> Self {
        Self {
            texture: ReceiverTexture::new(layout),
            splatter: Splatter::default(),
            filter: KernelFilter::default(),
        }
    }

    /// The light exposed last, filtered, in watts per texel.
    pub fn texture(&self) -> &ReceiverTexture {
        &self.texture
    }
}

impl ProgressiveRender {
    /// A render without light; the frames are in a scratch file in `folder` ([`FrameStore`]).
    pub fn new(layout: TextureLayout, first_radius: f32, frames: usize, folder: &Path) -> Result<Self> {
        Ok(Self { layout, first_radius, store: FrameStore::new(layout, frames, folder)? })
    }

    /// The same render in files of `folder` that outlive the process, with the light that an earlier one left there
    /// ([`FrameStore::kept`]).
    pub fn kept(
        layout: TextureLayout,
        first_radius: f32,
        frames: usize,
        folder: &Path,
        checked: bool,
    ) -> Result<Self> {
        Ok(Self { layout, first_radius, store: FrameStore::kept(layout, frames, folder, checked)? })
    }

    /// Passes in a frame.
    pub fn passes(&self, frame: usize) -> usize {
        self.store.passes(frame)
    }

    /// Passes in the frame that has the fewest.
    pub fn least_passes(&self) -> usize {
        self.store.least_passes()
    }

    /// The kernel radius of the first pass, plane units.
    pub fn first_radius(&self) -> f32 {
        self.first_radius
    }

    /// The layout of the textures.
    pub fn layout(&self) -> &TextureLayout {
        &self.layout
    }

    /// Adds the photons of `pass` (from 0) at a frame: plane `positions`, RGB `flux` in watts. Every pass carries the whole
    /// flux of the scene; the frame is the mean of its passes.
    pub fn add(
        &self,
        frame: usize,
        pass: usize,
        positions: &[Vec2],
        flux: &[Vec3],
        work: &mut Workspace,
    ) -> Result<OutsidePhotons> {
        let outside = self.expose((pass, 0.0), positions, flux, work);
        self.accumulate(frame, work)?;
        Ok(outside)
    }

    /// The first half of [`Self::add`]: splats and filters the photons in the workspace. Light that is `diffused` by a standard
    /// deviation, plane units, takes a wider kernel.
    pub fn expose(
        &self,
        (pass, diffused): (usize, f32),
        positions: &[Vec2],
        flux: &[Vec3],
        work: &mut Workspace,
    ) -> OutsidePhotons {
        let outside = work.splatter.splat(positions, flux, &mut work.texture);
        work.filter
            .filter(&mut work.texture, radius_of_pass(self.first_radius, pass).hypot(OF_DIFFUSED * diffused));
        outside
    }

    /// The second half of [`Self::add`]: adds the workspace to a frame. Blocks on the disk, so run it beside the next
    /// exposure.
    pub fn accumulate(&self, frame: usize, work: &Workspace) -> Result<()> {
        self.store.add(frame, &work.texture)
    }

    /// The light of a frame in watts per texel, the mean over its passes, and their number.
    pub fn mean(&self, frame: usize) -> Result<(ReceiverTexture, usize)> {
        self.store.mean(frame)
    }
}
