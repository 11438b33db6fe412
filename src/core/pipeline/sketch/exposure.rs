//! The light of a sketch on the receiver: the estimate that renders use, from fewer photons.

use glam::{Vec2, Vec3};

use super::{Detail, Sketch};
use crate::render::density::{Smoother, default_radius};
use crate::render::splat::Splatter;
use crate::render::{ReceiverTexture, TextureLayout};

/// Widest kernel, plane units.
const WIDEST: f32 = 0.5;

/// Exposes frames of sketches, with its buffers.
#[derive(Default)]
pub struct Exposure {
    splatter: Splatter,
    smoother: Smoother,
    texture: Option<ReceiverTexture>,
    positions: Vec<Vec2>,
    flux: Vec<Vec3>,
}

impl Exposure {
    /// The light at a frame with `resolution` texels along the longer side of the receiver, watts per texel. `shown` tells
    /// for each of [`Sketch::groups`] whether it shines; groups beyond its end do. None before the frame is worked out.
    pub fn expose(
        &mut self,
        sketch: &Sketch,
        frame: i32,
        resolution: usize,
        shown: &[bool],
    ) -> Option<&ReceiverTexture> {
        let all = sketch.positions(frame)?;
        sketch.flux(frame, &mut self.flux);
        let is_shown = |group: &usize| shown.get(*group) != Some(&false);
        let groups = 0..sketch.groups().len();
        let positions = if groups.clone().all(|group| is_shown(&group)) {
            all
        } else {
            let rows = |group: usize| sketch.groups()[group].1.clone();
            let kept = || groups.clone().filter(is_shown).flat_map(rows);
            self.positions = kept().map(|row| all[row]).collect();
            self.flux = kept().map(|row| self.flux[row]).collect();
            &self.positions
        };
        let layout = layout(sketch.extent(), resolution);
        let texture = match self.texture.take() {
            Some(texture) if *texture.layout() == layout => texture,
            _ => ReceiverTexture::new(layout),
        };
        let texture = self.texture.insert(texture);
        self.splatter.splat(positions, &self.flux, texture);
        self.smoother.filter(texture, Self::radius(sketch));
        Some(texture)
    }

    /// The radius of the kernel for the photons of a sketch, plane units: fewer photons are spread wider.
    pub fn radius(sketch: &Sketch) -> f32 {
        radius(sketch.photons(), sketch.extent())
    }
}

fn radius(photons: usize, extent: Vec2) -> f32 {
    default_radius(photons, extent.x * extent.y).min(WIDEST)
}

/// The texture of all sketches on a receiver of `extent`, with a margin for the widest kernel.
pub(super) fn layout(extent: Vec2, resolution: usize) -> TextureLayout {
    TextureLayout::new(extent, resolution, margin(extent))
}

/// As wide as the kernel of the coarsest sketch.
pub(super) fn margin(extent: Vec2) -> f32 {
    radius(Detail::Draft.photons(), extent)
}

/// Radius of the finest.
pub(super) fn finest_radius(extent: Vec2) -> f32 {
    radius(Detail::Fine.photons(), extent)
}
